"""The publishers, subscriptions and services of this process.

A publisher finds the subscriptions of its process here; the network uses the table for announcements and for the
delivery of received messages. Publishers stand here as their `Advertisement`. Readers get immutable tuples and need no
lock.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

from gz_course.sim.gz.transport.advertisement import Advertisement
from gz_course.sim.gz.transport.options import Scope
from gz_course.sim.gz.transport.subscription import Subscription

if TYPE_CHECKING:
    from gz_course.sim.gz.transport.service import Service


class Switchboard:
    """Publishers, subscriptions and services by fully qualified name; thread-safe."""

    def __init__(self) -> None:
        self._changed = threading.Condition(threading.Lock())
        self._subscriptions: dict[str, tuple[Subscription, ...]] = {}
        self._networked: dict[str, tuple[Subscription, ...]] = {}
        self._publishers: dict[str, tuple[Advertisement, ...]] = {}
        self._services: dict[str, tuple[Service, ...]] = {}
        self.version = object()
        """Another object after every change of the subscriptions, here or in other processes."""

    def subscriptions(self, name: str) -> tuple[Subscription, ...]:
        """Return the subscriptions of a topic, oldest first."""
        return self._subscriptions.get(name, ())

    def publishers(self, name: str) -> tuple[Advertisement, ...]:
        """Return the publishers of a topic, oldest first."""
        return self._publishers.get(name, ())

    def all_subscriptions(self) -> list[Subscription]:
        with self._changed:
            return [each for group in self._subscriptions.values() for each in group if each.active]

    def all_publishers(self) -> list[Advertisement]:
        with self._changed:
            return [each for group in self._publishers.values() for each in group if each.open]

    def networked_subscriptions(self, name: str) -> tuple[Subscription, ...]:
        """Return the subscriptions of a topic whose scope includes other processes."""
        return self._networked.get(name, ())

    def networked_publishers(self, name: str) -> tuple[Advertisement, ...]:
        """Return the publishers of a topic whose scope includes other processes."""
        return tuple(each for each in self.publishers(name) if each.open and each.scope != Scope.PROCESS)

    def add_subscription(self, subscription: Subscription) -> None:
        with self._changed:
            self._set_subscriptions(subscription.name, (*self.subscriptions(subscription.name), subscription))
            self.version = object()
            self._changed.notify_all()

    def remove_subscription(self, subscription: Subscription) -> None:
        """Remove a subscription; messages in transit are not delivered to it."""
        subscription.active = False
        with self._changed:
            group = self.subscriptions(subscription.name)
            self._set_subscriptions(subscription.name, tuple(each for each in group if each is not subscription))
            self.version = object()
            self._changed.notify_all()

    def _set_subscriptions(self, name: str, group: tuple[Subscription, ...]) -> None:
        networked = tuple(each for each in group if each.scope != Scope.PROCESS)
        for table, part in ((self._subscriptions, group), (self._networked, networked)):
            if part:
                table[name] = part
            else:
                table.pop(name, None)

    def add_publisher(self, publisher: Advertisement) -> None:
        """Add a publisher. Raises ValueError if its node already has one on this topic."""
        with self._changed:
            group = self._publishers.get(publisher.name, ())
            if any(each.open and each.node_uuid == publisher.node_uuid for each in group):
                raise ValueError(
                    f"The topic {publisher.topic!r} is already advertised by this node: "
                    "one node may advertise a topic once; use the publisher it returned, or close it first."
                )
            self._publishers[publisher.name] = (*group, publisher)

    def remove_publisher(self, publisher: Advertisement) -> None:
        with self._changed:
            group = self._publishers.get(publisher.name, ())
            rest = tuple(each for each in group if each is not publisher)
            if rest:
                self._publishers[publisher.name] = rest
            else:
                self._publishers.pop(publisher.name, None)
            self._changed.notify_all()

    def services(self, name: str) -> tuple[Service, ...]:
        """Return the services of a name, oldest first."""
        return self._services.get(name, ())

    def all_services(self) -> list[Service]:
        with self._changed:
            return [each for group in self._services.values() for each in group]

    def add_service(self, service: Service) -> None:
        """Add a service. Raises ValueError if its node already offers one of this name."""
        with self._changed:
            group = self._services.get(service.name, ())
            if any(each.node_uuid == service.node_uuid for each in group):
                raise ValueError(
                    f"The service {service.topic!r} is already offered by this node: "
                    "one node may offer a service once; use unadvertise_service() first."
                )
            self._services[service.name] = (*group, service)

    def remove_service(self, service: Service) -> None:
        with self._changed:
            rest = tuple(each for each in self._services.get(service.name, ()) if each is not service)
            if rest:
                self._services[service.name] = rest
            else:
                self._services.pop(service.name, None)

    def notify(self) -> None:
        """Wake all callers of wait_for(), because state outside this table has changed."""
        self.version = object()
        with self._changed:
            self._changed.notify_all()

    def wait_for(self, condition: Callable[[], bool], timeout: float) -> bool:
        """Wait until `condition()` is true, at most `timeout` [s]; return whether it is."""
        with self._changed:
            return self._changed.wait_for(condition, timeout)

    def hold_for_fork(self) -> None:
        """Lock the table while the process is forked."""
        self._changed.acquire()

    def release_after_fork(self) -> None:
        self._changed.release()

    def renew_after_fork(self) -> None:
        """Give the forked child, which keeps the table, a new lock."""
        self._changed = threading.Condition(threading.Lock())
        self.version = object()


SWITCHBOARD = Switchboard()
os.register_at_fork(
    before=SWITCHBOARD.hold_for_fork,
    after_in_parent=SWITCHBOARD.release_after_fork,
    after_in_child=SWITCHBOARD.renew_after_fork,
)
