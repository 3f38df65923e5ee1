"""The base class of filters: a list of callbacks."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


class SimpleFilter:
    """A filter that calls its callbacks for each output; `callbacks` maps connection to (function, arguments)."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:
        """Call `cb(*messages, *args)` for each output from now on; return the number of the connection."""
        connection = max(self.callbacks, default=-1) + 1
        self.callbacks[connection] = (cb, args)
        return connection

    def signalMessage(self, *msg: Any) -> None:
        """Call every callback with these messages."""
        for function, arguments in list(self.callbacks.values()):
            function(*msg, *arguments)
