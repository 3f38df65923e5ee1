"""TrackController: the belt of a track or conveyor, which is one link.

The belt moves along the x axis of the link, turned by `<track_orientation>` [rad]. As in Gazebo a positive speed
[m/s] on `/model/M/link/L/track_cmd_vel` (`gz.msgs.Double`) moves its lower side forward, so that a vehicle on it goes
backward. With a centre of rotation [m, world] on `/model/M/link/L/track_cmd_center_of_rotation` (`gz.msgs.Vector3d`)
the belt pulls along circles round it. A speed older than `<max_command_age>` [s] counts as zero.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/track_controller/TrackController.cc; M. Pecka,
K. Zimmermann, T. Svoboda, Fast simulation of vehicles with non-deformable tracks, IROS 2017
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.driving.speed_limiter import SpeedLimiter, limit_parameters
from gz_course.sim.gz.sim.physics import surface_motion
from gz_course.sim.gz.sim.physics.contacts import CollisionGeoms
from gz_course.sim.gz.sim.physics.pushes import cross
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, quaternion_from_rpy, rotate
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_ACROSS = np.array((0.0, 1.0, 0.0))


@system("TrackController", "gz-sim-track-controller-system")
class TrackController(System):
    """Moves one belt. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        (
            *limit_parameters(),
            "link",
            "velocity_topic",
            "center_of_rotation_topic",
            "track_orientation",
            "max_command_age",
            "debug",
        )
    )

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = scope = ModelScope(world, model, plugin, self.name)
        if element.find("link") is None:
            raise element.error("TrackController needs a <link>, none was found")
        self._link = next(iter(scope.find_links(element, "link")), None)
        stem = f"/model/{scope.name}/link/{element.text_of('link')}"
        self.topic = valid_topic(element.text_of("velocity_topic"), f"{stem}/track_cmd_vel")
        self.centre_topic = valid_topic(
            element.text_of("center_of_rotation_topic"), f"{stem}/track_cmd_center_of_rotation"
        )
        self._turn = quaternion_from_rpy(*element.vector("track_orientation", (0.0, 0.0, 0.0)))
        age = element.number("max_command_age", math.inf)
        self._oldest_ns = int(age * 1e9) if 0.0 <= age < 1e9 else -1
        self._limiter = SpeedLimiter.from_sdf(element, "track")

    def bind(self) -> None:
        surface_motion.prepare(self.world)
        name = self._link.name if self._link is not None else ""
        self._geoms = {
            geom for geom, path in CollisionGeoms(self.world).paths.items() if path[:2] == (self.scope.model.name, name)
        }

    def start(self) -> None:
        self._wanted = self._speed = self._last = self._before_last = 0.0
        self._centre: Vector | None = None
        self._new = False
        self._told_ns = 0

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.double_pb2 import Double
        from gz_course.sim.gz.msgs.vector3d_pb2 import Vector3d

        node.subscribe(Double, self.topic, self._on_speed)
        node.subscribe(Vector3d, self.centre_topic, self._on_centre)

    def command(self, speed: float, centre: Vector | None) -> None:
        """Set the speed of the belt [m/s], and the centre of rotation [m] unless it goes straight."""
        self._wanted, self._centre, self._new = speed, centre, True

    def _on_speed(self, message: Any) -> None:
        if not math.isfinite(message.data):
            self.world.drop_command(self.topic, f"data={message.data}")
            return
        self._wanted, self._new = message.data, True

    def _on_centre(self, message: Any) -> None:
        place = np.array((message.x, message.y, message.z))
        # A centre that is not finite means straight on, as in Gazebo.
        self._centre, self._new = (place if np.isfinite(place).all() else None), True

    def pre_update(self, info: UpdateInfo) -> None:
        if self._new:
            self._told_ns, self._new = info.sim_time_ns, False
        wanted = 0.0 if 0 <= self._oldest_ns < info.sim_time_ns - self._told_ns else self._wanted
        self._speed = self._limiter.limit(wanted, self._last, self._before_last, info.dt)
        self._before_last, self._last = self._last, self._speed

    def in_step(self, info: UpdateInfo) -> None:
        """Move the belt where it touches something."""
        if not self._geoms or not self.world.data.ncon or self._link is None:
            return
        self.world.truth.refresh()
        pose = self.world.truth.link_pose(self.scope.model.name, self._link.name)
        across = rotate(pose.quaternion, rotate(self._turn, _ACROSS))
        speed, centre = self._speed, self._centre

        def motion(geom: int, point: Vector, inward: Vector) -> Vector:
            ahead = cross(inward, across)
            direction = ahead
            if centre is not None:
                direction = cross(inward, point - centre)
                length = float(np.linalg.norm(direction))
                direction = direction / length if length > 1e-9 else ahead
                if float(direction @ ahead) < 0.0:
                    direction = -direction
            return speed * direction

        surface_motion.move(self.world, self._geoms, motion)
