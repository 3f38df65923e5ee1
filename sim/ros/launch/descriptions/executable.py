"""The description of a process: command, folder and environment, as substitutions and as text."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.action import Action

Environment = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]


class Executable:
    """A command: its words `cmd`, words `prefix` before them, and a `name` for the label.

    `env` replaces the environment, `additional_env` adds to it. `prepare` performs all substitutions; the results are
    the properties that start with `final_`.
    """

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        words = [cmd] if isinstance(cmd, str | Substitution) else cmd
        self.cmd = [normalize_to_list_of_substitutions(word) for word in (*words, *(arguments or ()))]
        self.prefix = None if prefix is None else normalize_to_list_of_substitutions(prefix)
        self.name = None if name is None else normalize_to_list_of_substitutions(name)
        self.cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self.env = _normalized(env)
        self.additional_env = _normalized(additional_env)
        self.final_name: str | None = None
        self.final_cmd: list[str] | None = None
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] | None = None

    def prepare(self, context: LaunchContext, action: Action | None, more_words: Iterable[str] = ()) -> None:
        """Perform all substitutions; `more_words` are appended to the command.

        Raises LaunchError and the errors of substitutions.
        """
        words = [*[perform_substitutions(context, word) for word in self.cmd], *more_words]
        if not words or not words[0]:
            raise LaunchError("the command is empty; cmd needs at least the name of a program")
        words = [*self._prefix_words(context, words[0]), *words]
        name = os.path.basename(words[0])  # noqa: PTH119 - it may be any text
        if self.name is not None:
            name = perform_substitutions(context, self.name)
        self.final_cmd = words
        self.final_name = f"{name}-{next(context.process_numbers)}"
        self.final_cwd = None if self.cwd is None else perform_substitutions(context, self.cwd)
        environment = dict(context.environment) if self.env is None else _performed(self.env, context)
        environment.update(_performed(self.additional_env or [], context))
        for name, value in environment.items():
            if "\0" in name + value or "=" in name or not name:
                raise LaunchError(f"the environment variable {name!r} with the value {value!r} cannot be set")
        self.final_env = environment

    def _prefix_words(self, context: LaunchContext, program: str) -> list[str]:
        configurations = context.launch_configurations
        if self.prefix is not None:
            prefix = perform_substitutions(context, self.prefix)
        else:
            wanted = configurations.get("launch-prefix-filter")
            if wanted is not None and not re.match(wanted, os.path.basename(program)):  # noqa: PTH119
                return []
            prefix = configurations.get("launch-prefix", "")
        try:
            return shlex.split(prefix)
        except ValueError as error:
            raise LaunchError(f"the prefix {prefix!r} cannot be split into words: {error}") from None


def _normalized(environment: Environment | None) -> list[tuple[list[Substitution], list[Substitution]]] | None:
    if environment is None:
        return None
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in environment.items()
    ]


def _performed(
    variables: list[tuple[list[Substitution], list[Substitution]]], context: LaunchContext
) -> dict[str, str]:
    return {perform_substitutions(context, name): perform_substitutions(context, value) for name, value in variables}
