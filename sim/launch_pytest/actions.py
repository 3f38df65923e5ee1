"""The action that lets the tests begin."""

from gz_course.sim.launch_testing.actions.ready import ReadyToTest

__all__ = ["ReadyToTest"]
