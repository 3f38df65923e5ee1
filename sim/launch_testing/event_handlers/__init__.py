"""Event handlers of launch tests."""

from gz_course.sim.launch_testing.event_handlers.stdout_ready_listener import StdoutReadyListener

__all__ = ["StdoutReadyListener"]
