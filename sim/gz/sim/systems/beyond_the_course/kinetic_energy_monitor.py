"""KineticEnergyMonitor: reports a large loss of kinetic energy of a link in one step, as in a crash.

MuJoCo's state -> `gz.msgs.Double` with the loss [J] on `/model/M/kinetic_energy` if it exceeds
`<kinetic_energy_threshold>` (default 7 [J]).

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/kinetic_energy_monitor/KineticEnergyMonitor.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


@system("KineticEnergyMonitor", "gz-sim-kinetic-energy-monitor-system")
class KineticEnergyMonitor(System):
    """Monitors the link `<link_name>`."""

    parameters = frozenset(("link_name", "kinetic_energy_threshold", "topic"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read link, threshold and topic. Raises SdfError if no link is named."""
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        if not element.text_of("link_name"):
            raise element.error("KineticEnergyMonitor needs a <link_name>, none was found")
        self.links = self.scope.find_links(element)[:1]
        self._threshold = element.number("kinetic_energy_threshold", 7.0)
        self.topic = valid_topic(element.text_of("topic"), f"/model/{self.scope.name}/kinetic_energy")
        self._publisher: Any = None

    def bind(self) -> None:
        self._body = self.scope.body(self.links[0].name) if self.links else -1

    def start(self) -> None:
        self._before: float | None = None

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.double_pb2 import Double

        self._type = Double
        self._publisher = node.advertise(self.topic, Double)

    def energy(self) -> float:
        """Return the kinetic energy of the link [J]."""
        model, data = self.world.model, self.world.data
        if self._body <= 0:
            return 0.0
        self.world.truth.refresh()
        mujoco.mj_comPos(model, data)
        mujoco.mj_comVel(model, data)
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_BODY, self._body, velocity, 1)
        turning = model.body_inertia[self._body] @ velocity[:3] ** 2
        moving = model.body_mass[self._body] * (velocity[3:] @ velocity[3:])
        return float(turning + moving) / 2.0

    def post_update(self, info: UpdateInfo) -> None:
        """Compare with the previous step, if there is a subscriber."""
        if self._publisher is None or not self._publisher.has_connections():
            self._before = None
            return
        now, before = self.energy(), self._before
        self._before = now
        if before is not None and before - now > self._threshold:
            self._publisher.publish(self._type(data=before - now))
