"""ApplyJointForce: applies a commanded force to a joint, in addition to other actuators.

`gz.msgs.Double` on `/model/M/joint/J/cmd_force` [N m or N] holds until the next one.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/apply_joint_force/ApplyJointForce.cc
"""

from __future__ import annotations

from gz_course.sim.gz.sim.driving.joint_command import JointCommand
from gz_course.sim.gz.sim.physics.servos import APPLIED
from gz_course.sim.gz.sim.plugins.system import UpdateInfo, system
from gz_course.sim.gz.sim.sdf.element import Element


@system("ApplyJointForce", "gz-sim-apply-joint-force-system")
class ApplyJointForce(JointCommand):
    """Applies a force to one joint, limited to the effort of the joint."""

    quantity = "cmd_force"
    parameters = frozenset(("joint_name",))

    @classmethod
    def servo_kind(cls, element: Element) -> str:
        return APPLIED

    def start(self) -> None:
        self.value = 0.0

    def pre_update(self, info: UpdateInfo) -> None:
        for drive in self.drives:
            drive.push(self.world.data, self.value)
