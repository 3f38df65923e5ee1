"""The node, through which a program advertises, subscribes, calls services and lists topics.

It qualifies names, owns publishers and subscriptions, and registers them in the switchboard of the process and, unless
its scope is PROCESS, with the network. `NodeServices` implements its services. As in the official binding a call that
cannot be done returns an invalid publisher or False, and says why on stderr; a wrong Python type is a TypeError.

Source: https://gazebosim.org/api/transport/13/
"""

from __future__ import annotations

import contextlib
import uuid
import weakref
from collections.abc import Callable
from types import TracebackType
from typing import Any

from google.protobuf.message import Message

from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.advertisement import Advertisement
from gz_course.sim.gz.transport.environment import complain
from gz_course.sim.gz.transport.local_delivery import LOCAL_DELIVERY
from gz_course.sim.gz.transport.message_info import MessageInfo, MessagePublisher, ServicePublisher
from gz_course.sim.gz.transport.node_services import NodeServices
from gz_course.sim.gz.transport.node_statistics import NodeStatistics
from gz_course.sim.gz.transport.node_topics import known_publishers, publishers_and_subscribers
from gz_course.sim.gz.transport.options import (
    AdvertiseMessageOptions,
    AdvertiseServiceOptions,
    NodeOptions,
    SubscribeOptions,
)
from gz_course.sim.gz.transport.publisher import Publisher
from gz_course.sim.gz.transport.reach import network_for, present_network_for
from gz_course.sim.gz.transport.service import TIMED_OUT, CallResult
from gz_course.sim.gz.transport.subscription import GENERIC_TYPE, Subscription
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.topic_statistics import TopicStatistics
from gz_course.sim.gz.transport.type_name import for_fortress, type_name

DEFAULT_TIMEOUT_MS = 1000


