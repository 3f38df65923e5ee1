"""The connection of this process to other processes.

It is created when a node whose scope is not PROCESS first needs it. One I/O thread runs discovery and manages the
receiving socket; publishers send through the outlet from their own threads. A forked child creates its own network when
it needs one, with all its nodes; at exit the other processes are notified.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc
"""

from __future__ import annotations

import contextlib
import math
import socket
import threading
import time
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

import zmq

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.advertisement import Advertisement
from gz_course.sim.gz.transport.discovery import HEARTBEAT_S
from gz_course.sim.gz.transport.dispatcher import Dispatcher
from gz_course.sim.gz.transport.environment import NetworkSettings, complain
from gz_course.sim.gz.transport.inlet import Inlet
from gz_course.sim.gz.transport.message_info import MessagePublisher
from gz_course.sim.gz.transport.options import UNTHROTTLED, Scope
from gz_course.sim.gz.transport.outlet import Outlet
from gz_course.sim.gz.transport.subscription import Subscription
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.topic_discovery import TopicDiscovery
from gz_course.sim.gz.transport.topic_statistics import StatisticsTable

if TYPE_CHECKING:
    from gz_course.sim.gz.transport.service_network import ServiceNetwork

_STOP_WITHIN_S = 1.0
_LINGER_MS = 200


