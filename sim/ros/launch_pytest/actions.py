"""The action that lets the tests begin."""

from gz_course.sim.ros.launch_testing.actions.ready import ReadyToTest

__all__ = ["ReadyToTest"]
