"""Services between processes: finds providers, and exchanges requests and responses with other processes.

It is opened when the first service is advertised, called or listed, and shares the I/O thread of the network; requests
are sent from the caller's thread, which then waits for the response. Messages follow gz-transport's service protocol,
version 10.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc (SendPendingRemoteReqs)
"""

from __future__ import annotations

import functools
import threading
import time
import uuid
from collections.abc import Callable, Iterable, Iterator

import zmq

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.address import is_usable
from gz_course.sim.gz.transport.courier import RETRY_S, Courier, Letter, Target
from gz_course.sim.gz.transport.discovery import DiscoveryChannel
from gz_course.sim.gz.transport.environment import NetworkSettings
from gz_course.sim.gz.transport.message_info import ServicePublisher
from gz_course.sim.gz.transport.options import Scope
from gz_course.sim.gz.transport.service import FAILED, TIMED_OUT, CallResult, Service, is_one_way, same_types
from gz_course.sim.gz.transport.service_threads import ServiceThreads, while_waiting
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD

RESPONSE_DEADLINE_S = 5.0
"""Time [s] after which a response is dropped if its requester cannot be reached."""
_MOST_AT_ONCE = 100
_REQUEST_FRAMES, _RESPONSE_FRAMES = 9, 6
_LARGEST_FRAME = 1 << 30


class _Pending:
    """A request that waits for its response or, if one-way, for being sent."""

    def __init__(self, name: str, node_uuid: str) -> None:
        self.key = str(uuid.uuid4()).encode()
        self.name = name.encode()
        self.node_uuid = node_uuid.encode()
        self.outcome = TIMED_OUT
        self.done = threading.Event()

    def finish(self, outcome: CallResult) -> None:
        self.outcome = outcome
        self.done.set()


