"""VelocityControl: moves a model with a commanded velocity, without wheels or propellers.

`Twist` on `/model/M/cmd_vel` (in the model's axes), and on `/model/M/link/L/cmd_vel` for the links that `<link_name>`
lists (in the link's axes) -> velocity of the free joint in MuJoCo, set before every step. Obstacles and gravity act
within a step only; without a command the model is held in place.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/velocity_control/VelocityControl.cc
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Link, Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

FASTEST = 1e4
"""Maximum commanded velocity [m/s, rad/s]."""
_INVERSE = np.array((1.0, -1.0, -1.0, -1.0))
_FREE = int(mujoco.mjtJoint.mjJNT_FREE)


@dataclass(slots=True)
class _Twist:
    linear: Vector
    angular: Vector


@system("VelocityControl", "gz-sim-velocity-control-system")
class VelocityControl(System):
    """Moves one model; as in Gazebo a command takes effect one step after it is received and holds without a
    timeout.
    """

    parameters = frozenset(("topic", "link_name", "initial_linear", "initial_angular"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        zero = (0.0, 0.0, 0.0)
        initial = (*element.vector("initial_linear", zero), *element.vector("initial_angular", zero))
        if not all(map(math.isfinite, initial)):
            raise element.error("VelocityControl's <initial_linear> and <initial_angular> must be finite")
        self._initial = initial
        self.topic = valid_topic(element.text_of("topic"), f"/model/{self.scope.name}/cmd_vel")
        self.links = self.scope.find_links(element)
        self.link_topics = [
            valid_topic(f"/model/{self.scope.name}/link/{self.scope.own_name(link.name)}/cmd_vel")
            for link in self.links
        ]
        self._where = element.where
        self.start()

    def bind(self) -> None:
        scope = self.scope
        roots = {self._free_root(link.name): None for link in scope.model.links}
        self._roots = [root for root in roots if root >= 0]
        self._reference = self._free_root(scope.canonical_link)
        if self._reference < 0:
            text = (
                f"VelocityControl cannot move model '{scope.full_name}': it is static or held by a joint to the world"
            )
            self.world.diagnostics.warn(self._where, text)

    def start(self) -> None:
        self._target = self._present = _twist(*self._initial)
        self._link_targets: dict[str, _Twist] = {}
        self._link_present: dict[str, _Twist] = {}

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.twist_pb2 import Twist

        node.subscribe(Twist, self.topic, self._on_command)
        for link, topic in zip(self.links, self.link_topics, strict=True):
            node.subscribe(Twist, topic, self._listener(link, topic))

    def command(self, linear: tuple[float, float, float], angular: tuple[float, float, float]) -> bool:
        """Set the commanded velocity of the model ([m/s], [rad/s], its own axes); return False if it is refused."""
        if self._refuses(self.topic, *linear, *angular):
            return False
        self._target = _twist(*linear, *angular)
        return True

    def command_link(self, link: str, linear: tuple[float, float, float], angular: tuple[float, float, float]) -> bool:
        """Set the commanded velocity of a link (scoped name; [m/s], [rad/s], its own axes)."""
        topic = next(topic for each, topic in zip(self.links, self.link_topics, strict=True) if each.name == link)
        if self._refuses(topic, *linear, *angular):
            return False
        self._link_targets[link] = _twist(*linear, *angular)
        return True

    def _refuses(self, topic: str, *values: float) -> bool:
        if all(map(math.isfinite, values)):
            return False
        self.world.drop_command(topic, f"linear={values[:3]}, angular={values[3:]}")
        return True

    def _on_command(self, message: Any) -> None:
        self.command(*_parts(message))

    def _listener(self, link: Link, topic: str) -> Callable[[Any], None]:
        def listen(message: Any) -> None:
            self.command_link(link.name, *_parts(message))

        return listen

    def pre_update(self, info: UpdateInfo) -> None:
        model, data = self.world.model, self.world.data
        if self._reference >= 0:
            turn = self.scope.world_pose().quaternion
            linear, angular = rotate(turn, self._present.linear), rotate(turn, self._present.angular)
            origin = data.qpos[int(model.jnt_qposadr[self._reference]) :][:3].copy()
            for root in self._roots:
                self._set(root, linear, angular, origin)
        for name, twist in self._link_present.items():
            root = self._free_root(name)
            if root >= 0:
                pose = self.world.truth.link_pose(self.scope.model.name, name)
                turn = pose.quaternion
                self._set(root, rotate(turn, twist.linear), rotate(turn, twist.angular), pose.position)

    def post_update(self, info: UpdateInfo) -> None:
        self._present = self._target
        if self._link_targets:
            self._link_present.update(self._link_targets)
            self._link_targets = {}

    def _set(self, root: int, linear: Vector, angular: Vector, origin: Vector) -> None:
        """Set the velocity of a free joint to `linear` at the point `origin` and `angular` (world axes)."""
        model, data = self.world.model, self.world.data
        position, velocity = int(model.jnt_qposadr[root]), int(model.jnt_dofadr[root])
        data.qvel[velocity : velocity + 3] = linear + np.cross(angular, data.qpos[position : position + 3] - origin)
        turn = data.qpos[position + 3 : position + 7] * _INVERSE
        data.qvel[velocity + 3 : velocity + 6] = rotate(turn, angular)

    def _free_root(self, link: str) -> int:
        """Return the free joint that carries a link (scoped name), -1 if the link is static."""
        model = self.world.model
        body = self.scope.body(link)
        if body <= 0:
            return -1
        root = int(model.body_rootid[body])
        joint = int(model.body_jntadr[root])
        return joint if joint >= 0 and int(model.jnt_type[joint]) == _FREE else -1


def _twist(*values: float) -> _Twist:
    limited = [min(max(value, -FASTEST), FASTEST) for value in values]
    return _Twist(np.array(limited[:3]), np.array(limited[3:]))


def _parts(message: Any) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    linear, angular = message.linear, message.angular
    return (linear.x, linear.y, linear.z), (angular.x, angular.y, angular.z)
