"""JointPositionController: drives joints to a commanded position with a PID controller.

`gz.msgs.Double` on `/model/M/joint/J/0/cmd_pos` [rad or m] -> error of the first joint -> PID -> force on every joint.
With `<use_velocity_commands>` there is no PID: the joints move at once, or with the speed `<cmd_max>`.

Source: JointPositionController.cc, https://github.com/gazebosim/gz-sim/tree/gz-sim8/src/systems/joint_position_controller
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


@system("JointPositionController", "gz-sim-joint-position-controller-system")
class JointPositionController(JointCommand):
    """Controls the position of joints; with several `<joint_name>` the first joint is measured and all are driven."""

    quantity = "cmd_pos"
    actuators_field = "position"
    parameters = JointCommand.TOPIC_PARAMETERS | {
        *pid.PARAMETERS,
        "joint_index",
        "use_velocity_commands",
        "initial_position",
    }

    @classmethod
    def servo_kind(cls, element: Element) -> str:
        """Return the kind of a motor, or of a servo with `<use_velocity_commands>`."""
        return VELOCITY if element.flag("use_velocity_commands", False) else FORCE

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        super().configure(world, model, plugin)
        element = plugin.element
        self.pid = pid.PID.from_sdf(element, 1.0, 0.1, 0.01, 1.0, -1.0, 1000.0, -1000.0, 0.0)
        self._direct = element.flag("use_velocity_commands", False)
        self._fastest = abs(element.number("cmd_max", 0.0)) if element.text_of("cmd_max") else float("inf")
        self._initial = element.number("initial_position", 0.0)

    def default_topic(self, joint: str) -> str:
        """Return Gazebo's name, which contains the axis number."""
        return f"/model/{self.scope.name}/joint/{joint}/{self.index}/{self.quantity}"

    def start(self) -> None:
        self.value = self._initial
        self.pid.reset()

    def pre_update(self, info: UpdateInfo) -> None:
        drives = self.drives
        if not drives:
            return
        data = self.world.data
        error = drives[0].axis.read_position(data) - self.value
        if self._direct:
            speed = min(max(-error / info.dt, -self._fastest), self._fastest)
            for drive in drives:
                drive.hold(data, speed, info.dt)
            return
        for drive in drives:
            # As in Gazebo one controller updates all joints in turn, so the second joint gets no derivative term.
            drive.push(data, self.pid.update(error, info.dt))
