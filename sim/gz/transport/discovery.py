"""Discovery by multicast: finds the publishers or services of other processes, and announces those of this process.

A DiscoveryChannel is one UDP port with heartbeats, announcements, questions ("who has this topic?") and farewells. It
runs in the I/O thread; any thread may send and look up. topic_discovery.py adds what only topics have, peers.py limits
what invented processes can fill.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/include/gz/transport/Discovery.hh
"""

from __future__ import annotations

import contextlib
import errno
import socket
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import datagram, naming
from gz_course.sim.gz.transport.address import is_loopback, is_of_this_machine, is_usable, within_reach
from gz_course.sim.gz.transport.environment import NetworkSettings, complain
from gz_course.sim.gz.transport.options import Scope
from gz_course.sim.gz.transport.peers import Peers

HEARTBEAT_S = 1.0
SILENCE_LIMIT_S = 3.0
COMPLETE_AFTER_S = HEARTBEAT_S + 0.1
"""Time [s] within which every other process has sent a heartbeat, so that the list is complete."""
_RECEIVE_BUFFER_BYTES = 8 << 20
_SO_RCVBUFFORCE = 33  # Linux, for root: beyond net.core.rmem_max
_MOST_AT_ONCE = 1000
_MOST_OF_ONE_TOPIC = 1000
_LONGEST_UUID, _LONGEST_ADDRESS = 100, 300
_RECORD_BYTES = 500
"""Size of an entry of the tables without its names."""
_CHECK_EVERY_S = 0.1

RecordKey = tuple[str, str, str]
"""The process UUID, node UUID and address of a record."""


