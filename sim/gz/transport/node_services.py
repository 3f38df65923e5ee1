"""The services of one node: offering, calling and listing them, for the service methods of `Node`.

A service of the same process is called directly in the requester's thread, others through the network.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from google.protobuf.message import Message

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.message_info import ServicePublisher
from gz_course.sim.gz.transport.options import AdvertiseServiceOptions, NodeOptions, Scope
from gz_course.sim.gz.transport.reach import network_for
from gz_course.sim.gz.transport.service import TIMED_OUT, CallResult, Service
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.type_name import for_fortress, type_name


class NodeServices:
    """The services that a node offers and calls."""

    def __init__(self, options: NodeOptions, uuid: str) -> None:
        self._options = options
        self._uuid = uuid

    def advertise(
        self,
        service: str,
        request_type: type[Message] | str,
        response_type: type[Message] | str,
        callback: Callable[[Any], Any],
        options: AdvertiseServiceOptions,
    ) -> None:
        if not callable(callback):
            raise TypeError(f"The callback for service {service!r} cannot be called: it is {callback!r}.")
        names = [type_name(request_type), type_name(response_type)]
        if options.fortress:
            names = [for_fortress(name) for name in names]
        offered = Service(
            self._options.qualified(service, "service"),
            _class(request_type),
            _class(response_type),
            names[0],
            names[1],
            self._uuid,
            min(self._options.scope, options.scope),
            callback,
        )
        SWITCHBOARD.add_service(offered)
        if network := network_for(offered.scope):
            network.services().advertise(offered)

    def unadvertise(self, service: str) -> bool:
        """Withdraw a service; return False if the node does not offer it."""
        name = self._options.qualified(service, "service")
        ended = [each for each in self._offered() if each.name == name]
        for each in ended:
            self._end(each)
        return bool(ended)

    def close(self) -> None:
        for service in self._offered():
            self._end(service)

    def names(self) -> list[str]:
        """Return the services that the node offers, sorted, without partition."""
        return sorted({each.topic for each in self._offered()})

    def call(self, service: str, request: bytes, request_type: str, response_type: str, timeout_ms: int) -> CallResult:
        """Call a service with a serialized request; wait at most `timeout_ms` [ms] for the response."""
        name = self._options.qualified(service, "service")
        if isinstance(timeout_ms, bool) or not isinstance(timeout_ms, int) or timeout_ms < 0:
            raise ValueError(f"timeout is {timeout_ms!r}, but a whole number of milliseconds was expected.")
        for offered in SWITCHBOARD.services(name):
            if offered.matches(request_type, response_type):
                return offered.answer(request)
        network = network_for(self._options.scope)
        if network is None:
            return TIMED_OUT
        return network.services().request(
            name, self._uuid, bytes(request), request_type, response_type, timeout_ms / 1000
        )

    def publishers(self) -> list[ServicePublisher]:
        """Return the providers of all services of the partition."""
        found: list[tuple[str, ServicePublisher]] = []
        process, address = "", ""
        if network := network_for(self._options.scope):
            process, address = network.process_uuid, network.services().address
            found = network.services().known_elsewhere()
        for each in SWITCHBOARD.all_services():
            reachable = address if each.scope != Scope.PROCESS else ""
            info = ServicePublisher(
                each.topic, reachable, each.request_type, each.response_type, process, each.node_uuid, each.scope
            )
            found.append((each.name, info))
        own = naming.partition_prefix(self._options.partition)
        return [info for name, info in found if name.startswith(own)]

    def _offered(self) -> list[Service]:
        return [each for each in SWITCHBOARD.all_services() if each.node_uuid == self._uuid]

    @staticmethod
    def _end(service: Service) -> None:
        SWITCHBOARD.remove_service(service)
        if network := network_for(service.scope):
            network.services().unadvertise(service)


def _class(message_type: type[Message] | str) -> type[Message]:
    return message_class(message_type) if isinstance(message_type, str) else message_type
