"""Descriptions of what can be executed."""

from gz_course.sim.ros.launch.descriptions.executable import Executable

__all__ = ["Executable"]
