"""Events of lifecycle nodes."""

from gz_course.sim.ros.launch_ros.events.lifecycle.change_state import ChangeState
from gz_course.sim.ros.launch_ros.events.lifecycle.state_transition import StateTransition
from gz_course.sim.ros.launch_ros.events.matchers import matches_node_name

__all__ = ["ChangeState", "StateTransition", "matches_node_name"]
