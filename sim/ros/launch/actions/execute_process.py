"""The action that runs a command."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.actions.execute_local import ExecuteLocal
from gz_course.sim.ros.launch.descriptions.executable import Environment, Executable
from gz_course.sim.ros.launch.frontend.command_words import command_words
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.frontend.named_values import named_values
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.substitution import Substitution
from gz_course.sim.ros.launch.utilities import describe_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


@expose_action("executable")
class ExecuteProcess(ExecuteLocal):
    """Runs `cmd`, a list of words; with `shell=True` they are joined by spaces and passed to /bin/sh.

    `cwd` is its working directory, `env` replaces the environment, `additional_env` adds to it, `prefix` is put before
    the command, `name` is used in its label. The other arguments are those of ExecuteLocal. A plain text as `cmd`
    requires `shell=True`.
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
        **kwargs: Any,
    ) -> None:
        if isinstance(cmd, str) and not kwargs.get("shell") and len(cmd.split()) > 1:
            raise TypeError(f"cmd={cmd!r} is one text; write a list of words, cmd={cmd.split()}, or add shell=True")
        description = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=description, **kwargs)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: Iterable[str] = ()) -> tuple[Any, dict[str, Any]]:
        """Read `<executable cmd= ...>`, which can hold `<env name= value=/>`; attributes in `ignore` aside."""
        _, options = super().parse(entity, parser, ignore)
        if "cmd" not in ignore:
            options["cmd"] = command_words(entity.get_attr("cmd"), parser)
        for name, option in (("cwd", "cwd"), ("name", "name"), ("launch-prefix", "prefix")):
            value = None if name in ignore else entity.get_attr(name, optional=True)
            if value is not None:
                options[option] = parser.parse_substitution(value)
        environment = None if "env" in ignore else entity.get_attr("env", data_type=list[Entity], optional=True)
        if environment is not None:
            options["additional_env"] = named_values(environment, parser)
        return cls, options

    @property
    def name(self) -> list[Substitution] | str | None:
        """Return the label after the start, the given name before."""
        return self.process_description.final_name or self.process_description.name

    @property
    def cmd(self) -> list[Any]:
        """Return the words after the start, their substitutions before."""
        return self.process_description.final_cmd or self.process_description.cmd

    @property
    def cwd(self) -> list[Substitution] | str | None:
        return self.process_description.final_cwd or self.process_description.cwd

    @property
    def env(self) -> Any:
        """Return the environment after the start, the given one before."""
        return self.process_description.final_env or self.process_description.env

    @property
    def additional_env(self) -> Any:
        return self.process_description.additional_env

    def describe(self) -> str:
        words = ", ".join(self._described_words())
        cwd, env = self.process_description.cwd, self.process_description.env
        folder = None if cwd is None else describe_substitutions(cwd)
        return f"ExecuteProcess(cmd=[{words}], cwd={folder}, env={env}, shell={self.shell})"

    def _described_words(self) -> list[str]:
        return [describe_substitutions(word) for word in self.process_description.cmd]
