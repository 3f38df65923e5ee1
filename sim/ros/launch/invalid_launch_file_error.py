"""The error of a launch file that cannot be loaded."""

from __future__ import annotations

from gz_course.sim.ros.launch.errors import LaunchError


class InvalidLaunchFileError(LaunchError):
    """A launch file is missing, is no launch file, or lacks a required part."""
