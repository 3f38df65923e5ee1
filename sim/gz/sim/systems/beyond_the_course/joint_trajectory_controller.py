"""JointTrajectoryController: drives joints along the points of a trajectory with PID controllers.

`gz.msgs.JointTrajectory` on `/model/M/joint_trajectory` -> the current point is the target of each joint -> the outputs
of the position PID and the velocity PID and the effort of the point are added to a force. As in Gazebo points are not
interpolated and accelerations are ignored. Each new point publishes the fraction of points reached on
`<topic>_progress` (`Float`).

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/joint_traj_control/JointTrajectoryController.cc
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.driving.pid import PARAMETERS, PID
from gz_course.sim.gz.sim.physics.servos import FORCE, Drive, JointServo, find_drive
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_ONE_AXIS = frozenset(("revolute", "continuous", "prismatic"))
_DEFAULTS = (0.0, 0.0, 0.0, -1.0, 0.0, -1.0, 0.0, 0.0)
_PID_TAGS = tuple(f"{which}_{tag}" for which in ("position", "velocity") for tag in PARAMETERS)


@dataclass
class _Actuated:
    """One joint with its controllers and current targets."""

    joint: Joint
    initial: float
    by_position: PID
    by_velocity: PID
    position: float = 0.0
    velocity: float = 0.0
    effort: float = 0.0
    drive: Drive | None = None

    def start(self) -> None:
        self.position, self.velocity, self.effort = self.initial, 0.0, 0.0
        self.by_position.reset()
        self.by_velocity.reset()


@dataclass
class _Trajectory:
    """A commanded trajectory; `start_ns` is None until the next step."""

    joints: list[str] = field(default_factory=list)
    points: list[Any] = field(default_factory=list)
    start_ns: int | None = None
    index: int = -1


@system("JointTrajectoryController", "gz-sim-joint-trajectory-controller-system")
class JointTrajectoryController(System):
    """Drives all joints of a model that have one axis, or those that `<joint_name>` lists.

    The n-th `<position_p_gain>` (and so on) belongs to the n-th joint.
    """

    parameters = frozenset(("joint_name", "initial_position", "topic", "use_header_start_time", *_PID_TAGS))

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        return [JointServo(joint.name, FORCE) for joint in _enabled(model, plugin)]

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        for joint in self.scope.find_joints(element):
            if joint.kind not in _ONE_AXIS:
                own = self.scope.own_name(joint.name)
                text = f"JointTrajectoryController leaves out joint '{own}': a {joint.kind} joint has not just one axis"
                world.diagnostics.warn(element.where, text)
        lists = {tag: _numbers(element, tag) for tag in ("initial_position", *_PID_TAGS)}
        self.joints: dict[str, _Actuated] = {}
        for index, joint in enumerate(_enabled(self.scope.model, plugin)):
            by_position, by_velocity = (_nth_pid(lists, which, index) for which in ("position", "velocity"))
            initial = _nth(lists["initial_position"], index, 0.0)
            self.joints[self.scope.own_name(joint.name)] = _Actuated(joint, initial, by_position, by_velocity)
        if not self.joints:
            raise element.error(
                f"JointTrajectoryController finds no joint with one axis in model '{self.scope.full_name}'"
            )
        # Gazebo reads an attribute of this name; files usually have an element.
        stated = element.attributes.get("use_header_start_time", "false").lower() in ("true", "1")
        self._by_header = element.flag("use_header_start_time", stated)
        self.topic = valid_topic(element.text_of("topic"), f"/model/{self.scope.name}/joint_trajectory")
        self._publisher: Any = None

    def bind(self) -> None:
        for actuated in self.joints.values():
            servo = JointServo(actuated.joint.name, FORCE)
            actuated.drive = find_drive(self.world.model, self.scope.model, servo)

    def start(self) -> None:
        self._trajectory: _Trajectory | None = None
        for actuated in self.joints.values():
            actuated.start()

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.float_pb2 import Float
        from gz_course.sim.gz.msgs.joint_trajectory_pb2 import JointTrajectory

        self._float = Float
        node.subscribe(JointTrajectory, self.topic, self.command)
        self._publisher = node.advertise(f"{self.topic}_progress", Float)

    def command(self, message: Any) -> bool:
        """Follow a `JointTrajectory` from the next step on; return False if it is refused."""
        warn = self.world.diagnostics.warn
        names = list(message.joint_names)
        if not names:
            warn("", f"a trajectory on {self.topic} was dropped because it names no joints")
            return False
        for point in message.points:
            values = (*point.positions, *point.velocities, *point.effort)
            if not all(map(math.isfinite, values)):
                self.world.drop_command(self.topic, "a point of the trajectory")
                return False
        for name in names:
            if name not in self.joints:
                warn("", f"a trajectory on {self.topic} names joint '{name}', which is not driven and left out")
        if any(point.accelerations for point in message.points):
            warn("", f"accelerations in a trajectory on {self.topic} are ignored")
        made = _Trajectory(names, list(message.points))
        if self._by_header:
            made.start_ns = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nsec or None
        self._trajectory = made
        return True

    def pre_update(self, info: UpdateInfo) -> None:
        """Select the current point and apply forces towards its targets."""
        if self._trajectory is not None:
            self._follow(self._trajectory, info.sim_time_ns)
        data = self.world.data
        for actuated in self.joints.values():
            drive = actuated.drive
            if drive is None:
                continue
            force = actuated.by_position.update(drive.axis.read_position(data) - actuated.position, info.dt)
            force += actuated.by_velocity.update(drive.axis.read_velocity(data) - actuated.velocity, info.dt)
            drive.push(data, force + actuated.effort)

    def _follow(self, trajectory: _Trajectory, now_ns: int) -> None:
        points = trajectory.points
        if not points:
            self._trajectory = None
            return
        if trajectory.start_ns is None:
            trajectory.start_ns = now_ns
        elapsed, index = now_ns - trajectory.start_ns, max(trajectory.index, 0)
        while index + 1 < len(points) and _time_ns(points[index]) < elapsed:
            index += 1
        if index == trajectory.index:
            return
        trajectory.index = index
        point = points[index]
        for place, name in enumerate(trajectory.joints):
            actuated = self.joints.get(name)
            if actuated is not None:
                actuated.position = _nth(point.positions, place, actuated.position)
                actuated.velocity = _nth(point.velocities, place, actuated.velocity)
                actuated.effort = _nth(point.effort, place, actuated.effort)
        if index + 1 == len(points) and self._trajectory is trajectory:
            self._trajectory = None
        if self._publisher is not None and self._publisher.has_connections():
            self._publisher.publish(self._float(data=(index + 1) / len(points)))


def _enabled(model: Model, plugin: Plugin) -> list[Joint]:
    """Return the driven joints in the order of `<joint_name>`, else of the file."""
    prefix = f"{plugin.scope}::" if plugin.scope else ""
    names = [prefix + child.text for child in plugin.element.all("joint_name")]
    if not names:
        own = (joint.name for joint in model.joints if joint.name.startswith(prefix))
        names = [name for name in own if "::" not in name.removeprefix(prefix)]
    found = (model.joint(name) for name in dict.fromkeys(names))
    return [joint for joint in found if joint is not None and joint.kind in _ONE_AXIS]


def _numbers(element: Element, tag: str) -> list[float]:
    values = [child.floats(1)[0] for child in element.all(tag)]
    if tag.endswith(("gain", "position", "offset")) and not all(map(math.isfinite, values)):
        raise element.error(f"every <{tag}> must be finite")
    return values


def _nth(values: Any, index: int, default: float) -> float:
    return float(values[index]) if index < len(values) else default


def _nth_pid(lists: dict[str, list[float]], which: str, index: int) -> PID:
    return PID(
        *(_nth(lists[f"{which}_{tag}"], index, default) for tag, default in zip(PARAMETERS, _DEFAULTS, strict=True))
    )


def _time_ns(point: Any) -> int:
    return int(point.time_from_start.sec) * 1_000_000_000 + int(point.time_from_start.nsec)