class DiscoveryChannel:
    """One discovery port of this process."""

    def __init__(
        self,
        process_uuid: str,
        settings: NetworkSettings,
        port: int,
        own: Callable[[str | None], Iterable[Discovery.Publisher]],
        on_advertise: Callable[[Discovery.Publisher, bool], None],
        on_gone: Callable[[list[Discovery.Publisher]], None],
    ) -> None:
        """Open the sockets.

        `own(topic)` returns the publishers or services of this process on a topic (None: all). `on_advertise(record,
        is_new)` and `on_gone(records)` are called in the thread of receive() and tick().
        """
        self.process_uuid = process_uuid
        self._settings = settings
        self._version = datagram.STATISTICS_VERSION if settings.topic_statistics else datagram.WIRE_VERSION
        self._target = (settings.group, port)
        self._own = own
        self._on_advertise = on_advertise
        self._on_gone = on_gone
        self._lock = threading.RLock()
        self._records: dict[str, dict[RecordKey, Discovery.Publisher]] = {}
        self._topics_of: dict[str, set[str]] = {}
        self._addresses: Counter[str] = Counter()
        self._peers = Peers()
        self._started = time.monotonic()
        self._next_heartbeat = self._next_check = self._started
        self._open = True
        self._send_failed = False
        self._socket = self._open_socket()

    def _open_socket(self) -> socket.socket:
        udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            interface = socket.inet_aton(self._settings.ip)
            udp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            udp.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
            udp.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _RECEIVE_BUFFER_BYTES)
            with contextlib.suppress(OSError):
                udp.setsockopt(socket.SOL_SOCKET, _SO_RCVBUFFORCE, _RECEIVE_BUFFER_BYTES)
            udp.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, interface)
            group = socket.inet_aton(self._settings.group)
            udp.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group + interface)
            udp.bind(("0.0.0.0", self._target[1]))
            udp.setblocking(False)
        except OSError as error:
            udp.close()
            raise OSError(error.errno, self._refusal(error)) from error
        return udp

    def _refusal(self, error: OSError) -> str:
        group, port = self._target
        seen = f"gz.transport cannot use multicast group {group}, port {port}, on address {self._settings.ip}"
        if error.errno == errno.EADDRINUSE:
            variable = "GZ_DISCOVERY_MSG_PORT" if port == self._settings.message_port else "GZ_DISCOVERY_SRV_PORT"
            return (
                f"{seen}, because another program keeps the UDP port {port} to itself: end that program "
                f"(`ss -ulpn` shows it), or set {variable} to another port for all processes."
            )
        if error.errno in (errno.ENODEV, errno.EADDRNOTAVAIL) and is_loopback(self._settings.ip):
            return f"{seen}, because the loopback interface is down: `ip link set lo up` starts it."
        return f"{seen} ({error.strerror}): is GZ_IP an address of this machine, and its network up?"

    def fileno(self) -> int:
        """Return the file descriptor that is readable when datagrams are waiting."""
        return self._socket.fileno()

    # Publishers or services of other processes

    def known(self, topic: str) -> list[Discovery.Publisher]:
        """Return the known publishers or services of other processes on a fully qualified topic."""
        with self._lock:
            return list(self._records.get(topic, {}).values())

    def all_known(self) -> list[Discovery.Publisher]:
        """Return all known publishers or services of other processes."""
        with self._lock:
            return [record for group in self._records.values() for record in group.values()]

    def is_known_address(self, address: str) -> bool:
        """Return whether a known publisher or service has this address."""
        with self._lock:
            return self._addresses[address] > 0

    def seconds_until_complete(self) -> float:
        """Return the time [s] until all_known() is complete, 0 if it is."""
        return max(0.0, self._started + COMPLETE_AFTER_S - time.monotonic())

    # Sending

    def advertise(self, record: Discovery.Publisher) -> None:
        """Announce a publisher or service of this process."""
        self.send(Discovery.ADVERTISE, record)

    def unadvertise(self, record: Discovery.Publisher) -> None:
        """Announce that a publisher or service of this process has ended."""
        self.send(Discovery.UNADVERTISE, record)

    def ask(self, topic: str) -> None:
        """Ask for the publishers or services of a topic, which are then advertised again."""
        message = self._message(Discovery.SUBSCRIBE)
        message.sub.topic = topic
        self._send(message)

    def send(self, kind: int, record: Discovery.Publisher) -> None:
        """Send a message of the given Discovery.Type about a record."""
        message = self._message(kind)
        message.pub.CopyFrom(record)
        self._send(message)

    def _message(self, kind: int) -> Discovery:
        return Discovery(version=self._version, process_uuid=self.process_uuid, type=kind)

    def _send_about_process(self, kind: int) -> None:
        self.send(kind, Discovery.Publisher(process_uuid=self.process_uuid, scope=Discovery.Publisher.ALL))

    def _send(self, message: Discovery) -> None:
        if not self._open:
            return
        try:
            self._socket.sendto(datagram.encode(message), self._target)
            self._send_failed = False
        except (BlockingIOError, InterruptedError):
            pass  # a full buffer: datagrams may be lost anyway, and the next heartbeat repeats the information
        except (OSError, ValueError) as error:
            if self._open and not self._send_failed:
                self._send_failed = True
                complain(f"Other processes cannot be told about this one: {error}.")

    # Receiving and timers (I/O thread only)

    def receive(self) -> None:
        """Handle the waiting datagrams, up to a limit, so that a flood of them does not delay data."""
        for _ in range(_MOST_AT_ONCE):
            try:
                data, source = self._socket.recvfrom(datagram.MAX_DATAGRAM_BYTES)
            except (BlockingIOError, InterruptedError):
                return
            except OSError:  # closed by another thread, or a late error of an earlier send
                return
            message = datagram.decode(data, self._version)
            if message is None or message.process_uuid == self.process_uuid or message.flags.relay:
                continue
            if not within_reach(source[0], self._settings.ip):
                continue
            if len(message.process_uuid) > _LONGEST_UUID:
                continue
            self.hear(message.process_uuid)
            self.handle(message, source[0])

    def hear(self, process_uuid: str) -> None:
        """Record that a process was heard, which may mean to forget another."""
        if (forgotten := self._peers.hear(process_uuid, time.monotonic())) is not None:
            self._forget_process(forgotten)

    def handle(self, message: Discovery, source_ip: str) -> None:
        """Process one message of another process."""
        kind = message.type
        if kind == Discovery.SUBSCRIBE:
            for record in self._own(message.sub.topic):
                self.advertise(record)
        elif kind == Discovery.BYE:
            self._forget_process(message.process_uuid)
        elif kind != Discovery.HEARTBEAT and self._acceptable(message, source_ip):
            if kind == Discovery.ADVERTISE:
                self._remember(message.pub)
            elif kind == Discovery.UNADVERTISE:
                self._forget_record(message.pub)
            else:
                self.handle_other(message)

    def handle_other(self, message: Discovery) -> None:
        """Process a message of a type that a subclass knows; this class ignores it."""

    def _acceptable(self, message: Discovery, source_ip: str) -> bool:
        record = message.pub
        if record.scope == Scope.PROCESS or record.process_uuid != message.process_uuid:
            return False
        if record.scope == Scope.HOST and not is_of_this_machine(source_ip):
            return False
        if len(record.node_uuid) > _LONGEST_UUID or len(record.address) > _LONGEST_ADDRESS:
            return False
        if message.type == Discovery.ADVERTISE and not is_usable(record.address, self._settings.ip):
            return False
        try:
            naming.split(record.topic)
        except ValueError:
            return False
        return True

    def _remember(self, record: Discovery.Publisher) -> None:
        key = (record.process_uuid, record.node_uuid, record.address)
        before = self._records.get(record.topic, {}).get(key)
        if before is None and not self._peers.has_room(record.process_uuid, _size(record)):
            return
        gone: list[Discovery.Publisher] = []
        with self._lock:
            group = self._records.setdefault(record.topic, {})
            if before is not None:
                self._remove(group, key)
            elif len(group) >= _MOST_OF_ONE_TOPIC:
                gone.append(self._remove(group, next(iter(group))))
            group[key] = record
            self._addresses[record.address] += 1
            self._topics_of.setdefault(record.process_uuid, set()).add(record.topic)
            self._peers.charge(record.process_uuid, _size(record))
        if gone:
            self._on_gone(gone)
        while (forgotten := self._peers.too_much(keep=record.process_uuid)) is not None:
            self._forget_process(forgotten)
        self._on_advertise(record, before is None)

    def _remove(self, group: dict[RecordKey, Discovery.Publisher], key: RecordKey) -> Discovery.Publisher:
        record = group.pop(key)
        self._addresses[record.address] -= 1
        if self._addresses[record.address] <= 0:
            del self._addresses[record.address]
        self._peers.charge(record.process_uuid, -_size(record))
        return record

    def _forget_record(self, record: Discovery.Publisher) -> None:
        self._forget(record.process_uuid, [record.topic], record.node_uuid)

    def _forget_process(self, process_uuid: str) -> None:
        self.forget_subscribers_of(process_uuid)
        self._forget(process_uuid, list(self._topics_of.get(process_uuid, ())))
        self._topics_of.pop(process_uuid, None)
        self._peers.forget(process_uuid)

    def forget_subscribers_of(self, process_uuid: str) -> None:
        """Forget the subscribers of a process that has ended; this class keeps none."""

    def _forget(self, process_uuid: str, topics: list[str], node_uuid: str | None = None) -> None:
        gone: list[Discovery.Publisher] = []
        with self._lock:
            for topic in topics:
                group = self._records.get(topic, {})
                for key in [key for key in group if key[0] == process_uuid and node_uuid in (None, key[1])]:
                    gone.append(self._remove(group, key))
                if not group:
                    self._records.pop(topic, None)
                if not any(key[0] == process_uuid for key in group):
                    self._topics_of.get(process_uuid, set()).discard(topic)
        if gone:
            self._on_gone(gone)

    def tick(self) -> float:
        """Send the heartbeat if due and drop silent processes; return the time [s] until the next call."""
        now = time.monotonic()
        if now >= self._next_heartbeat:
            self._next_heartbeat = now + HEARTBEAT_S
            self._send_about_process(Discovery.HEARTBEAT)
            for record in self._own(None):
                self.advertise(record)
        if now >= self._next_check:
            for process_uuid in self._peers.silent(now - SILENCE_LIMIT_S):
                self._forget_process(process_uuid)
            oldest = self._peers.oldest_message()
            due = now + HEARTBEAT_S if oldest is None else min(now + HEARTBEAT_S, oldest + SILENCE_LIMIT_S)
            self._next_check = max(due, now + _CHECK_EVERY_S)
        return max(0.001, min(self._next_heartbeat, self._next_check) - now + 0.001)

    # Closing

    def say_farewell(self) -> None:
        """Unadvertise everything and send BYE, so that others need not wait for the silence limit."""
        for record in self._own(None):
            self.unadvertise(record)
        self._send_about_process(Discovery.BYE)

    def close(self) -> None:
        """Close the socket without a message to others; see say_farewell()."""
        self._open = False
        with contextlib.suppress(OSError):
            self._socket.close()


def _size(record: Discovery.Publisher) -> int:
    return record.ByteSize() + _RECORD_BYTES
