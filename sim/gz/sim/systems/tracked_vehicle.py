"""TrackedVehicle: converts velocity commands to the speeds of the tracks on both sides.

`Twist` on `/model/M/cmd_vel` (linear.x, angular.z) -> limits -> speeds and centre of rotation of the tracks, each
moved by a TrackController of the same topic. Tracks slip when they turn: their speeds differ by angular.z *
`<tracks_separation>` / `<steering_efficiency>`, which is set by `gz.msgs.Double` on `/model/M/steering_efficiency`,
too. Below 0.1 rad/s the tracks pull straight on, below 0.1 m/s round the middle of `<body_link>`.

The odometry on `/model/M/odometry` and `/model/M/tf` is the way that was commanded (in Gazebo its turns are larger by
the steering efficiency, and backward).

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/tracked_vehicle/TrackedVehicle.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.driving.odometry_reports import OdometryReports
from gz_course.sim.gz.sim.driving.speed_limiter import SpeedLimiter
from gz_course.sim.gz.sim.driving.wheel_odometry import WheelOdometry
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.systems.track_controller import TrackController

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_SLOW = 0.1
_LEFT = np.array((0.0, 1.0, 0.0))


class _Track:
    """One track: the topics of its speed and centre of rotation, and the system that listens to them."""

    def __init__(self, element: Element, model: str) -> None:
        name = element.text_of("link")
        if not name:
            raise element.error(f"<{element.tag}> needs a <link>, none was found")
        stem = f"/model/{model}/link/{name}"
        self.link = element.find("link")
        self.topic = valid_topic(element.text_of("velocity_topic"), f"{stem}/track_cmd_vel")
        centre = element.text_of("center_of_rotation_topic")
        self.centre_topic = valid_topic(centre, f"{stem}/track_cmd_center_of_rotation")
        self.controller: TrackController | None = None
        self.publishers: tuple[Any, Any] | None = None


@system("TrackedVehicle", "gz-sim-tracked-vehicle-system")
class TrackedVehicle(System):
    """Drives one model. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        (
            *("body_link", "left_track", "right_track", "tracks_separation", "tracks_height", "steering_efficiency"),
            *("linear_velocity", "angular_velocity", "topic", "steering_efficiency_topic", "debug"),
            *OdometryReports.parameters,
        )
    )
    joins_topics = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = scope = ModelScope(world, model, plugin, self.name)
        sides = [[_Track(each, scope.name) for each in element.all(f"{side}_track")] for side in ("left", "right")]
        self._sides = sides
        for side, tracks in zip(("left", "right"), sides, strict=True):
            if not tracks:
                raise element.error(f"TrackedVehicle needs at least one <{side}_track>, none was found")
        for track in element.all("left_track", "right_track"):
            scope.find_links(track, "link")
        body = next(iter(scope.find_links(element, "body_link")), None)
        self._body_link = body.name if body is not None else scope.canonical_link
        self._separation = _positive(element, "tracks_separation", 1.0)
        self._stated_efficiency = _positive(element, "steering_efficiency", 0.5)
        linear, angular = element.find("linear_velocity"), element.find("angular_velocity")
        self._limit_linear = SpeedLimiter() if linear is None else SpeedLimiter.from_sdf(linear, "linear")
        self._limit_angular = SpeedLimiter() if angular is None else SpeedLimiter.from_sdf(angular, "angular")
        self.topic = valid_topic(element.text_of("topic"), f"/model/{scope.name}/cmd_vel")
        self.efficiency_topic = valid_topic(
            element.text_of("steering_efficiency_topic"), f"/model/{scope.name}/steering_efficiency"
        )
        self.reports = OdometryReports(scope, element)
        self._odometry = WheelOdometry(self._separation, 1.0)

    def bind(self) -> None:
        """Find the systems that move the tracks; they are told directly, so that a command needs no transport."""
        known = {each.topic: each for each in self.world.systems if isinstance(each, TrackController)}
        for track in (*self._sides[0], *self._sides[1]):
            track.controller = known.get(track.topic)

    def start(self) -> None:
        self._target = (0.0, 0.0)
        self._last = self._before_last = (0.0, 0.0)
        self._new = False
        self.efficiency = self._stated_efficiency
        """The share of the difference of the tracks' speeds that turns the vehicle."""
        self._odometry.reset(0.0, 0.0)
        self._ways = [0.0, 0.0]
        self._started = False
        self.reports.start()

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.double_pb2 import Double
        from gz_course.sim.gz.msgs.twist_pb2 import Twist
        from gz_course.sim.gz.msgs.vector3d_pb2 import Vector3d

        self._double, self._vector = Double, Vector3d
        node.subscribe(Twist, self.topic, self._on_command)
        node.subscribe(Double, self.efficiency_topic, self._on_efficiency)
        for track in (*self._sides[0], *self._sides[1]):
            if track.controller is None:
                track.publishers = node.advertise(track.topic, Double), node.advertise(track.centre_topic, Vector3d)
        self.reports.connect(node)

    def command(self, linear: float, angular: float) -> bool:
        """Set the commanded forward speed [m/s] and yaw rate [rad/s]; return False if they are refused."""
        if not (math.isfinite(linear) and math.isfinite(angular)):
            self.world.drop_command(self.topic, f"linear.x={linear}, angular.z={angular}")
            return False
        self._target, self._new = (min(max(linear, -1e6), 1e6), min(max(angular, -1e6), 1e6)), True
        return True

    def _on_command(self, message: Any) -> None:
        self.command(message.linear.x, message.angular.z)

    def _on_efficiency(self, message: Any) -> None:
        if not 0.0 < message.data < math.inf:
            self.world.drop_command(self.efficiency_topic, f"data={message.data}")
            return
        self.efficiency, self._new = message.data, True

    def post_update(self, info: UpdateInfo) -> None:
        """Limit the command and pass it to the tracks; publish the odometry when due."""
        last, before = self._last, self._before_last
        linear = self._limit_linear.limit(self._target[0], last[0], before[0], info.dt)
        angular = self._limit_angular.limit(self._target[1], last[1], before[1], info.dt)
        self._before_last, self._last = last, (linear, angular)
        if self._new or abs(linear - last[0]) > 1e-6 or abs(angular - last[1]) > 1e-6:
            self._new = False
            self._drive(linear, angular)
        turn = angular * self._separation / 2.0
        for side, speed in enumerate((linear - turn, linear + turn)):
            self._ways[side] += speed * info.dt
        if not self._started:
            self._started = True
            return
        odometry = self._odometry
        odometry.update(self._ways[0], self._ways[1], info.dt)
        if self.reports.due(info.sim_time_ns):
            pose = (odometry.x, odometry.y, odometry.heading)
            self.reports.publish(info.sim_time_ns, pose, odometry.linear, odometry.angular)

    def _drive(self, linear: float, angular: float) -> None:
        turn = angular * self._separation / (2.0 * self.efficiency)
        centre: Vector | None = None
        if abs(angular) >= _SLOW:
            pose = self.world.truth.link_pose(self.scope.model.name, self._body_link)
            radius = linear / angular if abs(linear) >= _SLOW else 0.0
            centre = pose.position + radius * rotate(pose.quaternion, _LEFT)
        for tracks, speed in zip(self._sides, (-(linear - turn), -(linear + turn)), strict=True):
            for track in tracks:
                if track.controller is not None:
                    track.controller.command(speed, centre)
                elif track.publishers is not None:
                    x, y, z = (math.inf,) * 3 if centre is None else centre.tolist()
                    track.publishers[0].publish(self._double(data=speed))
                    track.publishers[1].publish(self._vector(x=x, y=y, z=z))


def _positive(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 < value < math.inf:
        raise element.error(f"TrackedVehicle's <{tag}> must be greater than zero, got {value:g}")
    return value
