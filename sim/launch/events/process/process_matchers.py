"""The matchers of processes, in the module where launch of ROS 2 has them."""

from launch.events.process.signal_process import matches_executable, matches_name, matches_pid

__all__ = ["matches_executable", "matches_name", "matches_pid"]
