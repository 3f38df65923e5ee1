"""Monitor of one process of the submission: counts messages, knows the endpoints, holds messages back, and reports.

The patches in `rclpy_7_1.py` call it. Each time an executor is about to go idle it sends a report:

    {"clock": ns, "idle": true, "taken": {topic: n}, "published": {topic: n}, "delivered": {topic: n},
     "holding": true, "held": n, "released": n, "flushes": n, "logged": n, "endpoints": [...]}

`endpoints` is included only when it changed; `clock` is the smallest simulated time [ns] of all spinning nodes; `taken`
and `published` count messages since the start, the latter only while there were subscribers, and `delivered` the number
of readers they had; `logged` counts messages on /rosout. Requests and responses count as messages on "request NAME" and
"response NAME". When `flushes` grows, the process waits for an answer before it destroys a publisher. `again` names the
topics on which the grader has announced to send a message once more; copies are dropped (`rclpy_7_1.py`). The grader
advances simulated time only when these numbers show that every message was taken.

Messages between several processes would be a race. After the order `hold` a process therefore queues what it sends, and
each order `release` lets one message leave: at any moment one message is in transit in the whole system. The order
`free` ends that.
"""

from __future__ import annotations

import contextlib
import json
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from typing import Any

from . import grader_requests
from .channel import Channel

TOPICS = "COURSE_TOPICS"
RELIABLE = "reliable"  # kind in TOPICS: what the grader publishes reliably
HOLD = "COURSE_HOLD"
UNMATCHED_SLICE = 0.005  # [s] between two looks at an unmatched publisher; DDS gives no event we could wait for
POOL_SLICE = 0.001  # [s] between two looks at a running pool callback, in case its end does not wake us
MOST_LOGGED = 50  # messages on /rosout that are under way
LOG_PATIENCE = 30.0  # [s] for the grader to receive them; it may be starting up
FLUSH_PATIENCE = 10.0  # [s] for the grader to receive the last messages before a publisher is destroyed
MATCH_PATIENCE = 5.0  # [s] after which a publisher counts as unmatched
SERVICE_PATIENCE = 1.0  # [s] for a service to be found before a request is sent
HOUSEKEEPING = ("/rosout", "/parameter_events")  # topics of every node, which lock-step ignores


