"""The services of ros_gz_interfaces: control of the world; spawning, deleting and moving entities.

Source: ros_gz_bridge/src/service_factories/ros_gz_interfaces.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ros_gz_interfaces.srv import ControlWorld, DeleteEntity, SetEntityPose, SpawnEntity

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import POSE
from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.twists import finite
from gz_course.sim.bridge.ros_gz_bridge.convert.ros_gz_interfaces.messages import ENTITY
from gz_course.sim.bridge.ros_gz_bridge.header import copy_stamp
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError, add_service
from gz_course.sim.gz.msgs import message_class

_SOURCES = ("sdf", "sdf_filename", "clone_name")


def _service(
    ros_class: Any, gz_type: str, copy: Callable[[Any, Any], None], fault: Callable[[Any], str | None] | None = None
) -> None:
    """Add a service whose request is written by `copy(ros, gz)` and whose Gazebo response is a `gz.msgs.Boolean`."""
    gz_class = message_class(gz_type)

    def request_to_gz(ros: Any) -> Any:
        gz = gz_class()
        copy(ros, gz)
        return gz

    add_service(
        f"ros_gz_interfaces/srv/{ros_class.__name__}",
        gz_type,
        "gz.msgs.Boolean",
        request_to_gz=request_to_gz,
        reply_to_ros=lambda gz: ros_class.Response(success=gz.data),
        fault=fault,
    )


def _control(ros: Any, gz: Any) -> None:
    """Write pause, step, reset and seed. All fields are set, so that a request without `pause` runs the world."""
    control = ros.world_control
    gz.pause, gz.step, gz.multi_step, gz.seed = control.pause, control.step, control.multi_step, control.seed
    gz.reset.all = control.reset.all
    gz.reset.time_only = control.reset.time_only
    gz.reset.model_only = control.reset.model_only
    copy_stamp(control.run_to_sim_time, gz.run_to_sim_time)


def _spawn(ros: Any, gz: Any) -> None:
    """Write an entity as SDF text, file or name of another entity; the first one that is set is used."""
    factory = ros.entity_factory
    source = next((field for field in _SOURCES if getattr(factory, field)), None)
    if source is None:
        raise ConversionError(f"there is nothing to spawn: none of {', '.join(_SOURCES)} is given")
    gz.name, gz.allow_renaming, gz.relative_to = factory.name, factory.allow_renaming, factory.relative_to
    setattr(gz, source, getattr(factory, source))
    POSE.copy(factory.pose, gz.pose)


def _set_pose(ros: Any, gz: Any) -> None:
    """Write name, id and pose; Gazebo has no field for the type of the entity."""
    if ros.entity.id >= 2**32:
        raise ConversionError(f"the entity id {ros.entity.id} does not fit the 32 bits of gz.msgs.Pose")
    gz.name, gz.id = ros.entity.name, ros.entity.id
    POSE.copy(ros.pose, gz)


_service(ControlWorld, "gz.msgs.WorldControl", _control)
_service(
    SpawnEntity,
    "gz.msgs.EntityFactory",
    _spawn,
    finite("entity_factory.pose.position", "entity_factory.pose.orientation"),
)
_service(DeleteEntity, "gz.msgs.Entity", lambda ros, gz: ENTITY.copy(ros.entity, gz))
_service(SetEntityPose, "gz.msgs.Pose", _set_pose, finite("pose.position", "pose.orientation"))
