"""The action that adds to an environment variable."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.actions.set_environment_variable import SetEnvironmentVariable
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


@expose_action("append_env")
class AppendEnvironmentVariable(SetEnvironmentVariable):
    """Appends a value to a variable, or prepends it with `prepend`; `separator` stands between the values."""

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self.prepend = normalize_to_list_of_substitutions(str(prepend) if isinstance(prepend, bool) else prepend)
        self.separator = normalize_to_list_of_substitutions(separator)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<append_env name= value= [prepend=] [separator=]/>`."""
        _, options = super().parse(entity, parser)
        prepend = entity.get_attr("prepend", data_type=bool, optional=True)
        separator = entity.get_attr("separator", optional=True)
        if prepend is not None:
            options["prepend"] = parser.parse_if_substitutions(prepend)
            if isinstance(options["prepend"], str):
                raise LaunchError(f"prepend is the text {prepend!r}; write true or false without quotes")
        if separator is not None:
            options["separator"] = parser.parse_substitution(separator)
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        from gz_course.sim.ros.launch.conditions import evaluate_condition_expression

        name = perform_substitutions(context, self.name)
        there = context.environment.get(name)
        if there is None:
            return super().execute(context)
        parts = [there, perform_substitutions(context, self.value)]
        if evaluate_condition_expression(context, self.prepend):
            parts.reverse()
        context.environment[name] = perform_substitutions(context, self.separator).join(parts)
        return None
