"""The node, through which a program advertises, subscribes, calls services and lists topics.

It qualifies names, owns publishers and subscriptions, and registers them in the switchboard of the process and, unless
its scope is PROCESS, with the network. `NodeServices` implements its services.

Source: https://gazebosim.org/api/transport/13/
"""

from __future__ import annotations

import contextlib
import uuid
from collections.abc import Callable
from types import TracebackType
from typing import Any

from google.protobuf.message import Message

from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.message_info import MessageInfo, MessagePublisher, ServicePublisher
from gz_course.sim.gz.transport.node_services import NodeServices
from gz_course.sim.gz.transport.options import (
    AdvertiseMessageOptions,
    AdvertiseServiceOptions,
    NodeOptions,
    Scope,
    SubscribeOptions,
)
from gz_course.sim.gz.transport.publisher import Publisher
from gz_course.sim.gz.transport.reach import network_for
from gz_course.sim.gz.transport.service import CallResult
from gz_course.sim.gz.transport.subscription import GENERIC_TYPE, Subscription
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.type_name import for_fortress, type_name

DEFAULT_TIMEOUT_MS = 1000


class Node:
    """A participant in the topics and services of its partition; use it in a `with` statement, or call close()."""

    def __init__(self, options: NodeOptions | None = None) -> None:
        """Create a node; it joins the network at the first advertise, subscribe, call or list."""
        self._options = (options or NodeOptions()).copy()
        self._uuid = str(uuid.uuid4())
        self._services = NodeServices(self._options, self._uuid)
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._open = True

    @property
    def options(self) -> NodeOptions:
        return self._options.copy()

    def advertise(
        self, topic: str, message_type: type[Message] | str, options: AdvertiseMessageOptions | None = None
    ) -> Publisher:
        """Return a publisher on `topic`; `message_type` is a message class, or a type name for publish_raw().

        Raises ValueError if the topic name is invalid or this node already advertises it.
        """
        self._check_open()
        options = options or AdvertiseMessageOptions()
        scope = min(self._options.scope, options.scope)
        publisher = Publisher(
            self._options.qualified(topic),
            for_fortress(type_name(message_type)) if options.fortress else type_name(message_type),
            self._uuid,
            scope,
            options,
        )
        SWITCHBOARD.add_publisher(publisher)
        self._publishers = [*(each for each in self._publishers if each.valid()), publisher]
        if network := network_for(scope):
            network.advertise(publisher)
        return publisher

    def subscribe(
        self,
        message_type: type[Message],
        topic: str,
        callback: Callable[[Any], Any],
        options: SubscribeOptions | None = None,
    ) -> bool:
        """Call `callback(message)` for every message of this type on `topic`; return True.

        Messages of this process arrive in the publisher's thread, others in one dispatcher thread, so two calls may run
        at a time. Messages of other types are not delivered. Raises ValueError if the topic name is invalid, TypeError
        for an argument of a wrong type.
        """
        if not (isinstance(message_type, type) and issubclass(message_type, Message)):
            raise TypeError(
                f"subscribe() takes the message class first and the topic second: expected a class such as "
                f"gz.msgs.twist_pb2.Twist, but was given {message_type!r}."
            )
        return self._subscribe(topic, type_name(message_type), callback, options, message_type)

    def subscribe_raw(
        self,
        topic: str,
        callback: Callable[[bytes, MessageInfo], Any],
        message_type: str = GENERIC_TYPE,
        options: SubscribeOptions | None = None,
    ) -> bool:
        """Call `callback(data, info)` with each serialized message; without a type name, with messages of every
        type.
        """
        return self._subscribe(topic, type_name(message_type), callback, options, None)

    def _subscribe(
        self,
        topic: str,
        kind: str,
        callback: Callable[..., Any],
        options: SubscribeOptions | None,
        message_type: type[Message] | None,
    ) -> bool:
        self._check_open()
        if not callable(callback):
            raise TypeError(f"The callback for topic {topic!r} cannot be called: it is {callback!r}.")
        subscription = Subscription(
            self._options.qualified(topic),
            kind,
            self._uuid,
            self._options.scope,
            options or SubscribeOptions(),
            callback,
            message_type,
        )
        SWITCHBOARD.add_subscription(subscription)
        self._subscriptions.append(subscription)
        if network := network_for(subscription.scope):
            network.subscribe(subscription)
        return True

    def unsubscribe(self, topic: str) -> bool:
        """End all subscriptions of this node to `topic`; return False if there were none."""
        name = self._options.qualified(topic)
        ended = [each for each in self._subscriptions if each.name == name]
        for each in ended:
            self._end(each)
        return bool(ended)

    def _end(self, subscription: Subscription) -> None:
        with contextlib.suppress(ValueError):  # another thread ended it at the same time
            self._subscriptions.remove(subscription)
        SWITCHBOARD.remove_subscription(subscription)
        if network := network_for(subscription.scope):
            network.unsubscribe(subscription)

    def advertised_topics(self) -> list[str]:
        """Return the topics this node advertises, sorted, without partition."""
        return sorted({each.topic for each in self._publishers if each.valid()})

    def subscribed_topics(self) -> list[str]:
        """Return the topics this node subscribes to, sorted, without partition."""
        return sorted({naming.split(each.name)[1] for each in self._subscriptions})

    def endpoints(self) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
        """Return publishers and subscriptions of this node, each as a list of (topic, type name), oldest first.

        Not in the official binding.
        """
        published = [(each.topic, each.type_name) for each in self._publishers if each.valid()]
        return published, [(naming.split(each.name)[1], each.type_name) for each in self._subscriptions]

    def topic_list(self) -> list[str]:
        """Return all topics of the partition, sorted: those with publishers first, then those with subscribers only.

        The first call in a process waits about 1 [s], so that other processes can announce themselves. A node with
        scope PROCESS returns the topics of its own process at once.
        """
        published, subscribed = self.publishers_and_subscribers()
        first = {each.topic for each in published}
        return sorted(first) + sorted({each.topic for each in subscribed} - first)

    def topic_info(self, topic: str) -> tuple[list[MessagePublisher], list[MessagePublisher]]:
        """Return the publishers and the subscribers of a topic; waits like topic_list()."""
        plain = naming.split(self._options.qualified(topic))[1]
        published, subscribed = self.publishers_and_subscribers()
        return [each for each in published if each.topic == plain], [each for each in subscribed if each.topic == plain]

    def known_publishers(self, topic: str) -> list[MessagePublisher]:
        """Return the known publishers of a topic; does not wait, so a new one may be missing.

        A publisher of a killed process leaves the list after about 3 [s]. Not in the official binding.
        """
        name = self._options.qualified(topic)
        found = [
            MessagePublisher(each.topic, "", each.type_name, "", each.node_uuid, each.scope)
            for each in SWITCHBOARD.all_publishers()
            if each.name == name
        ]
        if network := network_for(self._options.scope):
            found += network.known_publishers(name)
        return found

    def publishers_and_subscribers(self) -> tuple[list[MessagePublisher], list[MessagePublisher]]:
        """Return the publishers and the subscribers of all topics of the partition; waits like topic_list().

        Not in the official binding.
        """
        process, address = "", ""
        published: list[tuple[str, MessagePublisher]] = []
        subscribed: list[tuple[str, MessagePublisher]] = []
        if network := network_for(self._options.scope):
            process, address = network.process_uuid, network.address
            published, subscribed = network.known_elsewhere()

        def named(each: Publisher | Subscription) -> tuple[str, MessagePublisher]:
            reachable = address if each.scope != Scope.PROCESS else ""
            topic = naming.split(each.name)[1]
            return each.name, MessagePublisher(topic, reachable, each.type_name, process, each.node_uuid, each.scope)

        published += map(named, SWITCHBOARD.all_publishers())
        subscribed += map(named, SWITCHBOARD.all_subscriptions())
        own = naming.partition_prefix(self._options.partition)
        return (
            [info for name, info in published if name.startswith(own)],
            [info for name, info in subscribed if name.startswith(own)],
        )

    def advertise_service(
        self,
        service: str,
        request_type: type[Message] | str,
        response_type: type[Message] | str,
        callback: Callable[[Any], Any],
        options: AdvertiseServiceOptions | None = None,
    ) -> bool:
        """Offer a service: `callback(request)` returns the response, or (bool, response) with False for a failure.

        With gz.msgs.Empty as response type requests are one-way and nothing is returned. Requests of other processes
        are handled one at a time in a separate thread, those of this process in the requester's thread. An exception is
        reported on stderr, and as a failure to the requester. Raises ValueError if the name is invalid or already
        offered by this node, TypeError for arguments of a wrong type. Not in the official binding, which cannot offer
        services.
        """
        self._check_open()
        self._services.advertise(service, request_type, response_type, callback, options or AdvertiseServiceOptions())
        return True

    def unadvertise_service(self, service: str) -> bool:
        """Withdraw a service of this node; return False if it offers none of that name."""
        return self._services.unadvertise(service)

    def advertised_services(self) -> list[str]:
        """Return the services this node offers, sorted, without partition."""
        return self._services.names()

    def request(
        self,
        service: str,
        request: Message | None,
        request_type: type[Message],
        response_type: type[Message],
        timeout_ms: int = DEFAULT_TIMEOUT_MS,
    ) -> tuple[bool, Any]:
        """Call a service; return whether it succeeded, and the response.

        After a failure, or without a response within `timeout_ms` [ms], the response is an empty message. A service
        without arguments takes None (or a message) of type gz.msgs.Empty. With gz.msgs.Empty as response type the call
        is one-way and returns True when it is sent. As in Gazebo providers with other types are not called.
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
        """Call a service like request(), with serialized messages and type names."""
        outcome = self.call_raw(service, request, request_type, response_type, timeout_ms)
        return outcome.result, outcome.response

    def call_raw(
        self, service: str, request: bytes, request_type: str, response_type: str, timeout_ms: int = DEFAULT_TIMEOUT_MS
    ) -> CallResult:
        """Call a service like request_raw(); the result distinguishes a failed provider from a missing response.

        Not in the official binding.
        """
        self._check_open()
        return self._services.call(service, request, request_type, response_type, timeout_ms)

    def service_list(self) -> list[str]:
        """Return all services of the partition, sorted; waits like topic_list()."""
        return sorted({each.topic for each in self.service_publishers()})

    def service_info(self, service: str) -> list[ServicePublisher]:
        """Return the providers of a service; waits like topic_list()."""
        plain = naming.split(self._options.qualified(service, "service"))[1]
        return [each for each in self.service_publishers() if each.topic == plain]

    def service_publishers(self) -> list[ServicePublisher]:
        """Return the providers of all services; waits like topic_list(). Not in the official binding."""
        return self._services.publishers()

    def close(self) -> None:
        """Close all publishers, subscriptions and services of this node; closing twice does nothing."""
        self._open = False
        for publisher in self._publishers:
            publisher.close()
        self._publishers.clear()
        for subscription in list(self._subscriptions):
            self._end(subscription)
        self._services.close()

    def __enter__(self) -> Node:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _check_open(self) -> None:
        if not self._open:
            raise RuntimeError("This node is closed: create a new Node() to advertise or subscribe again.")
