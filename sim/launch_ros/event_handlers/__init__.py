"""Event handlers for lifecycle nodes. They can be written in a launch file; lifecycle nodes are not executed here."""

from gz_course.sim.launch_ros.event_handlers.on_state_transition import OnStateTransition

__all__ = ["OnStateTransition"]
