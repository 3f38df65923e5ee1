"""What is started, before it is known how: the words of a command, its folder and its environment."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from gz_course.sim.launch.errors import LaunchError
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.launch.substitution import Substitution
from gz_course.sim.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.launch.action import Action

Environment = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]


class Executable:
    """`cmd` word by word, `prefix` before it, `name` for its label.

    `env` replaces the environment, `additional_env` adds to it. `prepare` performs all of it; the results are the
    properties that start with `final_`.
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
        self.__cmd = [normalize_to_list_of_substitutions(word) for word in (*words, *(arguments or ()))]
        self.__prefix = None if prefix is None else normalize_to_list_of_substitutions(prefix)
        self.__name = None if name is None else normalize_to_list_of_substitutions(name)
        self.__cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self.__env = _normalized(env)
        self.__additional_env = _normalized(additional_env)
        self.__final_name: str | None = None
        self.__final_cmd: list[str] | None = None
        self.__final_cwd: str | None = None
        self.__final_env: dict[str, str] | None = None

    @property
    def name(self) -> list[Substitution] | None:
        """The name that was given."""
        return self.__name

    @property
    def prefix(self) -> list[Substitution] | None:
        """The words before the command."""
        return self.__prefix

    @property
    def cmd(self) -> list[list[Substitution]]:
        """The words of the command."""
        return self.__cmd

    @property
    def cwd(self) -> list[Substitution] | None:
        """The folder it is started in."""
        return self.__cwd

    @property
    def env(self) -> list[tuple[list[Substitution], list[Substitution]]] | None:
        """The environment that replaces that of the launch."""
        return self.__env

    @property
    def additional_env(self) -> list[tuple[list[Substitution], list[Substitution]]] | None:
        """The environment variables that are added."""
        return self.__additional_env

    @property
    def final_name(self) -> str | None:
        """The label of the process, `<name>-<number>`; None before `prepare`."""
        return self.__final_name

    @property
    def final_cmd(self) -> list[str] | None:
        """The words to be started; None before `prepare`."""
        return self.__final_cmd

    @property
    def final_cwd(self) -> str | None:
        """The folder to start it in, None for the launch's own."""
        return self.__final_cwd

    @property
    def final_env(self) -> dict[str, str] | None:
        """The environment to start it with; None before `prepare`."""
        return self.__final_env

    def prepare(self, context: LaunchContext, action: Action | None, more_words: Iterable[str] = ()) -> None:
        """Perform all substitutions; `more_words` go to the end of the command.

        Raises LaunchError or whatever a substitution raises.
        """
        words = [*[perform_substitutions(context, word) for word in self.__cmd], *more_words]
        if not words or not words[0]:
            raise LaunchError("the command is empty; cmd needs at least the name of a program")
        words = [*self._prefix_words(context, words[0]), *words]
        name = os.path.basename(words[0])  # noqa: PTH119 - it may be any text
        if self.__name is not None:
            name = perform_substitutions(context, self.__name)
        self.__final_cmd = words
        self.__final_name = f"{name}-{next(context.process_numbers)}"
        self.__final_cwd = None if self.__cwd is None else perform_substitutions(context, self.__cwd)
        environment = dict(context.environment) if self.__env is None else _performed(self.__env, context)
        environment.update(_performed(self.__additional_env or [], context))
        for name, value in environment.items():
            if "\0" in name + value or "=" in name or not name:
                raise LaunchError(f"the environment variable {name!r} with the value {value!r} cannot be set")
        self.__final_env = environment

    def _prefix_words(self, context: LaunchContext, program: str) -> list[str]:
        configurations = context.launch_configurations
        if self.__prefix is not None:
            prefix = perform_substitutions(context, self.__prefix)
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
