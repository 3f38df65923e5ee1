"""The error of a substitution that has no text."""

from __future__ import annotations

from gz_course.sim.ros.launch.errors import LaunchError


class SubstitutionFailure(LaunchError, RuntimeError):
    """A substitution could not be performed."""