class ServiceNetwork:
    """Discovery and sockets for the services of one process."""

    def __init__(
        self,
        context: zmq.Context[zmq.Socket[bytes]],
        settings: NetworkSettings,
        process_uuid: str,
        wake: Callable[[], None],
    ) -> None:
        """Open the sockets. Raises OSError if no network can be used."""
        self._process_uuid = process_uuid
        self._ip = settings.ip
        self._pending: dict[bytes, _Pending] = {}
        self._replier_id, self._receiver_id = str(uuid.uuid4()), str(uuid.uuid4())
        self.discovery = DiscoveryChannel(
            process_uuid,
            settings,
            settings.service_port,
            own=self._own_services,
            on_advertise=lambda record, is_new: None,
            on_gone=self._on_gone,
        )
        self.replier, self.address = _receiving_socket(context, settings.ip, self._replier_id)
        self.receiver, self._receiver_address = _receiving_socket(context, settings.ip, self._receiver_id)
        self._courier = Courier(context, wake)
        self._threads = ServiceThreads(wake)

    # Methods for any thread

    def advertise(self, service: Service) -> None:
        self.discovery.advertise(self._record(service))

    def unadvertise(self, service: Service) -> None:
        self.discovery.unadvertise(self._record(service))

    def request(
        self, name: str, node_uuid: str, data: bytes, request_type: str, response_type: str, timeout_s: float
    ) -> CallResult:
        """Call a service of another process; wait at most `timeout_s` [s] for the response."""
        pending = _Pending(name, node_uuid)
        one_way = is_one_way(response_type)
        deadline = time.monotonic() + timeout_s
        sent = (lambda: pending.finish(CallResult(True, True, b""))) if one_way else (lambda: None)
        letter = Letter(lambda: self._targets(pending, data, request_type, response_type), deadline, sent)
        if not one_way:
            self._pending[pending.key] = pending
        try:
            self._courier.send(letter)
            if not pending.done.is_set():
                if not self.providers(name, request_type, response_type):
                    self.discovery.ask(name)
                with while_waiting():
                    pending.done.wait(max(0.0, deadline - time.monotonic()))
        finally:
            self._pending.pop(pending.key, None)
            self._courier.withdraw(letter)
        return pending.outcome

    def providers(self, name: str, request_type: str, response_type: str) -> list[Discovery.Publisher]:
        """Return the providers of a service in other processes whose types match."""
        return [
            record
            for record in self.discovery.known(name)
            if record.HasField("srv_pub")
            and same_types(record.srv_pub.request_type, record.srv_pub.response_type, request_type, response_type)
        ]

    def _targets(self, pending: _Pending, data: bytes, request_type: str, response_type: str) -> Iterator[Target]:
        for record in self.providers(pending.name.decode(), request_type, response_type):
            # types in the provider's spelling, because Gazebo compares them literally
            frames = (
                pending.name,
                self._receiver_address.encode(),
                self._receiver_id.encode(),
                pending.node_uuid,
                pending.key,
                data,
                record.srv_pub.request_type.encode(),
                record.srv_pub.response_type.encode(),
            )
            yield record.address, record.srv_pub.socket_id.encode(), frames

    def known_elsewhere(self) -> list[tuple[str, ServicePublisher]]:
        """Return the services of all other processes and partitions, with fully qualified names.

        Waits until the others had time to announce them: about 1 [s] at the first call of a process.
        """
        time.sleep(self.discovery.seconds_until_complete())
        return [(record.topic, _listed(record)) for record in self.discovery.all_known() if record.HasField("srv_pub")]

    # I/O thread

    def sources(self) -> Iterable[tuple[zmq.Socket[bytes] | int, int]]:
        """Yield the sockets and descriptors to poll, with their events."""
        yield self.discovery.fileno(), zmq.POLLIN
        yield self.receiver, zmq.POLLIN
        yield self.replier, 0 if self._threads.full() else zmq.POLLIN

    def take(self, ready: dict[object, int]) -> None:
        if self.discovery.fileno() in ready:
            self.discovery.receive()
        if self.receiver in ready:
            for frames in _waiting(self.receiver, _RESPONSE_FRAMES):
                self._take_response(frames)
        if self.replier in ready:
            for frames in _waiting(self.replier, _REQUEST_FRAMES):
                self._take_request(frames)

    def tick(self) -> float:
        """Send what is due and retry what failed; return the time [s] until the next call."""
        wait_s = self.discovery.tick()
        return min(wait_s, RETRY_S) if self._courier.retry() else wait_s

    def _take_response(self, frames: list[bytes]) -> None:
        _, name, node_uuid, key, data, result = frames
        pending = self._pending.get(key)
        if pending is not None and (pending.name, pending.node_uuid) == (name, node_uuid):
            pending.finish(CallResult(True, True, data) if result == b"1" else FAILED)

    def _take_request(self, frames: list[bytes]) -> None:
        try:
            name, address = frames[1].decode(), frames[2].decode()
            request_type, response_type = frames[7].decode(), frames[8].decode()
        except UnicodeDecodeError:
            return
        receiver_id, node_uuid, key, data = frames[3:7]
        if not is_one_way(response_type) and not is_usable(address, self._ip):
            return
        for service in SWITCHBOARD.services(name):
            if service.scope != Scope.PROCESS and service.matches(request_type, response_type):
                work = functools.partial(self._serve, service, data, address, receiver_id, node_uuid, key)
                self._threads.put(work)
                return

    def _serve(
        self, service: Service, data: bytes, address: str, receiver_id: bytes, node_uuid: bytes, key: bytes
    ) -> None:
        outcome = FAILED
        try:
            outcome = service.answer(data)
        finally:
            if not service.one_way:
                frames = (service.name.encode(), node_uuid, key, outcome.response, b"1" if outcome.result else b"0")
                deadline = time.monotonic() + RESPONSE_DEADLINE_S
                self._courier.send(Letter(lambda: [(address, receiver_id, frames)], deadline, lambda: None))

    def _on_gone(self, records: list[Discovery.Publisher]) -> None:
        still_there = {record.address for record in self.discovery.all_known()}
        for address in {record.address for record in records} - still_there:
            self._courier.leave(address)

    # Services of this process

    def _own_services(self, name: str | None) -> Iterable[Discovery.Publisher]:
        services = SWITCHBOARD.all_services() if name is None else SWITCHBOARD.services(name)
        return [self._record(each) for each in services if each.scope != Scope.PROCESS]

    def _record(self, service: Service) -> Discovery.Publisher:
        record = Discovery.Publisher(
            topic=service.name,
            address=self.address,
            process_uuid=self._process_uuid,
            node_uuid=service.node_uuid,
            scope=int(service.scope),
        )
        record.srv_pub.socket_id = self._replier_id
        record.srv_pub.request_type = service.request_type
        record.srv_pub.response_type = service.response_type
        return record

    # Closing

    def stop_threads(self) -> None:
        self._threads.stop()

    def close(self) -> None:
        """Close the sockets; the I/O thread must have ended."""
        self.discovery.close()
        self._courier.close()
        self.replier.close()
        self.receiver.close()


def _receiving_socket(
    context: zmq.Context[zmq.Socket[bytes]], ip: str, routing_id: str
) -> tuple[zmq.Socket[bytes], str]:
    router = context.socket(zmq.ROUTER)
    router.setsockopt(zmq.LINGER, 0)
    router.setsockopt(zmq.ROUTING_ID, routing_id.encode())
    router.setsockopt(zmq.MAXMSGSIZE, _LARGEST_FRAME)
    router.bind(f"tcp://{ip}:*")
    return router, router.getsockopt_string(zmq.LAST_ENDPOINT)


def _waiting(router: zmq.Socket[bytes], length: int) -> Iterator[list[bytes]]:
    """Yield the waiting messages of `length` frames, up to a limit; drop others."""
    for _ in range(_MOST_AT_ONCE):
        try:
            frames: list[bytes] = router.recv_multipart(zmq.NOBLOCK)
        except zmq.Again:
            return
        if len(frames) == length:
            yield frames


def _listed(record: Discovery.Publisher) -> ServicePublisher:
    return ServicePublisher(
        naming.split(record.topic)[1],
        record.address,
        record.srv_pub.request_type,
        record.srv_pub.response_type,
        record.process_uuid,
        record.node_uuid,
        Scope(record.scope) if record.scope in (1, 2) else Scope.ALL,
        record.srv_pub.socket_id,
    )
