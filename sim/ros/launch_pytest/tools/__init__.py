"""Waiting for the processes of a launch."""

from gz_course.sim.ros.launch_pytest.tools import process

__all__ = ["process"]