class ExecutorMonitor:
    """Counts what one process publishes and takes, and reports it whenever its executors go idle."""

    def __init__(self, way: Channel, topics: dict[str, dict[str, str]], holding: bool) -> None:
        self._channel = way
        self._topics = topics  # topics on which the grader has an endpoint: kind of our endpoint -> topic -> ROS type
        self.taken: Counter[str] = Counter()
        self.published: Counter[str] = Counter()
        self.delivered: Counter[str] = Counter()
        self.logged = 0  # messages sent to /rosout
        self._confirmed = 0  # of those: known to have arrived, or waited for in vain
        self._log_confirmed = threading.Event()
        self._held: deque[Callable[[], None]] = deque()
        self._holding = holding
        self._released = 0
        self.blocked_threads = 0  # threads that wait in Client.call
        self._lock = threading.RLock()
        self._answered = threading.Event()
        self.clock_seen: dict[int, int] = {}  # id(TimeSource) -> [ns]
        self.waiting: dict[int, bool] = {}  # id(executor) -> whether it waits
        self._nodes: dict[int, Any] = {}
        self._topic_of: dict[int, str] = {}  # id(subscription) -> topic; asking rcl each time is slow
        self._layout: tuple[Any, ...] = ()
        self._endpoints: list[dict[str, Any]] = []
        self._reported_endpoints: list[dict[str, Any]] = []
        self._unmatched_since: dict[tuple[str, str], float] = {}
        self._awaited: set[int] = set()  # id(publisher) of those whose match was awaited
        self._last_report = ""
        self.again: set[str] = set()  # topics on which the grader may send a message twice
        self._flushes = 0
        self._flushed = -1  # what had been sent when the last flush was answered

    def listen(self) -> None:
        """Start to obey the grader's orders."""
        self._channel.listen(self._obey)

    @property
    def holds(self) -> bool:
        """Whether sent messages are queued until the grader releases them."""
        return self._holding and self._channel.open

    def count(self, counter: Counter[str], name: str, number: int = 1) -> None:
        """Add to one of the counters; thread-safe."""
        with self._lock:
            counter[name] += number

    def hold(self, send: Callable[[], None]) -> None:
        """Queue a message to be sent, or send it at once if holding is off."""
        if not self.holds:
            send()
            return
        self._held.append(send)
        if all(self.waiting.values()):  # sent by a thread of its own, so no executor will report it
            self.report()

    def count_log(self) -> None:
        """Count a message that was sent to /rosout. After `MOST_LOGGED`, wait until they have arrived.

        /rosout keeps the last 100 messages only, for a reader that is not found yet or has missed some.
        """
        with self._lock:
            self.logged += 1
            full = self.logged - self._confirmed >= MOST_LOGGED
            if full:
                self._confirmed = self.logged
        if full and self._channel.open:
            self._log_confirmed.clear()
            self._channel.send({"logged": self.logged})
            self._log_confirmed.wait(LOG_PATIENCE)

    @contextlib.contextmanager
    def blocked(self) -> Iterator[None]:
        """Count a thread that waits for a response, and so the callback it runs, as idle."""
        with self._lock:
            self.blocked_threads += 1
        try:
            yield
        finally:
            with self._lock:
                self.blocked_threads -= 1

    def await_service(self, client: Any) -> None:
        """Wait until discovery has found a service before a request is sent, at most for `SERVICE_PATIENCE`."""
        deadline = time.monotonic() + SERVICE_PATIENCE
        while not client.service_is_ready() and time.monotonic() < deadline:
            threading.Event().wait(UNMATCHED_SLICE)

    def _obey(self, order: dict[str, Any] | None) -> None:
        """Carry out an order of the grader; None means that the grader is gone. Called in a thread."""
        if grader_requests.hear(order) and order is not None:
            return
        if order is None:
            self._let_go()
            self._answered.set()
            self._log_confirmed.set()
        elif "arrived" in order:
            self._answered.set()
        elif "logs_arrived" in order:
            self._log_confirmed.set()
        elif "hold" in order:
            self._holding = True
            self.report()
        elif "free" in order:
            self._let_go()
        elif "release" in order:
            self._send_next()
            self.report()
        elif "again" in order:
            self.again.add(order["again"])
            self.report()
        elif "look" in order:
            with self._lock:
                self._layout = ()
                self._refresh_endpoints()
            self.report()

    def _let_go(self) -> None:
        self._holding = False
        while self._held:
            self._send_next()

    def _send_next(self) -> None:
        with contextlib.suppress(IndexError):
            send = self._held.popleft()
            with contextlib.suppress(Exception):  # its publisher may be destroyed already, as in a process that ends
                send()
        self._released += 1

    def await_match(self, publisher: Any) -> None:
        """Delay the first message of a publisher until the grader subscribes, so that discovery loses none.

        Simulated time stands still meanwhile. A publisher that cannot match (because of its QoS) is delayed for
        `MATCH_PATIENCE` only. rclpy offers the matched event only through an executor, so this looks repeatedly.
        """
        if id(publisher) in self._awaited:
            return
        self._awaited.add(id(publisher))
        endpoint = self._describe("", "publisher", publisher, 0)
        if not self._is_met(endpoint):
            return
        deadline = time.monotonic() + MATCH_PATIENCE
        while not publisher.get_subscription_count() and time.monotonic() < deadline:
            threading.Event().wait(UNMATCHED_SLICE)

    def _is_met(self, endpoint: dict[str, Any]) -> bool:
        """Return whether the grader has the opposite endpoint, of the same type and with compatible QoS."""
        met = self._topics.get(endpoint["kind"], {})
        return met.get(endpoint["topic"]) == endpoint["type"] and qos_can_match(**endpoint)

    def sent_reliably(self, topic: str, kind: str) -> bool:
        """Return whether the grader publishes messages of a type on a topic, and reliably."""
        return self._topics.get(RELIABLE, {}).get(topic) == kind

    def topic_of(self, endpoint: Any) -> str:
        """Return the resolved topic name of a publisher or subscription."""
        topic = self._topic_of.get(id(endpoint))
        if topic is None:
            topic = self._topic_of[id(endpoint)] = endpoint.topic_name
        return topic

    def executor_idle(self, executor: Any) -> float | None:
        """Report if every executor is idle; return how long the coming wait may last [s] (None: for ever)."""
        with self._lock:
            self.waiting[id(executor)] = True
            for node in executor.get_nodes():
                self._nodes[id(node)] = node
            self._refresh_endpoints()
            if all(self.waiting.values()):
                self.report()
        return UNMATCHED_SLICE if self._impatient() else None

    def _impatient(self) -> bool:
        """Return whether an endpoint may still be about to match."""
        now = time.monotonic()
        return any(now - since < MATCH_PATIENCE for since in self._unmatched_since.values())

    def _refresh_endpoints(self) -> None:
        layout = tuple((key, len(n._publishers), len(n._subscriptions)) for key, n in self._nodes.items())
        if layout == self._layout and not self._impatient():
            return
        if layout != self._layout:
            self._topic_of.clear()  # ids of destroyed endpoints may be used again
        self._layout = layout
        self._endpoints = []
        for node in self._nodes.values():
            name = node.get_fully_qualified_name()
            for publisher in list(node.publishers):
                matched = publisher.get_subscription_count()
                self._endpoints.append(self._describe(name, "publisher", publisher, matched))
            for subscription in list(node.subscriptions):
                matched = subscription.get_publisher_count()
                self._endpoints.append(self._describe(name, "subscription", subscription, matched))
        now = time.monotonic()
        waiting = [(e["kind"], e["topic"]) for e in self._endpoints if not e["matched"] and self._is_met(e)]
        self._unmatched_since = {key: self._unmatched_since.get(key, now) for key in waiting}

    def _describe(self, node: str, kind: str, endpoint: Any, matched: int) -> dict[str, Any]:
        qos = endpoint.qos_profile
        return {
            "node": node,
            "kind": kind,
            "topic": self.topic_of(endpoint),
            "type": type_name(endpoint.msg_type),
            "reliability": qos.reliability.name,
            "durability": qos.durability.name,
            "matched": matched,
        }

    def flush(self) -> None:
        """Wait until the grader has received everything published so far, or for `FLUSH_PATIENCE`."""
        sent = self._sent()
        if not self._channel.open or (sent == self._flushed and not self._held):
            return
        self._answered.clear()
        self._flushes += 1
        self.report(flushing=True)
        if self._answered.wait(FLUSH_PATIENCE):
            self._flushed = self._sent()
        while self._held:  # not released by the grader in time
            self._send_next()

    def _sent(self) -> int:
        return self._released + self.published.total() + self.delivered.total() + self.logged

    def report(self, flushing: bool = False) -> None:
        """Send the counts if they changed since the last report."""
        with self._lock:
            spinning = [n._time_source for n in self._nodes.values() if n._time_source.ros_time_is_active]
            report: dict[str, Any] = {
                "clock": min((self.clock_seen.get(id(s), 0) for s in spinning), default=None),
                "idle": flushing or all(self.waiting.values()),
                "taken": self.taken,
                "published": self.published,
                "delivered": self.delivered,
                "holding": self._holding,
                "held": len(self._held),
                "released": self._released,
                "flushes": self._flushes,
                "logged": self.logged,
            }
            if self.again:
                report["again"] = sorted(self.again)
            if self._endpoints != self._reported_endpoints:
                report["endpoints"] = self._reported_endpoints = self._endpoints
            text = json.dumps(report)
            if text != self._last_report:
                self._last_report = text
                self._channel.send_text(text)


def type_name(kind: Any) -> str:
    """Return the ROS type of a class of messages, such as `geometry_msgs/msg/Twist`."""
    return f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"


def qos_can_match(kind: str, reliability: str, durability: str, **_: Any) -> bool:
    """Return whether an endpoint's QoS is compatible with the grader's: reliable and volatile, as in ros_gz_bridge.

    A best-effort publisher does not match a reliable subscription, nor a transient-local subscription a volatile
    publisher.

    Source: ROS 2 documentation, "Quality of Service settings", section "QoS compatibilities".
    """
    return reliability != "BEST_EFFORT" if kind == "publisher" else durability != "TRANSIENT_LOCAL"
