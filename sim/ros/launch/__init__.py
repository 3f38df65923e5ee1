"""Launch files: start several programs together, with arguments, and end them together.

The interface of ROS 2's `launch`, for machines without it; an installed real one takes precedence. A launch file is
loaded by `launch_description_sources`, visited by `LaunchService`, and made of `actions`, `substitutions`, `conditions`
and `event_handlers`.

Source: https://github.com/ros2/launch
"""

from gz_course.sim.ros.launch import (
    actions,
    conditions,
    descriptions,
    event_handlers,
    events,
    launch_description_sources,
    logging,
    substitutions,
    utilities,
)
from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.condition import Condition
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.invalid_launch_file_error import InvalidLaunchFileError
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description import LaunchDescription
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.launch_description_source import LaunchDescriptionSource
from gz_course.sim.ros.launch.launch_introspector import LaunchIntrospector
from gz_course.sim.ros.launch.launch_service import LaunchService
from gz_course.sim.ros.launch.some_entities_type import SomeEntitiesType
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple
from gz_course.sim.ros.launch.substitution import Substitution

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "InvalidLaunchFileError",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeEntitiesType",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
    "actions",
    "conditions",
    "descriptions",
    "event_handlers",
    "events",
    "launch_description_sources",
    "logging",
    "substitutions",
    "utilities",
]
