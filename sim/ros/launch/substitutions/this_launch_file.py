"""The substitution for the path of the launch file that is being executed."""

from __future__ import annotations

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitutions.divisible import Divisible
from gz_course.sim.ros.launch.substitutions.local_substitution import local_value

CURRENT_FILE = "current_launch_file_path"


class ThisLaunchFile(Divisible):
    """The path of the launch file."""

    def describe(self) -> str:
        return "ThisLaunchFile()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure outside of a launch file."""
        return local_value(context, CURRENT_FILE, "ThisLaunchFile is used outside of a launch file")
