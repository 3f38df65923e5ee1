"""Use `wtf` as alias to `doctor`."""

from __future__ import annotations

from gz_course.sim.ros.ros2.command.doctor import add_arguments, main

__all__ = ["add_arguments", "main"]
