"""Force-torque sensor of a joint: the wrench between its two links, as `gz.msgs.Wrench`.

The ForceTorque system runs it. `<frame>` selects the axes (parent, child or sensor), `<measure_direction>` the link
that the wrench acts on; the torque is about the sensor's position.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/ForceTorqueSensor.cc
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.physics.motion import start_of_step
from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.pose import Vector
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

SDF_WORDS = {
    "sensor": "force_torque",
    "force_torque": "frame measure_direction force torque range",
    "force": "x y z",
    "torque": "x y z",
}

FRAMES = ("child", "parent", "sensor")
DIRECTIONS = ("child_to_parent", "parent_to_child")
"""The measured wrench: `a_to_b` is that of link a on link b. The first one is the default."""


@sensor_type("force_torque")
class ForceTorque(SiteSensor):
    """Measures the wrench that a joint of any type transmits, including a fixed joint."""

    runs_in = sensor_system("ForceTorque", "gz-sim-forcetorque-system")
    suffix = "forcetorque"
    message_type = "gz.msgs.Wrench"

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read `<force_torque>`. Raises SdfError for an unknown frame or direction; warns if the sensor is not in a
        joint.
        """
        super().__init__(world, description)
        element = description.element
        self.frame = _choice(element, "frame", FRAMES)
        self.direction = _choice(element, "measure_direction", DIRECTIONS)
        if not description.joint:
            text = f"sensor '{description.name}' stays silent: a force_torque sensor must stand in a <joint>, this one "
            world.diagnostics.warn(element.where, text + f"stands in link '{description.link}'")

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noises of the force [N] and the torque [N m], x y z each."""
        names = [f"{kind}/{axis}" for kind in ("force", "torque") for axis in "xyz"]
        return [(name, noise_at(element, f"force_torque/{name}")) for name in names]

    def connect(self, node: Node) -> None:
        if self.description.joint:
            super().connect(node)

    def bind(self) -> None:
        """Find the bodies of the joint's links; -1 for a static link, which is not measured."""
        super().bind()
        self._child, self._parent, self._weightless = -1, 0, np.zeros(0, dtype=np.int64)
        model, joint = self._joint()
        if joint is None or model.static:
            return
        compiled = self.world.model
        self._child = mujoco.mj_name2id(compiled, mujoco.mjtObj.mjOBJ_BODY, scoped(model, joint.child))
        parent = mujoco.mj_name2id(compiled, mujoco.mjtObj.mjOBJ_BODY, scoped(model, joint.parent))
        self._parent = max(0, parent)
        if self._child > 0 and compiled.body_parentid[self._child] != self._parent:
            text = f"sensor '{self.description.name}' reports zeros: joint '{joint.name}' closes a loop of joints"
            self.world.diagnostics.warn(self.description.element.where, text)
            self._child = -1
        below = [body for body in range(compiled.nbody) if self._child > 0 and self._carries(body)]
        self._weightless = np.array([body for body in below if compiled.body_gravcomp[body] != 0.0], dtype=np.int64)

    def _joint(self) -> tuple[Model, Joint | None]:
        model = next(each for each in self.world.description.models if each.name == self.description.model)
        return model, model.joint(self.description.joint)

    def _carries(self, body: int) -> bool:
        """Tell whether a body is the joint's child or one of its descendants."""
        while body > 0 and body != self._child:
            body = int(self.world.model.body_parentid[body])
        return body == self._child

    def wrench(self) -> tuple[Vector, Vector]:
        """Return the force [N] and the torque [N m] about the sensor that the parent applied to the child during the
        last step, along the requested axes.
        """
        if self._child <= 0:
            return np.zeros(3), np.zeros(3)
        with start_of_step(self.world):
            force, torque = self._in_world()
            body = self._parent if self.frame == "parent" else self._child
            turn = self.motion.rotation() if self.frame == "sensor" else self.world.data.xmat[body].reshape(3, 3)
            return force @ turn, torque @ turn

    def _in_world(self) -> tuple[Vector, Vector]:
        """Return MuJoCo's `cfrc_int` of the child: its inertial forces minus the external forces.

        Source: https://mujoco.readthedocs.io/en/stable/APIreference/APIfunctions.html (mj_rnePostConstraint)
        """
        model, data, child = self.world.model, self.world.data, self._child
        here = self.motion.position()
        moment, force = data.cfrc_int[child][:3].copy(), data.cfrc_int[child][3:].copy()
        moment += np.cross(data.subtree_com[model.body_rootid[child]] - here, force)
        # The gravity compensation of links without gravity is missing in MuJoCo's external forces.
        for body in self._weightless:
            lift = -model.body_mass[body] * model.body_gravcomp[body] * model.opt.gravity
            force -= lift
            moment -= np.cross(data.xipos[body] - here, lift)
        return force, moment

    def fill(self, message: Any) -> None:
        sign = 1.0 if self.direction == "parent_to_child" else -1.0
        measured = self.noise.apply((np.concatenate(self.wrench()) * sign).tolist())
        into, about = message.force, message.torque
        into.x, into.y, into.z, about.x, about.y, about.z = measured


def _choice(element: Element, tag: str, known: tuple[str, ...]) -> str:
    found = element.find(f"force_torque/{tag}")
    if found is None or not found.text:
        return known[0]
    if found.text not in known:
        raise found.error(f"<{tag}> '{found.text}' is not known{did_you_mean(found.text, known, listing='it may be')}")
    return found.text
