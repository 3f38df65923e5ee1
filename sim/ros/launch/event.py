"""The base class of events. The events are in `launch.events`."""

from __future__ import annotations


class Event:
    """An occurrence during a launch; `name` is used in messages."""

    name = "launch.Event"
