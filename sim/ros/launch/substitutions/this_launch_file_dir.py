"""The substitution for the folder of the launch file that is being executed."""

from __future__ import annotations

from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitutions.divisible import Divisible
from gz_course.sim.ros.launch.substitutions.local_substitution import local_value

CURRENT_FOLDER = "current_launch_file_directory"


class ThisLaunchFileDir(Divisible):
    """The folder of the launch file; inside an included file, that of the included file."""

    def describe(self) -> str:
        return "ThisLaunchFileDir()"

    def perform(self, context: LaunchContext) -> str:
        """Return the path. Raises SubstitutionFailure outside of a launch file."""
        return local_value(context, CURRENT_FOLDER, "ThisLaunchFileDir is used outside of a launch file")
