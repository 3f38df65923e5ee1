"""Something that happened while a launch file runs; the classes are in `launch.events`."""

from __future__ import annotations


class Event:
    """Base of all events. `name` is what it is called in messages."""

    name = "launch.Event"
