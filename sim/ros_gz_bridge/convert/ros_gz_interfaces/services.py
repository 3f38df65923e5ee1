"""The services of ros_gz_interfaces: control of the world, and entities that come, go and move."""

from __future__ import annotations

from typing import Any

from ros_gz_interfaces.srv import ControlWorld, DeleteEntity, SetEntityPose, SpawnEntity

from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
from gz_course.sim.gz.msgs.entity_pb2 import Entity
from gz_course.sim.gz.msgs.pose_pb2 import Pose
from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import copy_pose
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.twists import not_finite
from gz_course.sim.ros_gz_bridge.convert.ros_gz_interfaces.messages import ENTITY
from gz_course.sim.ros_gz_bridge.header import stamp_to_gz
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, service_types

_SOURCES = ("sdf", "sdf_filename", "clone_name")


@service_types("ros_gz_interfaces/srv/ControlWorld", "gz.msgs.WorldControl", "gz.msgs.Boolean")
class ControlWorldTypes:
    """Pause, step, reset, seed. Every field is set each time: a request that leaves ``pause`` out runs the world."""

    @staticmethod
    def request_to_gz(ros: Any) -> Any:
        """ROS to Gazebo."""
        control = ros.world_control
        gz = WorldControl(pause=control.pause, step=control.step, multi_step=control.multi_step, seed=control.seed)
        gz.reset.all = control.reset.all
        gz.reset.time_only = control.reset.time_only
        gz.reset.model_only = control.reset.model_only
        stamp_to_gz(control.run_to_sim_time, gz.run_to_sim_time)
        return gz

    @staticmethod
    def reply_to_ros(gz: Any) -> Any:
        """Gazebo to ROS."""
        return ControlWorld.Response(success=gz.data)


@service_types("ros_gz_interfaces/srv/SpawnEntity", "gz.msgs.EntityFactory", "gz.msgs.Boolean")
class SpawnEntityTypes:
    """An entity from SDF text, from a file or from another entity: the first of them that is given."""

    @staticmethod
    def request_to_gz(ros: Any) -> Any:
        """ROS to Gazebo."""
        factory = ros.entity_factory
        gz = EntityFactory(name=factory.name, allow_renaming=factory.allow_renaming, relative_to=factory.relative_to)
        source = next((field for field in _SOURCES if getattr(factory, field)), None)
        if source is None:
            raise ConversionError(f"there is nothing to spawn: none of {', '.join(_SOURCES)} is given")
        setattr(gz, source, getattr(factory, source))
        copy_pose(factory.pose, gz.pose)
        return gz

    @staticmethod
    def reply_to_ros(gz: Any) -> Any:
        """Gazebo to ROS."""
        return SpawnEntity.Response(success=gz.data)

    @staticmethod
    def fault(ros: Any) -> str | None:
        """What must not reach the simulator."""
        return not_finite(ros, "entity_factory.pose.position", "entity_factory.pose.orientation")


@service_types("ros_gz_interfaces/srv/DeleteEntity", "gz.msgs.Entity", "gz.msgs.Boolean")
class DeleteEntityTypes:
    """An entity, by id or by name and type."""

    @staticmethod
    def request_to_gz(ros: Any) -> Any:
        """ROS to Gazebo."""
        gz = Entity()
        ENTITY.to_gz(ros.entity, gz)
        return gz

    @staticmethod
    def reply_to_ros(gz: Any) -> Any:
        """Gazebo to ROS."""
        return DeleteEntity.Response(success=gz.data)


@service_types("ros_gz_interfaces/srv/SetEntityPose", "gz.msgs.Pose", "gz.msgs.Boolean")
class SetEntityPoseTypes:
    """A new pose for an entity, found by id or by name; its type does not travel."""

    @staticmethod
    def request_to_gz(ros: Any) -> Any:
        """ROS to Gazebo."""
        if ros.entity.id >= 2**32:
            raise ConversionError(f"the entity id {ros.entity.id} does not fit the 32 bits of gz.msgs.Pose")
        gz = Pose(name=ros.entity.name, id=ros.entity.id)
        copy_pose(ros.pose, gz)
        return gz

    @staticmethod
    def reply_to_ros(gz: Any) -> Any:
        """Gazebo to ROS."""
        return SetEntityPose.Response(success=gz.data)

    @staticmethod
    def fault(ros: Any) -> str | None:
        """What must not reach the simulator."""
        return not_finite(ros, "pose.position", "pose.orientation")