class Node:
    """A participant in the topics and services of its partition.

    It ends with close(), with its `with` statement, or when nothing refers to it any more: then its subscriptions and
    services end, and its publishers unless the program keeps them.
    """

    def __init__(self, options: NodeOptions | None = None) -> None:
        """Create a node; it joins the network at the first advertise, subscribe, call or list."""
        LOCAL_DELIVERY.tidy()
        self._options = (options or NodeOptions()).copy()
        self._uuid = str(uuid.uuid4())
        self._services = NodeServices(self._options, self._uuid)
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._statistics = NodeStatistics(self._options.scope)
        self._open = True
        self._finalizer = weakref.finalize(self, _forget, self._subscriptions, self._services, self._statistics)
        self._finalizer.atexit = False  # the network says farewell at exit

    @property
    def options(self) -> NodeOptions:
        return self._options.copy()

    def advertise(
        self, topic: str, msg_type: type[Message] | str, options: AdvertiseMessageOptions | None = None
    ) -> Publisher:
        """Return a publisher on `topic`; `msg_type` is a message class, or a type name for publish_raw().

        The publisher is not valid if the topic name is not, or if this node already advertises the topic.
        """
        self._check_open()
        options = options or AdvertiseMessageOptions()
        scope = min(self._options.scope, options.scope)
        kind = for_fortress(type_name(msg_type)) if options.fortress else type_name(msg_type)
        try:
            name = self._options.qualified(topic)
            advertisement = Advertisement(name, kind, self._uuid, scope, options.msgs_per_sec)
            SWITCHBOARD.add_publisher(advertisement)
        except ValueError as error:
            complain(str(error))
            return Publisher()
        publisher = Publisher(advertisement)
        self._publishers = [*(each for each in self._publishers if each.valid()), publisher]
        if network := network_for(scope):
            network.advertise(advertisement)
        return publisher

    def subscribe(
        self,
        msg_type: type[Message],
        topic: str,
        callback: Callable[[Any], Any],
        options: SubscribeOptions | None = None,
    ) -> bool:
        """Call `callback(message)` for every message of this type on `topic`; return False if its name is not valid.

        Messages of this process arrive in one thread (those of synchronous nodes in the publisher's thread), messages
        of other processes in another, so two calls may run at a time. Messages of other types are not delivered.
        """
        if not (isinstance(msg_type, type) and issubclass(msg_type, Message)):
            raise TypeError(
                f"subscribe() takes the message class first and the topic second: expected a class such as "
                f"gz.msgs.twist_pb2.Twist, but was given {msg_type!r}."
            )
        return self._subscribe(topic, type_name(msg_type), callback, options, msg_type)

    def subscribe_raw(
        self,
        topic: str,
        callback: Callable[[bytes, MessageInfo], Any],
        msg_type: str = GENERIC_TYPE,
        options: SubscribeOptions | None = None,
    ) -> bool:
        """Call `callback(data, info)` with each serialized message; without a type name, with messages of every
        type.
        """
        return self._subscribe(topic, type_name(msg_type), callback, options, None)

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
        name = self._qualified(topic)
        if name is None:
            return False
        subscription = Subscription(
            name,
            kind,
            self._uuid,
            self._options.scope,
            options or SubscribeOptions(),
            callback,
            message_type,
            self._options.synchronous,
        )
        SWITCHBOARD.add_subscription(subscription)
        self._subscriptions.append(subscription)
        if network := network_for(subscription.scope):
            network.subscribe(subscription)
        return True

    def _qualified(self, topic: str, what: str = "topic") -> str | None:
        """Return the fully qualified name, or None with a line on stderr if the name is not valid."""
        try:
            return self._options.qualified(topic, what)
        except ValueError as error:
            complain(str(error))
            return None

    def unsubscribe(self, topic: str) -> bool:
        """End all subscriptions of this node to `topic`; return False if there were none."""
        name = self._qualified(topic)
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
        if (name := self._qualified(topic)) is None:
            return [], []
        plain = naming.split(name)[1]
        published, subscribed = self.publishers_and_subscribers()
        return [each for each in published if each.topic == plain], [each for each in subscribed if each.topic == plain]

    def enable_stats(
        self, topic: str, enable: bool, publication_topic: str = "/statistics", publication_rate: int = 1
    ) -> bool:
        """Begin or end statistics of a topic; return False if its name is not valid.

        They are published on `publication_topic` as gz.msgs.Metric, at most `publication_rate` times per second, when
        messages of other processes arrive. As in Gazebo all processes need GZ_TRANSPORT_TOPIC_STATISTICS=1 for it.
        """
        self._check_open()
        if (name := self._qualified(topic)) is None:
            return False
        self._statistics.disable(name)
        if enable:
            options = AdvertiseMessageOptions(msgs_per_sec=publication_rate)
            self._statistics.enable(name, self.advertise(publication_topic, "gz.msgs.Metric", options))
        return True

    def topic_stats(self, topic: str) -> TopicStatistics | None:
        """Return the statistics of a topic; None if they are not enabled or no message has arrived since."""
        name = self._qualified(topic)
        return None if name is None else self._statistics.get(name)

    def known_publishers(self, topic: str) -> list[MessagePublisher]:
        """Return the known publishers of a topic; does not wait, so a new one may be missing.

        A publisher of a killed process leaves the list after about 3 [s]. Not in the official binding.
        """
        return known_publishers(self._options, topic)

    def publishers_and_subscribers(self) -> tuple[list[MessagePublisher], list[MessagePublisher]]:
        """Return the publishers and the subscribers of all topics of the partition; waits like topic_list().

        Not in the official binding.
        """
        return publishers_and_subscribers(self._options)

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
        timeout: int = DEFAULT_TIMEOUT_MS,
    ) -> tuple[bool, Any]:
        """Call a service; return whether it succeeded, and the response.

        After a failure, or without a response within `timeout` [ms], the response is an empty message. A service
        without arguments takes None (or a message) of type gz.msgs.Empty. With gz.msgs.Empty as response type the call
        is one-way and returns True when it is sent. As in Gazebo providers with other types are not called.
        """
        if request is None:
            request = request_type()
        if not isinstance(request, request_type):
            complain(
                f"The request to service {service!r} is a {request.DESCRIPTOR.full_name}, but the request type was "
                f"given as {type_name(request_type)}; the service is not called."
            )
            return False, response_type()
        outcome = self.call_raw(
            service, request.SerializeToString(), type_name(request_type), type_name(response_type), timeout
        )
        response = response_type()
        if outcome.result:
            response.ParseFromString(outcome.response)
        return outcome.result, response

    def request_raw(
        self, topic: str, request: bytes, request_type: str, response_type: str, timeout: int = DEFAULT_TIMEOUT_MS
    ) -> tuple[bool, bytes]:
        """Call the service `topic` like request(), with serialized messages and type names."""
        outcome = self.call_raw(topic, request, request_type, response_type, timeout)
        return outcome.result, outcome.response

    def call_raw(
        self, service: str, request: bytes, request_type: str, response_type: str, timeout: int = DEFAULT_TIMEOUT_MS
    ) -> CallResult:
        """Call a service like request_raw(); the result distinguishes a failed provider from a missing response.

        Not in the official binding.
        """
        self._check_open()
        if self._qualified(service, "service") is None:
            return TIMED_OUT
        return self._services.call(service, request, request_type, response_type, timeout)

    def service_list(self) -> list[str]:
        """Return all services of the partition, sorted; waits like topic_list()."""
        return sorted({each.topic for each in self.service_publishers()})

    def service_info(self, service: str) -> list[ServicePublisher]:
        """Return the providers of a service; waits like topic_list()."""
        if (name := self._qualified(service, "service")) is None:
            return []
        plain = naming.split(name)[1]
        return [each for each in self.service_publishers() if each.topic == plain]

    def service_publishers(self) -> list[ServicePublisher]:
        """Return the providers of all services; waits like topic_list(). Not in the official binding."""
        return self._services.publishers()

    def close(self) -> None:
        """Close all publishers, subscriptions and services of this node; closing twice does nothing."""
        self._open = False
        self._finalizer.detach()
        for publisher in self._publishers:
            publisher.close()
        self._publishers.clear()
        for subscription in list(self._subscriptions):
            self._end(subscription)
        self._services.close()
        self._statistics.close()

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


def _forget(subscriptions: list[Subscription], services: NodeServices, statistics: NodeStatistics) -> None:
    """End a node to which nobody refers any more; runs at any moment, so the tables are changed elsewhere."""
    for subscription in subscriptions:
        subscription.active = False
    SWITCHBOARD.version = object()
    LOCAL_DELIVERY.end_later(lambda: _withdraw(subscriptions, services, statistics))


def _withdraw(subscriptions: list[Subscription], services: NodeServices, statistics: NodeStatistics) -> None:
    for subscription in subscriptions:
        SWITCHBOARD.remove_subscription(subscription)
        if network := present_network_for(subscription.scope):
            network.unsubscribe(subscription)
    services.close()
    statistics.close()
