"""Event handlers for lifecycle nodes."""

from gz_course.sim.ros.launch_ros.event_handlers.on_state_transition import OnStateTransition

__all__ = ["OnStateTransition"]
