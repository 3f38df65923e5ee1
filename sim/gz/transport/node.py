"""The door to all topics and services: a node advertises, subscribes, and lists what there is.

A node turns names into fully qualified ones, keeps its publishers and subscriptions, and registers them in
the switchboard of the process and, unless its scope is PROCESS, with the network.
"""

from __future__ import annotations

import contextlib
import uuid
from collections.abc import Callable
from types import TracebackType
from typing import Any

from google.protobuf.message import Message

from gz_course.sim.gz.transport import naming
from gz_course.sim.gz.transport.message_info import MessageInfo, MessagePublisher
from gz_course.sim.gz.transport.options import AdvertiseMessageOptions, NodeOptions, Scope, SubscribeOptions
from gz_course.sim.gz.transport.publisher import Publisher
from gz_course.sim.gz.transport.service_calls import ServiceCalls
from gz_course.sim.gz.transport.subscription import GENERIC_TYPE, Subscription
from gz_course.sim.gz.transport.switchboard import SWITCHBOARD
from gz_course.sim.gz.transport.type_name import for_fortress, type_name


class Node(ServiceCalls):
    """A participant in the topics and services of its partition. Use it in a `with` statement, or close() it."""

    def __init__(self, options: NodeOptions | None = None) -> None:
        """Nothing happens on the network before the first advertise, subscribe or list."""
        self._options = (options or NodeOptions()).copy()
        self._uuid = str(uuid.uuid4())
        self._publishers: list[Publisher] = []
        self._subscriptions: list[Subscription] = []
        self._open = True

    @property
    def options(self) -> NodeOptions:
        """The options of the node (a copy)."""
        return self._options.copy()

    def advertise(
        self, topic: str, message_type: type[Message] | str, options: AdvertiseMessageOptions | None = None
    ) -> Publisher:
        """A publisher on `topic`; `message_type` is a message class, or a type name for publish_raw().

        Raises ValueError when the topic name breaks a rule (it is quoted) or this node advertises it already.
        """
        self._check_open()
        options = options or AdvertiseMessageOptions()
        scope = min(self._options.scope, options.scope)
        joined = None
        if scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            joined = network.joined
        publisher = Publisher(
            self._qualified(topic),
            for_fortress(type_name(message_type)) if options.fortress else type_name(message_type),
            self._uuid,
            scope,
            options,
            joined,
        )
        SWITCHBOARD.add_publisher(publisher)
        self._publishers = [*(each for each in self._publishers if each.valid()), publisher]
        if joined is not None:
            joined().advertise(publisher)
        return publisher

    def subscribe(
        self,
        message_type: type[Message],
        topic: str,
        callback: Callable[[Any], Any],
        options: SubscribeOptions | None = None,
    ) -> bool:
        """Calls `callback(message)` for every message of this type on `topic`. Type first, then topic.

        Messages of this process arrive in the publisher's thread, others in one dispatcher thread, so a
        callback that hears both may run in two threads at a time. Messages of another type are not delivered.
        Raises ValueError when the topic name breaks a rule, TypeError for a wrong kind of argument.
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
        """Calls `callback(data, info)` with the serialized message; without a type name, for every type."""
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
            self._qualified(topic),
            kind,
            self._uuid,
            self._options.scope,
            options or SubscribeOptions(),
            callback,
            message_type,
        )
        SWITCHBOARD.add_subscription(subscription)
        self._subscriptions.append(subscription)
        if subscription.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            network.joined().subscribe(subscription)
        return True

    def unsubscribe(self, topic: str) -> bool:
        """Ends all subscriptions of this node to `topic`; False when there were none."""
        name = self._qualified(topic)
        ended = [each for each in self._subscriptions if each.name == name]
        for each in ended:
            self._end(each)
        return bool(ended)

    def _end(self, subscription: Subscription) -> None:
        with contextlib.suppress(ValueError):  # another thread ended it at the same moment
            self._subscriptions.remove(subscription)
        SWITCHBOARD.remove_subscription(subscription)
        if subscription.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            network.joined().unsubscribe(subscription)

    def advertised_topics(self) -> list[str]:
        """The topics this node publishes on, sorted, without partition."""
        return sorted({each.topic for each in self._publishers if each.valid()})

    def subscribed_topics(self) -> list[str]:
        """The topics this node listens to, sorted, without partition."""
        return sorted({naming.split(each.name)[1] for each in self._subscriptions})

    def endpoints(self) -> tuple[list[tuple[str, str]], list[tuple[str, str]]]:
        """(what this node publishes, what it listens to), each as (topic, type name), in the order in which they came.
        (Our addition.)
        """
        published = [(each.topic, each.type_name) for each in self._publishers if each.valid()]
        return published, [(naming.split(each.name)[1], each.type_name) for each in self._subscriptions]

    def topic_list(self) -> list[str]:
        """All topics of the partition, sorted; those with publishers first, then those with subscribers only.

        The first call in a process waits until every other process had the time to announce itself (about one
        second). A node with scope PROCESS answers at once, for its own process.
        """
        published, subscribed = self.publishers_and_subscribers()
        first = {each.topic for each in published}
        return sorted(first) + sorted({each.topic for each in subscribed} - first)

    def topic_info(self, topic: str) -> tuple[list[MessagePublisher], list[MessagePublisher]]:
        """(publishers, subscribers) of a topic; waits like topic_list()."""
        plain = naming.split(self._qualified(topic))[1]
        published, subscribed = self.publishers_and_subscribers()
        return [each for each in published if each.topic == plain], [each for each in subscribed if each.topic == plain]

    def known_publishers(self, topic: str) -> list[MessagePublisher]:
        """The publishers of a topic that this process knows of already; never waits, may lack a new one.

        One of a process that was killed goes from the list within about three seconds. (Our addition.)
        """
        name = self._qualified(topic)
        found = [
            MessagePublisher(each.topic, "", each.type_name, "", each.node_uuid, each.scope)
            for each in SWITCHBOARD.all_publishers()
            if each.name == name
        ]
        if self._options.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            found += network.joined().known_publishers(name)
        return found

    def publishers_and_subscribers(self) -> tuple[list[MessagePublisher], list[MessagePublisher]]:
        """(publishers, subscribers) of all topics of the partition; waits like topic_list(). (Our addition.)"""
        process, address = "", ""
        named_published: list[tuple[str, MessagePublisher]] = []
        named_subscribed: list[tuple[str, MessagePublisher]] = []
        if self._options.scope != Scope.PROCESS:
            from gz_course.sim.gz.transport import network

            joined = network.joined()
            process, address = joined.process_uuid, joined.address
            named_published, named_subscribed = joined.known_elsewhere()
        for publisher in SWITCHBOARD.all_publishers():
            reachable = address if publisher.scope != Scope.PROCESS else ""
            named_published.append(
                (
                    publisher.name,
                    MessagePublisher(
                        publisher.topic,
                        reachable,
                        publisher.type_name,
                        process,
                        publisher.node_uuid,
                        publisher.scope,
                    ),
                )
            )
        for each in SWITCHBOARD.all_subscriptions():
            reachable = address if each.scope != Scope.PROCESS else ""
            topic = naming.split(each.name)[1]
            named_subscribed.append(
                (
                    each.name,
                    MessagePublisher(topic, reachable, each.type_name, process, each.node_uuid, each.scope),
                )
            )
        own = naming.fully_qualified(self._options.partition, "", "/any").removesuffix("/any")
        return (
            [info for name, info in named_published if name.startswith(own)],
            [info for name, info in named_subscribed if name.startswith(own)],
        )

    def close(self) -> None:
        """Closes all publishers and ends all subscriptions and services of this node. Closing twice does nothing."""
        self._open = False
        for publisher in self._publishers:
            publisher.close()
        self._publishers.clear()
        for subscription in list(self._subscriptions):
            self._end(subscription)
        self._end_services()

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
