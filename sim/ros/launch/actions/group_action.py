"""The action that groups actions under one scope and one condition."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.actions.pop_environment import PopEnvironment
from gz_course.sim.ros.launch.actions.pop_launch_configurations import PopLaunchConfigurations
from gz_course.sim.ros.launch.actions.push_environment import PushEnvironment
from gz_course.sim.ros.launch.actions.push_launch_configurations import PushLaunchConfigurations
from gz_course.sim.ros.launch.actions.reset_environment import ResetEnvironment
from gz_course.sim.ros.launch.actions.reset_launch_configurations import ResetLaunchConfigurations
from gz_course.sim.ros.launch.actions.set_launch_configuration import SetLaunchConfiguration
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.frontend.flag import read_flag
from gz_course.sim.ros.launch.frontend.named_values import named_values
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity, listed
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


@expose_action("group")
class GroupAction(Action):
    """Visits `actions`; with `scoped` their changes of configurations and environment end with the group.

    With `forwarding=False` they see only the given `launch_configurations`, not those outside of the group.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.__actions = listed(actions, "the list of GroupAction")
        self.__scoped = scoped
        self.__forwarding = forwarding
        self.__launch_configurations = dict(launch_configurations or {})
        self.__entities: list[LaunchDescriptionEntity] | None = None

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<group [scoped=] [forwarding=]>`, which can hold `<keep name= value=/>` beside actions."""
        _, options = super().parse(entity, parser)
        for name in ("scoped", "forwarding"):
            options |= read_flag(entity, name)
        kept = entity.get_attr("keep", data_type=list[Entity], optional=True)
        if kept is not None:
            options["launch_configurations"] = named_values(kept, parser)
        options["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != "keep"]
        return cls, options

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        if self.__entities is None:
            given = self.__launch_configurations
            setting = [SetLaunchConfiguration(name, value) for name, value in given.items()]
            if not self.__scoped:
                self.__entities = [*setting, *self.__actions]
            else:
                opening: list[LaunchDescriptionEntity] = [PushLaunchConfigurations(), PushEnvironment()]
                if self.__forwarding:
                    opening += setting
                else:
                    opening += [ResetEnvironment(), ResetLaunchConfigurations(given)]
                self.__entities = [*opening, *self.__actions, PopEnvironment(), PopLaunchConfigurations()]
        return self.__entities

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        return self.get_sub_entities()
