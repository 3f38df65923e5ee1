"""The content of a launch file: entities in the order in which they are visited."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

from gz_course.sim.ros.launch.errors import locate, place_of_caller
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity, listed

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
    from gz_course.sim.ros.launch.launch_context import LaunchContext


class LaunchDescription(LaunchDescriptionEntity):
    """A list of entities: actions and launch descriptions."""

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        if isinstance(initial_entities, LaunchDescriptionEntity):
            raise TypeError(
                f"LaunchDescription wants a list of actions: [{type(initial_entities).__name__}(...)]; the brackets "
                "are missing"
            )
        try:
            self.entities = listed(initial_entities, "the list of LaunchDescription")
        except Exception as error:
            locate(error, place_of_caller())
            raise
        self.deprecated_reason = deprecated_reason

    @property
    def deprecated(self) -> bool:
        return self.deprecated_reason is not None

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        self.entities += listed([entity], "add_entity")

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        self.entities += listed([action], "add_action")

    def visit(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        if self.deprecated_reason is not None:
            import gz_course.sim.ros.launch.logging as launch_logging

            launch_logging.get_logger("launch").warning(
                f"this launch description is deprecated: {self.deprecated_reason}"
            )
        return self.entities

    def describe(self) -> str:
        return f"LaunchDescription({hex(id(self))})"

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        return list(self.entities)

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[DeclareLaunchArgument]:
        """Return the arguments declared here and in included files, each name once.

        Arguments inside of conditional entities are marked as such. Included files whose path is not known before the
        launch runs are omitted.
        """
        found = self.get_launch_arguments_with_include_launch_description_actions(conditional_inclusion)
        arguments: dict[Any, DeclareLaunchArgument] = {}
        for argument, _ in found:
            arguments.setdefault(argument.name, argument)
        return list(arguments.values())

    def get_launch_arguments_with_include_launch_description_actions(
        self, conditional_inclusion: bool = False, *, only_search_local: bool = False
    ) -> list[tuple[DeclareLaunchArgument, list[IncludeLaunchDescription]]]:
        """Return the declared arguments, each with its chain of includes, the innermost last."""
        found: list[tuple[DeclareLaunchArgument, list[IncludeLaunchDescription]]] = []

        def search(
            entities: Iterable[LaunchDescriptionEntity], conditional: bool, chain: list[IncludeLaunchDescription]
        ) -> None:
            for entity in entities:
                if entity.declares_argument:
                    argument = cast("DeclareLaunchArgument", entity)
                    argument._conditionally_included |= conditional or argument.condition is not None
                    found.append((argument, chain))
                if entity.hides_arguments:
                    return  # the following entities cannot see arguments from outside
                deeper = chain
                if entity.includes_description:
                    include = cast("IncludeLaunchDescription", entity)
                    if only_search_local or include.leads_back_into(chain):
                        continue
                    deeper = [*chain, include]
                search(entity.describe_sub_entities(), conditional, deeper)
                for _, group in entity.describe_conditional_sub_entities():
                    search(group, True, deeper)

        search(self.entities, conditional_inclusion, [])
        return found
