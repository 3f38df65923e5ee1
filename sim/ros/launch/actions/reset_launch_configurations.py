"""The action that removes launch configurations."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.frontend.named_values import named_values
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


@expose_action("reset")
class ResetLaunchConfigurations(Action):
    """Removes all launch configurations and sets the given ones."""

    hides_arguments = True

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__kept = [
            (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
            for name, value in (launch_configurations or {}).items()
        ]

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<reset/>`, which can hold `<keep name= value=/>`."""
        _, options = super().parse(entity, parser)
        kept = entity.get_attr("keep", data_type=list[Entity], optional=True)
        if kept is not None:
            options["launch_configurations"] = named_values(kept, parser)
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        """Evaluate the new values before removing the configurations, to which they may refer."""
        kept = {perform_substitutions(context, name): perform_substitutions(context, v) for name, v in self.__kept}
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
