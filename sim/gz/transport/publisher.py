"""A publisher sends messages on one topic.

publish() serializes a message once, passes the bytes to the network if another process subscribes, and queues them for
the subscriptions of this process (`local_delivery`). Synchronous subscriptions are called in the caller's thread before
it returns.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING

from google.protobuf.message import Message

from gz_course.sim.gz.msgs.fortress import converted, same_type
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.advertisement import Advertisement
from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.local_delivery import LOCAL_DELIVERY
from gz_course.sim.gz.transport.message_info import MessageInfo
from gz_course.sim.gz.transport.options import UNTHROTTLED, Scope
from gz_course.sim.gz.transport.reach import present_network_for
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.throttle import Throttle

if TYPE_CHECKING:
    from gz_course.sim.gz.transport.network import Network


class Publisher:
    """The result of Node.advertise(). It ends with close(), or when neither its node nor the program refers to it."""

    def __init__(self, advertisement: Advertisement | None = None) -> None:
        """Use Node.advertise() instead of calling this; without an advertisement the publisher is not valid."""
        self._advertisement = advertisement
        self._open = advertisement is not None
        self._joined: Callable[[], Network] | None = None  # None: other processes are not reached
        self._message_class: type[Message] | None = None  # class of the first message, to check further ones faster
        self._count, self._count_version = 0, object()  # the last count of subscribers, and when it was made
        if advertisement is None:
            self.name, self.type_name, self.node_uuid, self.topic = "", "", "", ""
            self._throttle = Throttle(UNTHROTTLED)
            return
        self._finalizer = weakref.finalize(self, _forget, advertisement)
        self._finalizer.atexit = False  # the network says farewell at exit
        if advertisement.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import process_network

            self._joined = process_network.joined
        self.name = advertisement.name
        self.type_name = advertisement.type_name
        self.node_uuid = advertisement.node_uuid
        self.throttled = advertisement.throttled
        self._name_on_wire, self._type_on_wire = self.name.encode(), self.type_name.encode()
        self._partition, self.topic = naming.split(self.name)
        self._throttle = Throttle(advertisement.msgs_per_sec)

    def valid(self) -> bool:
        """Return whether it can publish: True until close(), False if the topic could not be advertised."""
        return self._open

    def publish(self, proto_msg: Message) -> bool:
        """Send a message. Callbacks are called in other threads, except those of synchronous nodes of this process.

        Return True also without subscribers and if the rate limit dropped the message; False if the message has another
        type than advertised, with a line on stderr, or if the publisher is closed.
        """
        if type(proto_msg) is self._message_class:
            return self._send(proto_msg.SerializeToString())
        if not isinstance(proto_msg, Message):
            raise TypeError(
                f"publish() on topic [{self.topic}] was given a {type(proto_msg).__name__}, "
                f"but a {self.type_name} message was expected."
            )
        if proto_msg.DESCRIPTOR.full_name == self.type_name:
            self._message_class = type(proto_msg)
        return self.publish_raw(proto_msg.SerializeToString(), proto_msg.DESCRIPTOR.full_name)

    def publish_raw(self, msg_data: bytes, msg_type: str) -> bool:
        """Send a message that is already serialized; otherwise like publish()."""
        if not self._open:
            return False
        if msg_type != self.type_name:
            if same_type(msg_type, self.type_name):  # one of them is the Fortress name
                return self.publish_raw(converted(msg_data, msg_type, self.type_name), self.type_name)
            complain(
                f"The topic [{self.topic}] was advertised with type {self.type_name}, "
                f"so a message of type {msg_type} was not published on it."
            )
            return False
        return self._send(msg_data)

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
            queued = [each for each in group if not each.synchronous]
            if queued:
                LOCAL_DELIVERY.deliver(queued, data, info, self.node_uuid)
            for subscription in group:
                if subscription.synchronous:
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
        if not self._open or self._advertisement is None:
            return
        self._open = self._advertisement.open = False
        self._finalizer.detach()
        SWITCHBOARD.remove_publisher(self._advertisement)
        if self._joined is not None:
            self._joined().unadvertise(self._advertisement)

    def _connections(self) -> int:
        if not self._open:
            return 0
        version = SWITCHBOARD.version  # taken first, because it may change during the count
        if self._count_version is version:
            return self._count
        here = sum(each.active and each.accepts(self.type_name) for each in SWITCHBOARD.subscriptions(self.name))
        certain = True
        if self._joined is not None:
            network = self._joined()
            here += network.listening_processes(self.name, self.type_name)
            certain = network.is_certain(self.name)
        if certain:
            self._count, self._count_version = here, version
        return here

    def __repr__(self) -> str:
        state = "" if self._open else ", closed"
        return f"<Publisher {self.topic} [{self.type_name}]{state}>"


def _forget(advertisement: Advertisement) -> None:
    """End a publisher to which nobody refers any more; runs at any moment, so the tables are changed elsewhere."""
    advertisement.open = False
    LOCAL_DELIVERY.end_later(lambda: _withdraw(advertisement))


def _withdraw(advertisement: Advertisement) -> None:
    SWITCHBOARD.remove_publisher(advertisement)
    if network := present_network_for(advertisement.scope):
        network.unadvertise(advertisement)
