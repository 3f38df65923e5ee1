"""The matcher of events by their names, for EventHandler.

Source: ros2/launch, launch/launch/launch_service.py, which looked for `event_named('launch.events.Shutdown')`
"""

from __future__ import annotations

from collections.abc import Callable

from gz_course.sim.ros.launch.event import Event


def event_named(event_name: str) -> Callable[[Event], bool]:
    """Return a matcher for events whose `name` is this, such as `launch.events.Shutdown`."""
    return lambda event: event.name == event_name
