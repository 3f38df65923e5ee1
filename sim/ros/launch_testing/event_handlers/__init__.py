"""Event handlers of launch tests."""

from gz_course.sim.ros.launch_testing.event_handlers.stdout_ready_listener import StdoutReadyListener

__all__ = ["StdoutReadyListener"]
