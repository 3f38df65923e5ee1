"""A subscription: selects messages by type and options and calls its callback.

Messages of the same process come from the thread of `local_delivery` (synchronous ones from the publisher's thread,
before publish() returns), those of other processes from the dispatcher thread. The callback always gets its own copy.
"""

from __future__ import annotations

import dataclasses
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from google.protobuf.message import DecodeError, Message

from gz_course.sim.gz.msgs.fortress import converted, same_type
from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.message_info import MessageInfo
from gz_course.sim.gz.transport.options import Scope, SubscribeOptions
from gz_course.sim.gz.transport.throttle import Throttle

GENERIC_TYPE = "google.protobuf.Message"
"""The type name of a raw subscription to messages of any type."""


class Subscription:
    """A callback with its topic, type and options."""

    def __init__(
        self,
        name: str,
        type_name: str,
        node_uuid: str,
        scope: Scope,
        options: SubscribeOptions,
        callback: Callable[..., Any],
        message_type: type[Message] | None = None,
        synchronous: bool = False,
    ) -> None:
        """`name` is fully qualified; without `message_type` the callback gets (bytes, MessageInfo)."""
        self.name = name
        self.type_name = type_name
        self.node_uuid = node_uuid
        self.scope = scope
        self.active = True
        self.synchronous = synchronous
        self._ignore_own_node = options.ignore_local_messages
        self._throttled = options.throttled
        self._throttle = Throttle(options.msgs_per_sec)
        self._callback = callback
        self._message_type = message_type

    def accepts(self, type_name: str) -> bool:
        """Return whether this subscription accepts messages of this type."""
        return self.type_name in (type_name, GENERIC_TYPE) or same_type(self.type_name, type_name)

    def deliver(self, data: bytes, info: MessageInfo, from_node: str | None = None) -> None:
        """Call the callback with a new copy, unless type, options or invalid bytes prevent it.

        An exception of the callback prints one line on stderr. `from_node` is the publishing node if it is in this
        process.
        """
        if not self.active or (info.type != self.type_name and not self.accepts(info.type)):
            return
        if self._ignore_own_node and from_node == self.node_uuid:
            return
        arguments: tuple[Any, ...]
        try:
            if self.type_name not in (info.type, GENERIC_TYPE):
                data = converted(data, info.type, self.type_name)
                info = dataclasses.replace(info, type=self.type_name)
            arguments = (bytes(data), info) if self._message_type is None else (self._message_type.FromString(data),)
        except DecodeError:
            return
        if self._throttled and not self._throttle.passes():
            return
        try:
            self._callback(*arguments)
        except Exception as error:
            complain(f"The callback of topic [{info.topic}] {one_line(error)}")


def one_line(error: Exception) -> str:
    """Return the exception of a callback with its place in the user's file: `raised KeyError: 'x' (robot.py:12)`."""
    frames = traceback.extract_tb(sys.exc_info()[2])
    own = Path(__file__).parent
    places = [frame for frame in frames if Path(frame.filename).parent != own] or list(frames)
    place = f"{places[-1].filename}:{places[-1].lineno}"
    text = " ".join(str(error).split())
    return f"raised {type(error).__name__}{': ' if text else ''}{text} ({place})"
