"""Events of nodes, and their matchers; events of lifecycle nodes are in `launch_ros.events.lifecycle`."""

from gz_course.sim.ros.launch_ros.events import lifecycle
from gz_course.sim.ros.launch_ros.events.matchers import matches_node_name

__all__ = ["lifecycle", "matches_node_name"]
