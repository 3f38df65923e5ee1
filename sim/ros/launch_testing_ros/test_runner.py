"""The runner of launch tests marked `rostest`."""

from __future__ import annotations

from gz_course.sim.ros.launch_testing.test_runner import LaunchTestRunner as _LaunchTestRunner


class LaunchTestRunner(_LaunchTestRunner):
    """Runs launch tests with ROS nodes; the launch makes its own ROS node when an action needs one."""
