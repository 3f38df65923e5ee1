"""A publisher sends messages on one topic.

publish() serializes a message once, passes the bytes to the network if another process subscribes, and calls every
subscription of this process in the caller's thread before it returns.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from google.protobuf.message import Message

from gz_course.sim.gz.msgs.fortress import converted, same_type
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.message_info import MessageInfo
from gz_course.sim.gz.transport.options import AdvertiseMessageOptions, Scope
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.throttle import Throttle

if TYPE_CHECKING:
    from gz_course.sim.gz.transport.network import Network


class Publisher:
    """The result of Node.advertise(), closed by close() or with its node."""

    def __init__(
        self,
        name: str,
        type_name: str,
        node_uuid: str,
        scope: Scope,
        options: AdvertiseMessageOptions,
    ) -> None:
        """`name` is fully qualified. Use Node.advertise() instead of calling this."""
        self._joined: Callable[[], Network] | None = None  # None: other processes are not reached
        if scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            self._joined = network.joined
        self.name = name
        self.type_name = type_name
        self.node_uuid = node_uuid
        self.scope = scope
        self.msgs_per_sec = options.msgs_per_sec
        self.throttled = options.throttled
        self._name_on_wire, self._type_on_wire = name.encode(), type_name.encode()
        self._message_class: type[Message] | None = None  # class of the first message, to check further ones faster
        self._partition, self.topic = naming.split(name)
        self._throttle = Throttle(options.msgs_per_sec)
        self._open = True

    def valid(self) -> bool:
        """Return whether it can publish: True until close()."""
        return self._open

    def publish(self, message: Message) -> bool:
        """Send a message; callbacks of the same process have returned when this returns.

        Return True also without subscribers and if the rate limit dropped the message; False if the message has another
        type than advertised, with a line on stderr, or if the publisher is closed.
        """
        if type(message) is self._message_class:
            return self._send(message.SerializeToString())
        if not isinstance(message, Message):
            raise TypeError(
                f"publish() on topic [{self.topic}] was given a {type(message).__name__}, "
                f"but a {self.type_name} message was expected."
            )
        if message.DESCRIPTOR.full_name == self.type_name:
            self._message_class = type(message)
        return self.publish_raw(message.SerializeToString(), message.DESCRIPTOR.full_name)

    def publish_raw(self, data: bytes, type_name: str) -> bool:
        """Send a message that is already serialized; otherwise like publish()."""
        if not self._open:
            return False
        if type_name != self.type_name:
            if same_type(type_name, self.type_name):  # one of them is the Fortress name
                return self.publish_raw(converted(data, type_name, self.type_name), self.type_name)
            complain(
                f"The topic [{self.topic}] was advertised with type {self.type_name}, "
                f"so a message of type {type_name} was not published on it."
            )
            return False
        return self._send(data)

    def _send(self, data: bytes) -> bool:
        if not self._open:
            return False
        if self.throttled and not self._throttle.passes():
            return True
        if self._joined is not None:
            self._joined().send(self._name_on_wire, data, self._type_on_wire)
        group = SWITCHBOARD.subscriptions(self.name)
        if group:
            info = MessageInfo(self.topic, self.type_name, self._partition, True)
            for subscription in group:
                subscription.deliver(data, info, self.node_uuid)
        return True

    def has_connections(self) -> bool:
        """Return whether this or another process has a subscription of a matching type."""
        return self._connections() > 0

    def wait_for_subscribers(self, count: int = 1, timeout: float = 5.0) -> bool:
        """Wait until `count` subscribers would receive the next message; return False after `timeout` [s].

        Each subscription of this process counts as one, each other process as one. After True the next message is not
        lost. Not in the official binding.
        """
        self._connections()  # A forked child joins the network here, because it must not do so inside the wait below.
        return SWITCHBOARD.wait_for(lambda: self._connections() >= count, timeout)

    def throttled_update_ready(self) -> bool:
        """Return whether a message published now would pass the rate limit."""
        return self._throttle.ready()

    def close(self) -> None:
        """Stop publishing and notify the other processes; closing twice does nothing."""
        if not self._open:
            return
        self._open = False
        SWITCHBOARD.remove_publisher(self)
        if self._joined is not None:
            self._joined().unadvertise(self)

    def _connections(self) -> int:
        if not self._open:
            return 0
        here = sum(each.accepts(self.type_name) for each in SWITCHBOARD.subscriptions(self.name))
        if self._joined is None:
            return here
        return here + self._joined().listening_processes(self.name, self.type_name)

    def __repr__(self) -> str:
        state = "" if self._open else ", closed"
        return f"<Publisher {self.topic} [{self.type_name}]{state}>"
