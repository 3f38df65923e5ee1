"""The discovery channel of topics, which also knows the subscribers of this process's publishers.

Subscribers notify a publisher when they connect (NEW_CONNECTION) and leave (END_CONNECTION), and answer the request for
all subscriptions (SUBSCRIBERS_REQ), which only lists need.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/src/NodeShared.cc (OnEndRegistration)
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable
from typing import Any

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.msgs.fortress import same_type
from gz_course.sim.gz.transport.discovery import DiscoveryChannel
from gz_course.sim.gz.transport.environment import NetworkSettings
from gz_course.sim.gz.transport.subscription import GENERIC_TYPE, Subscription

_MOST_SUBSCRIBERS, _MOST_LISTED_BYTES = 1000, 8_000_000
"""Limits against invented subscribers: of one topic of this process, and of a list of all."""
ANSWER_TIME_S = 0.1
"""Time [s] for which answers to a request for subscribers are collected; their number is not known in advance."""

SubscriberKey = tuple[str, str]
"""The process UUID and node UUID of a subscriber."""


class TopicDiscovery(DiscoveryChannel):
    """Discovery of publishers and subscribers of topics."""

    def __init__(
        self,
        process_uuid: str,
        settings: NetworkSettings,
        own: Callable[[str | None], Iterable[Discovery.Publisher]],
        own_subscriptions: Callable[[], Iterable[Subscription]],
        own_address: str,
        on_advertise: Callable[[Discovery.Publisher, bool], None],
        on_gone: Callable[[list[Discovery.Publisher]], None],
        on_subscribers: Callable[[], None],
    ) -> None:
        """See DiscoveryChannel; `on_subscribers()` is called when subscribers of this process's publishers change."""
        super().__init__(process_uuid, settings, settings.message_port, own, on_advertise, on_gone)
        self._own_subscriptions = own_subscriptions
        self._own_address = own_address
        self._on_subscribers = on_subscribers
        self._table_lock = threading.Lock()
        self._connected: dict[str, dict[SubscriberKey, str]] = {}
        self._listed: dict[str, dict[SubscriberKey, Discovery.Publisher]] = {}
        self._listed_bytes = 0
        self._with_subscribers: set[str] = set()  # the processes in the two tables

    def subscriber_processes(self, topic: str, type_name: str) -> int:
        """Return how many other processes subscribe to this process's publisher of this topic and type."""
        with self._table_lock:
            group = self._connected.get(topic, {})
            return len(
                {process for (process, _), kind in group.items() if kind == GENERIC_TYPE or same_type(kind, type_name)}
            )

    def ask_for_subscribers(self) -> None:
        """Request the subscriptions of all processes; subscribers() returns the answers."""
        with self._table_lock:
            self._listed.clear()
            self._listed_bytes = 0
        self._send_about_process(Discovery.SUBSCRIBERS_REQ)

    def wait_for_answers(self) -> None:
        """Wait until the lists of publishers and subscribers are as complete as the protocol allows."""
        time.sleep(max(ANSWER_TIME_S, self.seconds_until_complete()))

    def subscribers(self) -> list[Discovery.Publisher]:
        """Return the subscribers of other processes that answered or are connected to this process."""
        with self._table_lock:
            found = {(topic, *key): record for topic, group in self._listed.items() for key, record in group.items()}
            for topic, group in self._connected.items():
                for (process, node), kind in group.items():
                    record = Discovery.Publisher(topic=topic, process_uuid=process, node_uuid=node, scope="ALL")
                    record.msg_pub.msg_type = kind
                    found.setdefault((topic, process, node), record)
        return list(found.values())

    def send_new_connection(self, publisher: Discovery.Publisher, node_uuid: str) -> None:
        """Notify the process of a publisher that this node subscribes to it."""
        record = Discovery.Publisher()
        record.CopyFrom(publisher)
        record.process_uuid = self.process_uuid
        record.node_uuid = node_uuid
        record.msg_pub.ctrl = publisher.process_uuid
        self.send(Discovery.NEW_CONNECTION, record)

    def send_end_connection(self, topic: str, node_uuid: str) -> None:
        """Notify the publishers of a topic that this node no longer subscribes."""
        processes = {record.process_uuid for record in self.known(topic)}
        for process_uuid in [*sorted(processes), ""]:
            record = self._about_subscriber(topic, node_uuid, GENERIC_TYPE)
            record.msg_pub.ctrl = process_uuid
            self.send(Discovery.END_CONNECTION, record)

    def _about_subscriber(self, topic: str, node_uuid: str, type_name: str) -> Discovery.Publisher:
        record = Discovery.Publisher(
            topic=topic,
            address=self._own_address,
            process_uuid=self.process_uuid,
            node_uuid=node_uuid,
            scope=Discovery.Publisher.ALL,
        )
        record.msg_pub.msg_type = type_name
        return record

    def handle(self, message: Discovery, source_ip: str) -> None:
        """Process one message; answer the request for subscribers, which has no topic."""
        if message.type == Discovery.SUBSCRIBERS_REQ:
            for each in self._own_subscriptions():
                self.send(
                    Discovery.SUBSCRIBERS_REP,
                    self._about_subscriber(each.name, each.node_uuid, each.type_name),
                )
        else:
            super().handle(message, source_ip)

    def handle_other(self, message: Discovery) -> None:
        """Update the tables of subscribers."""
        record, key = message.pub, (message.pub.process_uuid, message.pub.node_uuid)
        if message.type == Discovery.SUBSCRIBERS_REP:
            with self._table_lock:
                self._listed_bytes += record.ByteSize()
                if self._listed_bytes <= _MOST_LISTED_BYTES:
                    self._listed.setdefault(record.topic, {})[key] = record
                    self._with_subscribers.add(record.process_uuid)
        elif message.type == Discovery.NEW_CONNECTION and record.msg_pub.ctrl == self.process_uuid:
            if not any(True for _ in self._own(record.topic)):
                return
            with self._table_lock:
                group = self._connected.setdefault(record.topic, {})
                group.pop(key, None)
                if len(group) >= _MOST_SUBSCRIBERS:
                    del group[next(iter(group))]
                group[key] = record.msg_pub.msg_type
                self._with_subscribers.add(record.process_uuid)
            self._on_subscribers()
        elif message.type == Discovery.END_CONNECTION and record.msg_pub.ctrl in (self.process_uuid, ""):
            with self._table_lock:
                _drop(self._connected, record.topic, key)
                _drop(self._listed, record.topic, key)
            self._on_subscribers()

    def forget_subscribers_of(self, process_uuid: str) -> None:
        """Forget the subscribers of a process that has ended."""
        if process_uuid not in self._with_subscribers:
            return
        tables: tuple[dict[str, dict[SubscriberKey, Any]], ...] = (self._connected, self._listed)
        with self._table_lock:
            for table in tables:
                for topic in list(table):
                    for key in [key for key in table[topic] if key[0] == process_uuid]:
                        _drop(table, topic, key)
            self._with_subscribers.discard(process_uuid)
        self._on_subscribers()


def _drop(table: dict[str, dict[SubscriberKey, Any]], topic: str, key: SubscriberKey) -> None:
    group = table.get(topic, {})
    group.pop(key, None)
    if not group:
        table.pop(topic, None)