class Network:
    """The sockets and threads of one process."""

    def __init__(self, settings: NetworkSettings) -> None:
        """Open the sockets and start the threads. Raises OSError if no network can be used."""
        self.process_uuid = str(uuid.uuid4())
        self.statistics = StatisticsTable()
        self._open = True
        self._settings = settings
        self._services: ServiceNetwork | None = None
        self._services_lock = threading.Lock()
        self._commands: deque[Callable[[], None]] = deque()
        self._notified: dict[tuple[str, str, str], dict[str, float]] = {}
        self._context: zmq.Context[zmq.Socket[bytes]] = zmq.Context()
        try:
            self._outlet = Outlet(
                self._context,
                settings.ip,
                settings.send_high_water_mark,
                SWITCHBOARD.notify,
                settings.topic_statistics,
            )
        except zmq.ZMQError as error:
            self._context.destroy(linger=0)
            raise OSError(error.errno, f"address {settings.ip} cannot be bound ({error})") from error
        self.address = self._outlet.address
        try:
            self._discovery = TopicDiscovery(
                self.process_uuid,
                settings,
                own=self._own_publishers,
                own_subscriptions=_networked_subscriptions,
                own_address=self.address,
                on_advertise=self._on_advertise,
                on_gone=self._on_gone,
                on_subscribers=SWITCHBOARD.notify,
            )
        except OSError:
            self._context.destroy(linger=0)
            raise
        self._inlet = Inlet(self._context, settings.receive_high_water_mark)
        self._dispatcher = Dispatcher(SWITCHBOARD, self._inlet, self.statistics)
        self._wake_sender, self._wake_receiver = socket.socketpair()
        self._wake_sender.setblocking(False)
        self._wake_receiver.setblocking(False)
        self._thread = threading.Thread(target=self._run, name="gz-transport-io", daemon=True)
        for publisher in SWITCHBOARD.all_publishers():
            if publisher.scope != Scope.PROCESS:
                self.advertise(publisher)
        for subscription in _networked_subscriptions():
            self.subscribe(subscription)
        offered = [each for each in SWITCHBOARD.all_services() if each.scope != Scope.PROCESS]
        self._dispatcher.start()
        self._thread.start()
        for service in offered:
            self.services().advertise(service)

    # Methods for any thread

    def send(self, name: bytes, data: bytes, type_name: bytes) -> None:
        """Send a message to the processes that subscribe to the fully qualified topic."""
        self._outlet.send(name, data, type_name)

    def advertise(self, publisher: Advertisement) -> None:
        self._discovery.advertise(self._record(publisher))

    def unadvertise(self, publisher: Advertisement) -> None:
        self._discovery.unadvertise(self._record(publisher))

    def subscribe(self, subscription: Subscription) -> None:
        """Connect a subscription to present and future publishers of its topic."""
        self.do(lambda: self._connect_known(subscription))

    def unsubscribe(self, subscription: Subscription) -> None:
        """Notify publishers that a subscription, already removed from the switchboard, has ended."""
        self.do(lambda: self._disconnect(subscription))

    def listening_processes(self, name: str, type_name: str) -> int:
        """Return how many other processes would receive a message of this topic and type now."""
        announced = self._discovery.subscriber_processes(name, type_name)
        return min(announced, self._outlet.listeners(name.encode())) if announced else 0

    def is_certain(self, name: str) -> bool:
        """Return whether `listening_processes` gives the same until the switchboard is notified."""
        return not self._outlet.is_leaving(name.encode())

    @contextlib.contextmanager
    def sending_together(self) -> Iterator[None]:
        """Keep what is sent until the end of the context; then send all in order, which costs much less."""
        self._outlet.hold()
        try:
            yield
        finally:
            self._outlet.let_go()

    def services(self) -> ServiceNetwork:
        """Return the network of services, opened by the first call. Raises OSError if that fails."""
        with self._services_lock:
            if self._services is None:
                from gz_course.sim.gz.transport.service_network import ServiceNetwork  # many processes never need it

                self._services = ServiceNetwork(self._context, self._settings, self.process_uuid, self._wake)
                self._wake()
            return self._services

    def known_publishers(self, name: str) -> list[MessagePublisher]:
        """Return the presently known publishers of other processes on a fully qualified topic."""
        return [info for _, info in _listed(list(self._discovery.known(name)))]

    def known_elsewhere(
        self,
    ) -> tuple[list[tuple[str, MessagePublisher]], list[tuple[str, MessagePublisher]]]:
        """Return (publishers, subscribers) of all other processes and partitions, with fully qualified names.

        Waits until the others had time to answer: about 1 [s] at the first call of a process.
        """
        if not self._open:
            return [], []
        self._discovery.ask_for_subscribers()
        self._discovery.wait_for_answers()
        return _listed(self._discovery.all_known()), _listed(self._discovery.subscribers())

    def do(self, command: Callable[[], None]) -> None:
        """Call a function in the I/O thread, soon; takes no lock, so a finalizer may call it."""
        if self._open:
            self._commands.append(command)
            self._wake()

    def close(self) -> None:
        """Notify the other processes, stop the threads and close the sockets."""
        if not self._open:
            return
        self._discovery.say_farewell()
        if self._services:
            self._services.discovery.say_farewell()
            self._services.stop_threads()
        self._open = False
        self._wake()
        if self._thread is not threading.current_thread():
            self._thread.join(_STOP_WITHIN_S)
        ended = self._dispatcher.stop(_STOP_WITHIN_S)
        self._discovery.close()
        self._outlet.close()
        if ended and not self._thread.is_alive():
            self._dispatcher.close()
            self._inlet.close()
            if self._services:
                self._services.close()
            self._context.destroy(linger=_LINGER_MS)
        self._wake_sender.close()
        self._wake_receiver.close()

    def abandon_after_fork(self) -> None:
        """Close the copies of the parent's resources in a forked child, without notifying anybody."""
        self._open = False
        self._discovery.close()
        if self._services:
            self._services.discovery.close()
        self._wake_sender.close()
        self._wake_receiver.close()

    def _wake(self) -> None:
        with contextlib.suppress(OSError):  # full: it will wake up anyway; closed: it has stopped
            self._wake_sender.send(b"!")

    # I/O thread

    def _run(self) -> None:
        poller = zmq.Poller()
        for source in (self._discovery.fileno(), self._outlet.fileno(), self._wake_receiver.fileno()):
            poller.register(source, zmq.POLLIN)
        while self._open:
            try:
                self._one_round(poller)
            except Exception as error:  # no received data may end this thread
                if self._open:
                    complain(f"Something was received that could not be used ({type(error).__name__}: {error}).")

    def _one_round(self, poller: zmq.Poller) -> None:
        wait_s = self._discovery.tick()
        self._inlet.leave_due()
        services = self._services
        if services:
            wait_s = min(wait_s, services.tick())
            for source, events in services.sources():
                poller.register(source, events)
        ready = dict(poller.poll(math.ceil(wait_s * 1000)))
        if self._wake_receiver.fileno() in ready:
            self._wake_receiver.recv(4096)
        while self._commands:
            self._commands.popleft()()
        if self._discovery.fileno() in ready:
            self._discovery.receive()
        self._outlet.take_notices()  # always, because the edge-triggered descriptor signals a change only once
        if services:
            services.take(ready)
        if self._inlet.was_used():
            self._dispatcher.wake()

    def _connect_known(self, subscription: Subscription) -> None:
        if not subscription.active:
            return
        for record in self._discovery.known(subscription.name):
            if subscription.accepts(record.msg_pub.msg_type) and self._inlet.listen(record.topic, record.address):
                self._notify(record, subscription.node_uuid)
        self._discovery.ask(subscription.name)

    def _disconnect(self, subscription: Subscription) -> None:
        left = SWITCHBOARD.networked_subscriptions(subscription.name)
        if not left:
            self._inlet.ignore(subscription.name)
        if not any(each.node_uuid == subscription.node_uuid for each in left):
            self._discovery.send_end_connection(subscription.name, subscription.node_uuid)
            for key, nodes in self._notified.items():
                if key[0] == subscription.name:
                    nodes.pop(subscription.node_uuid, None)

    def _on_advertise(self, record: Discovery.Publisher, is_new: bool) -> None:
        kind = record.msg_pub.msg_type
        nodes = {each.node_uuid for each in SWITCHBOARD.networked_subscriptions(record.topic) if each.accepts(kind)}
        if nodes and self._inlet.listen(record.topic, record.address):
            for node in sorted(nodes):
                self._notify(record, node, again=is_new)

    def _notify(self, record: Discovery.Publisher, node_uuid: str, again: bool = True) -> None:
        """Notify a publisher of a subscriber; repeated every second, because datagrams can be lost."""
        nodes = self._notified.setdefault((record.topic, record.process_uuid, record.node_uuid), {})
        now = time.monotonic()
        if again or now - nodes.get(node_uuid, 0.0) > 0.9 * HEARTBEAT_S:
            nodes[node_uuid] = now
            self._discovery.send_new_connection(record, node_uuid)

    def _on_gone(self, records: list[Discovery.Publisher]) -> None:
        for record in records:
            self._notified.pop((record.topic, record.process_uuid, record.node_uuid), None)
        for address in {record.address for record in records}:
            if not self._discovery.is_known_address(address):
                self._inlet.leave_soon(address)

    # Publishers and subscriptions of this process

    def _own_publishers(self, topic: str | None) -> Iterable[Discovery.Publisher]:
        if topic is not None:
            return [self._record(each) for each in SWITCHBOARD.networked_publishers(topic)]
        return [self._record(each) for each in SWITCHBOARD.all_publishers() if each.scope != Scope.PROCESS]

    def _record(self, publisher: Advertisement) -> Discovery.Publisher:
        record = Discovery.Publisher(
            topic=publisher.name,
            address=self.address,
            process_uuid=self.process_uuid,
            node_uuid=publisher.node_uuid,
            scope=int(publisher.scope),
        )
        record.msg_pub.ctrl = "unused"
        record.msg_pub.msg_type = publisher.type_name
        record.msg_pub.throttled = publisher.throttled
        record.msg_pub.msgs_per_sec = publisher.msgs_per_sec
        return record


def _networked_subscriptions() -> list[Subscription]:
    return [each for each in SWITCHBOARD.all_subscriptions() if each.scope != Scope.PROCESS]


def _listed(records: list[Discovery.Publisher]) -> list[tuple[str, MessagePublisher]]:
    found: list[tuple[str, MessagePublisher]] = []
    for record in records:
        topic = naming.split(record.topic)[1]
        info = MessagePublisher(
            topic,
            record.address,
            record.msg_pub.msg_type,
            record.process_uuid,
            record.node_uuid,
            Scope(record.scope) if record.scope in (1, 2) else Scope.ALL,
            record.msg_pub.msgs_per_sec or UNTHROTTLED,
            record.msg_pub.ctrl,
        )
        found.append((record.topic, info))
    return found
