"""What a node does with services: offer, call and list them. A part of Node, in a file of its own.

A service of the same process is called directly, in the thread of the requester; others through the network.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from google.protobuf.message import Message

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.message_info import ServicePublisher
from gz_course.sim.gz.transport.options import AdvertiseServiceOptions, NodeOptions, Scope
from gz_course.sim.gz.transport.service import TIMED_OUT, CallResult, Service
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.type_name import for_fortress, type_name

DEFAULT_TIMEOUT_MS = 1000


class ServiceCalls:
    """The methods of Node for services."""

    _options: NodeOptions
    _uuid: str

    def advertise_service(
        self,
        service: str,
        request_type: type[Message] | str,
        response_type: type[Message] | str,
        callback: Callable[[Any], Any],
        options: AdvertiseServiceOptions | None = None,
    ) -> bool:
        """Offers a service: `callback(request)` returns the response, or (bool, response), False for a failure.

        With gz.msgs.Empty as response type requests are one-way and nothing is returned. Requests of other
        processes come one at a time, in a thread of their own; those of this process in the requester's thread.
        An exception is reported on stderr and to the requester, as a failure. (Our addition: the official
        binding cannot offer services.) Raises ValueError when the name breaks a rule, TypeError for arguments of
        the wrong kind, and ValueError when this node offers the service already.
        """
        self._check_open()
        options = options or AdvertiseServiceOptions()
        if not callable(callback):
            raise TypeError(f"The callback for service {service!r} cannot be called: it is {callback!r}.")
        names = [type_name(request_type), type_name(response_type)]
        if options.fortress:
            names = [for_fortress(name) for name in names]
        offered = Service(
            self._qualified(service, "service"),
            _class(request_type),
            _class(response_type),
            names[0],
            names[1],
            self._uuid,
            min(self._options.scope, options.scope),
            callback,
        )
        SWITCHBOARD.add_service(offered)
        if offered.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            network.joined().services().advertise(offered)
        return True

    def unadvertise_service(self, service: str) -> bool:
        """Takes a service of this node back; False when it offers none of that name."""
        name = self._qualified(service, "service")
        ended = [each for each in SWITCHBOARD.services(name) if each.node_uuid == self._uuid]
        for each in ended:
            self._end_service(each)
        return bool(ended)

    def _end_service(self, service: Service) -> None:
        SWITCHBOARD.remove_service(service)
        if service.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            network.joined().services().unadvertise(service)

    def _end_services(self) -> None:
        for service in SWITCHBOARD.all_services():
            if service.node_uuid == self._uuid:
                self._end_service(service)

    def advertised_services(self) -> list[str]:
        """The services this node offers, sorted, without partition."""
        return sorted({each.topic for each in SWITCHBOARD.all_services() if each.node_uuid == self._uuid})

    def request(
        self,
        service: str,
        request: Message | None,
        request_type: type[Message],
        response_type: type[Message],
        timeout_ms: int = DEFAULT_TIMEOUT_MS,
    ) -> tuple[bool, Any]:
        """Calls a service and waits at most `timeout_ms` milliseconds; (whether it succeeded, the response).

        After a failure, or when nobody answered in time, the response is an empty message. A service without
        arguments takes None (or a message) of type gz.msgs.Empty. With gz.msgs.Empty as response type the call
        is one-way: True as soon as it is sent. Providers with other types are not asked, as in Gazebo.
        """
        if request is None:
            request = request_type()
        if not isinstance(request, request_type):
            raise TypeError(
                f"The request to service {service!r} is a {type(request).__name__}, "
                f"but the request type was given as {type_name(request_type)}."
            )
        outcome = self.call_raw(
            service, request.SerializeToString(), type_name(request_type), type_name(response_type), timeout_ms
        )
        response = response_type()
        if outcome.result:
            response.ParseFromString(outcome.response)
        return outcome.result, response

    def request_raw(
        self, service: str, request: bytes, request_type: str, response_type: str, timeout_ms: int = DEFAULT_TIMEOUT_MS
    ) -> tuple[bool, bytes]:
        """As request(), with serialized messages and names of types."""
        outcome = self.call_raw(service, request, request_type, response_type, timeout_ms)
        return outcome.result, outcome.response

    def call_raw(
        self, service: str, request: bytes, request_type: str, response_type: str, timeout_ms: int = DEFAULT_TIMEOUT_MS
    ) -> CallResult:
        """As request_raw(); tells a provider that failed from one that did not answer. (Our addition.)"""
        self._check_open()
        name = self._qualified(service, "service")
        if isinstance(timeout_ms, bool) or not isinstance(timeout_ms, int) or timeout_ms < 0:
            raise ValueError(f"timeout_ms is {timeout_ms!r}, but a whole number of milliseconds was expected.")
        for offered in SWITCHBOARD.services(name):
            if offered.matches(request_type, response_type):
                return offered.answer(request)
        if self._options.scope == Scope.PROCESS:
            return TIMED_OUT
        from gz_course.sim.gz.transport import network

        services = network.joined().services()
        return services.request(name, self._uuid, bytes(request), request_type, response_type, timeout_ms / 1000)

    def service_list(self) -> list[str]:
        """All services of the partition, sorted.

        The first call in a process waits until every other process had the time to announce itself (about one
        second). A node with scope PROCESS answers at once, for its own process.
        """
        return sorted({each.topic for each in self.service_publishers()})

    def service_info(self, service: str) -> list[ServicePublisher]:
        """The providers of a service; waits like service_list()."""
        plain = naming.split(self._qualified(service, "service"))[1]
        return [each for each in self.service_publishers() if each.topic == plain]

    def service_publishers(self) -> list[ServicePublisher]:
        """The providers of all services of the partition; waits like service_list(). (Our addition.)"""
        found: list[tuple[str, ServicePublisher]] = []
        process, address = "", ""
        if self._options.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            joined = network.joined()
            process, address = joined.process_uuid, joined.services().address
            found = joined.services().known_elsewhere()
        for each in SWITCHBOARD.all_services():
            reachable = address if each.scope != Scope.PROCESS else ""
            info = ServicePublisher(
                each.topic, reachable, each.request_type, each.response_type, process, each.node_uuid, each.scope
            )
            found.append((each.name, info))
        own = naming.fully_qualified(self._options.partition, "", "/any").removesuffix("/any")
        return [info for name, info in found if name.startswith(own)]

    def _qualified(self, topic: str, what: str = "topic") -> str:
        topic = self._options.renamed(topic)
        return naming.fully_qualified(self._options.partition, self._options.namespace, topic, what)

    def _check_open(self) -> None:
        raise NotImplementedError


def _class(message_type: type[Message] | str) -> type[Message]:
    return message_class(message_type) if isinstance(message_type, str) else message_type
