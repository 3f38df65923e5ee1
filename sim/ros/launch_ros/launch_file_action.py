"""The base class of actions that are a launch file of a package with some of its arguments.

A subclass names the file, and its arguments with their defaults; an argument without a default is required.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.actions import IncludeLaunchDescription
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.launch_description_sources import PythonLaunchDescriptionSource
from gz_course.sim.ros.launch.substitutions import PathJoinSubstitution
from gz_course.sim.ros.launch_ros.substitutions import FindPackageShare

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser


class LaunchFileAction(Action):
    """Includes the launch file `file` of `package`; its arguments are those of the action."""

    package: ClassVar[str]
    file: ClassVar[str]
    arguments: ClassVar[Mapping[str, str | None]]
    """The default of each argument; None for one that must be given."""
    called: ClassVar[Mapping[str, str]] = {}
    """What the launch file calls an argument, where that is another name."""

    def __init__(self, *, condition: Any = None, **given: Any) -> None:
        """Keep the arguments. Raises TypeError for one that is not known, and if a required one is missing."""
        super().__init__(condition=condition)
        name = type(self).__name__
        for each in given:
            if each not in self.arguments:
                raise TypeError(
                    f"{name} has no argument '{each}'{did_you_mean(each, self.arguments, listing='there are')}"
                )
        for each, default in self.arguments.items():
            if default is None and given.get(each) is None:
                raise TypeError(f"{name} needs the argument '{each}'")
        self._given = {each: value for each, value in given.items() if value is not None}

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read the attributes of the action in XML and YAML."""
        _, options = super().parse(entity, parser)
        for name, default in cls.arguments.items():
            value = entity.get_attr(name, data_type=None, optional=default is not None)
            if value is not None:
                options[name] = parser.parse_substitution(value if isinstance(value, str) else str(value))
        return cls, options

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        path = PathJoinSubstitution([FindPackageShare(self.package), "launch", self.file])
        given = {self.called.get(name, name): value for name, value in {**self.arguments, **self._given}.items()}
        source = PythonLaunchDescriptionSource([path])
        return [IncludeLaunchDescription(source, launch_arguments=list(given.items()))]
