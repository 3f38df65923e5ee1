"""JointController: keeps joints at a commanded velocity.

`gz.msgs.Double` on `/model/M/joint/J/cmd_vel` [rad/s or m/s] -> servos that hold the velocity against loads up to the
effort of the joint; with `<use_force_commands>` a PID controller computes a force from the error of the first joint.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/joint_controller/JointController.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.driving import pid
from gz_course.sim.gz.sim.driving.joint_command import JointCommand
from gz_course.sim.gz.sim.physics.servos import FORCE, VELOCITY
from gz_course.sim.gz.sim.plugins.system import UpdateInfo, system
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


@system("JointController", "gz-sim-joint-controller-system")
class JointController(JointCommand):
    """Controls the velocity of joints; as in Gazebo it holds `<initial_velocity>` (default 0) from the start."""

    quantity = "cmd_vel"
    actuators_field = "velocity"
    parameters = JointCommand.TOPIC_PARAMETERS | {*pid.PARAMETERS, "use_force_commands", "initial_velocity"}

    @classmethod
    def servo_kind(cls, element: Element) -> str:
        """Return the kind of a servo, or of a motor with `<use_force_commands>`."""
        return FORCE if element.flag("use_force_commands", False) else VELOCITY

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        super().configure(world, model, plugin)
        element = plugin.element
        self.pid = pid.PID.from_sdf(element, 1.0, 0.0, 0.0, 1.0, -1.0, 1000.0, -1000.0, 0.0)
        self._by_force = element.flag("use_force_commands", False)
        self._initial = element.number("initial_velocity", 0.0)

    def start(self) -> None:
        self.value = self._initial
        self.pid.reset()

    def pre_update(self, info: UpdateInfo) -> None:
        """Write the velocity to the servos or the force to the motors."""
        data, drives = self.world.data, self.drives
        if not self._by_force:
            for drive in drives:
                drive.hold(data, self.value, info.dt)
        elif drives:
            error = drives[0].axis.read_velocity(data) - self.value
            for drive in drives:
                drive.push(data, self.pid.update(error, info.dt))
