"""The base of events. The events are in `launch.events`."""

from __future__ import annotations


class Event:
    """Something that happens while a launch file runs; messages call it `name`."""

    name = "launch.Event"
