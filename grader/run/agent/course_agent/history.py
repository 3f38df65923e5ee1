"""What the publishers of this process keep for those who join late, and which of its subscriptions ask for that.

DDS hands it over when the two are connected, whatever the time is. The grader computes from these numbers how many
messages every subscription will get, and lets simulated time stand still until it has taken them (`late_joiners.py`).
Only reliable endpoints count: to others nothing is handed over again. A subscription gets all that is kept, one after
the other; its own depth does not matter, because it takes each as it comes (`rclpy_7_1.py`).

Source: DDS 1.4, 2.2.3.4 DURABILITY and 2.2.3.18 HISTORY.
"""

from __future__ import annotations

import _thread
from collections import Counter
from collections.abc import Callable, Iterable
from typing import Any

from .endpoint_description import type_name

ALL = 1 << 30  # the depth of an endpoint that keeps all


class History:
    """Counts by `TOPIC TYPE` what is kept and asked for; `topic_of(endpoint)` is its resolved topic. Thread-safe."""

    def __init__(self, topic_of: Callable[[Any], str]) -> None:
        self._topic_of = topic_of
        self._lock = _thread.allocate_lock()
        self._kept: Counter[str] = Counter()
        self._asked: Counter[str] = Counter()

    def count(self, publisher: Any) -> None:
        """Count a message that was published."""
        depth = getattr(publisher, "course_keeps", None)
        if depth is None:
            depth = publisher.course_keeps = kept_depth(publisher.qos_profile)
            publisher.course_kept = 0
        if publisher.course_kept < depth:
            with self._lock:
                publisher.course_kept += 1
                self._kept[self._key(publisher)] += 1

    def look(self, nodes: Iterable[Any]) -> None:
        """Look at the endpoints anew, because some have come or gone."""
        with self._lock:
            self._kept.clear()
            self._asked.clear()
            for node in nodes:
                for publisher in list(node.publishers):
                    if kept_depth(publisher.qos_profile):  # who keeps nothing yet is known from now on
                        self._kept[self._key(publisher)] += getattr(publisher, "course_kept", 0)
                for subscription in list(node.subscriptions):
                    if kept_depth(subscription.qos_profile):
                        self._asked[self._key(subscription)] += 1

    def _key(self, endpoint: Any) -> str:
        return f"{self._topic_of(endpoint)} {type_name(endpoint.msg_type)}"

    def report(self) -> dict[str, Any]:
        """Return its part of a report."""
        with self._lock:
            kept, asked = dict(self._kept), dict(self._asked)
        return ({"kept": kept} if kept else {}) | ({"asked": asked} if asked else {})


def kept_depth(qos: Any) -> int:
    """Return how many messages a publisher keeps for those who join late; 0 if a subscription does not ask for them."""
    if qos.durability.name != "TRANSIENT_LOCAL" or qos.reliability.name == "BEST_EFFORT":
        return 0
    return ALL if qos.history.name == "KEEP_ALL" else max(1, qos.depth)
