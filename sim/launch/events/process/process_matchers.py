"""The matchers of processes, in the module where launch of ROS 2 has them."""

from gz_course.sim.launch.events.process.signal_process import matches_executable, matches_name, matches_pid

__all__ = ["matches_executable", "matches_name", "matches_pid"]
