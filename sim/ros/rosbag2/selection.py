"""Which topics are recorded or played.

Source: rosbag2_transport 0.26 (`topic_filter.cpp`)
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from gz_course.sim.ros.rosbag2.errors import BagError

SERVICE_EVENTS = "/_service_event"
"""What the topic of a service's events ends with."""


@dataclass(frozen=True)
class Selection:
    """Topics by name, by expression or by type; `all` takes every one, and what is excluded is never taken."""

    all: bool = False
    topics: tuple[str, ...] = ()
    regex: str = ""
    types: tuple[str, ...] = ()
    without_regex: str = ""
    without_topics: tuple[str, ...] = ()
    without_types: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for expression in (self.regex, self.without_regex):
            try:
                re.compile(expression)
            except (re.error, RecursionError, OverflowError) as error:
                raise BagError(f"'{expression}' is not a regular expression: {error}") from None

    def takes(self, topic: str, type_name: str) -> bool:
        if topic in self.without_topics or type_name in self.without_types:
            return False
        if self.without_regex and re.search(self.without_regex, topic):
            return False
        by_regex = bool(self.regex and re.search(self.regex, topic))
        return self.all or topic in self.topics or type_name in self.types or by_regex


def is_hidden(topic: str) -> bool:
    """Return whether a part of the name begins with _."""
    return any(part.startswith("_") for part in topic.split("/"))


def absolute(topic: str) -> str:
    """Return a name in the root namespace for one without a leading /."""
    return topic if topic.startswith("/") else f"/{topic}"
