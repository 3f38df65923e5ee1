"""The substitution for the folder of the log files."""

from __future__ import annotations

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.substitutions.divisible import Divisible


class LaunchLogDir(Divisible):
    """The folder of this run's log files."""

    def describe(self) -> str:
        return "LaunchLogDir()"

    def perform(self, context: LaunchContext) -> str:
        return launch_logging.launch_config.log_dir
