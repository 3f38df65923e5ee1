"""The filter that consists of other filters, one after another."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.message_filters.simple_filter import SimpleFilter


class Chain(SimpleFilter):
    """Filters that each take the output of the one before; the chain passes on the output of the last.

    A filter of the chain has a method `add(message)`. A chain without filters passes on its input.
    """

    def __init__(self, message_filter: SimpleFilter | None = None) -> None:
        super().__init__()
        self.incoming_connection: int | None = None
        self._filters: list[Any] = []
        self._last_connection = 0
        if message_filter is not None:
            self.connectInput(message_filter)

    def connectInput(self, message_filter: SimpleFilter) -> None:
        """Take the messages of a filter. Raises RuntimeError if there is an input already."""
        if self.incoming_connection is not None:
            raise RuntimeError("Already connected")
        self.incoming_connection = message_filter.registerCallback(self.add)

    def add(self, message: Any) -> None:
        """Give a message to the first filter."""
        if self._filters:
            self._filters[0].add(message)
        else:
            self.signalMessage(message)

    def addFilter(self, message_filter: Any) -> None:
        """Append a filter."""
        if self._filters:
            last = self._filters[-1]
            del last.callbacks[self._last_connection]
            last.registerCallback(message_filter.add)
        self._filters.append(message_filter)
        self._last_connection = message_filter.registerCallback(self.signalMessage)

    def getFilter(self, index: int) -> Any:
        """Return the filter at a place, counted from 0. Raises KeyError if there is none."""
        if not 0 <= index < len(self._filters):
            raise KeyError(index)
        return self._filters[index]
