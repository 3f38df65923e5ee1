"""The argument type of actions and handlers for one or several entities."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Union

from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity

SomeEntitiesType = Union[LaunchDescriptionEntity, Iterable[LaunchDescriptionEntity]]  # noqa: UP007 - public
