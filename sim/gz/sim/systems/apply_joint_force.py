"""ApplyJointForce: pushes a joint with a commanded force, on top of what else drives it.

`gz.msgs.Double` on `/model/M/joint/J/cmd_force` (N m or N); the last one holds until another comes.
"""

from __future__ import annotations

from gz_course.sim.gz.sim.physics.servos import APPLIED
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.systems.joint_command import JointCommand
from gz_course.sim.gz.sim.systems.registry import UpdateInfo, system


@system("ApplyJointForce", "gz-sim-apply-joint-force-system")
class ApplyJointForce(JointCommand):
    """Pushes one joint; at most with the effort its limits allow."""

    quantity = "cmd_force"
    parameters = frozenset(("joint_name",))

    @classmethod
    def servo_kind(cls, element: Element) -> str:
        """A motor of its own."""
        return APPLIED

    def start(self) -> None:
        """Push with nothing."""
        self.value = 0.0

    def pre_update(self, info: UpdateInfo) -> None:
        """Push."""
        for drive in self.drives:
            drive.push(self.world.data, self.value)
