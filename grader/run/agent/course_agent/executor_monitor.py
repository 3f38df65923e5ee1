"""Monitor of one process of the submission: counts messages, knows the endpoints, holds messages back, and reports.

The patches in `rclpy_7_1.py` call it. Each time the last thread that was at work begins to wait it sends a report:

    {"clock": ns, "idle": true, "taken": {topic: n}, "published": {topic: n}, "delivered": {topic: n},
     "holding": true, "held": n, "released": n, "flushes": n, "spun": true, "woken": n, "logged": n,
     "endpoints": [...]}

`endpoints` is included only when it changed; `clock` is the smallest simulated time [ns] of all nodes; `taken` and
`published` count messages since the start, the latter only while there were subscribers, and `delivered` the number of
readers they had; `logged` counts messages on /rosout. Requests and responses count as messages on "request NAME" and
"response NAME". When `flushes` grows, the process waits for an answer before it destroys a publisher. `again` names the
topics on which the grader has announced to send a message once more; copies are dropped (`rclpy_7_1.py`). `wakes` is
the simulated time [ns] at which the first sleeper is due, `woken` how many orders to wake one were carried out
(`thread_monitor.py`). `blocked` says that a node cannot take messages at the moment; the order `take` has them taken
(`inbox.py`). The grader advances simulated time only when these numbers show that every message was taken.

A publisher is found by others while its process waits, and simulated time stands still for that. What it publishes
before the first wait after its creation is lost, as it is when nobody has discovered it yet; `lost` counts that. DDS
keeps it for late joiners if the publisher is transient local; the grader ignores what is older than `found_at`.

Messages between several processes would be a race. After the order `hold` a process therefore queues what it sends, and
each order `release` lets one message leave: at any moment one message is in transit in the whole system. The order
`free` ends that.
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
from collections import Counter
from collections.abc import Callable
from typing import Any

from . import grader_requests, other_domains
from .channel import Channel
from .endpoint_description import KEPT, described, qos_can_match
from .held_messages import HeldMessages
from .history import History
from .inbox import blocked, fill, is_copy
from .patience import await_found, await_signal
from .signals import Signal
from .thread_monitor import ThreadMonitor, monotonic, time_ns

TOPICS = "COURSE_TOPICS"
RELIABLE = "reliable"  # kind in TOPICS: what the grader publishes reliably
HOLD = "COURSE_HOLD"
# Environment variable that lets sleeping take simulated time: how much of it passes in a second of the clocks.
SIMULATED_CLOCKS = "COURSE_SIMULATED_CLOCKS"
MOST_LOGGED = 50  # messages on /rosout that are under way
# [s] of the run's clock: for the grader to receive them, which may be starting up; for it to receive the last messages
# before a publisher is destroyed; and for a publisher to be matched before it publishes.
LOG_PATIENCE, FLUSH_PATIENCE, MATCH_PATIENCE = 30.0, 10.0, 5.0
LOOKING = 5.0  # [s] for which a process looks by itself whether an endpoint has matched; the grader asks for longer
NEVER = 1 << 62  # [ns] of real time
HOUSEKEEPING = ("/rosout", "/parameter_events")  # topics of every node, which lock-step ignores


class ExecutorMonitor:
    """Counts what one process publishes and takes, and reports it whenever its executors go idle."""

    def __init__(self, way: Channel, topics: dict[str, dict[str, str]], holding: bool) -> None:
        self._channel = way
        self.threads = ThreadMonitor()
        self.threads.on_idle = self.report
        self._topics = topics  # topics on which the grader has an endpoint: kind of our endpoint -> topic -> ROS type
        self.taken: Counter[str] = Counter()
        self.published: Counter[str] = Counter()
        self.delivered: Counter[str] = Counter()
        self.logged = 0  # messages sent to /rosout
        self._confirmed = 0  # of those: known to have arrived, or waited for in vain
        self._log_confirmed = Signal()
        self._held = HeldMessages(holding)
        self.lost: Counter[str] = Counter()
        # Topics whose early messages DDS keeps for late joiners: when their publishers were found, in real time [ns].
        self._found_at: dict[str, int] = {}
        self.spun = False  # whether an executor has waited
        self._lock = threading.RLock()
        self._answered = Signal()
        self._told_time = Signal()
        self.clock_seen: dict[int, int] = {}  # id(TimeSource) -> [ns]
        self._nodes: dict[int, Any] = {}
        self._topic_of: dict[int, str] = {}  # id(subscription) -> topic; asking rcl each time is slow
        self.history = History(self.topic_of)
        self._layout: tuple[Any, ...] = ()
        self._endpoints: list[dict[str, Any]] = []
        self._reported_endpoints: list[dict[str, Any]] = []
        self._unmatched_since: dict[tuple[str, str], float] = {}
        self._found: tuple[Any, ...] = ()  # the layout at the last wait
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
        return self._held.holding and self._channel.open

    def count(self, counter: Counter[str], name: str, number: int = 1) -> None:
        """Add to one of the counters; thread-safe."""
        with self._lock:
            counter[name] += number

    def hold(self, send: Callable[[], None], may_leave: Callable[[float], bool] = lambda now: True) -> None:
        """Queue a message to be sent, once `may_leave` at a time [s] of the run; send it at once if holding is off."""
        if not self.holds:
            send()
            return
        self._held.add(send, may_leave)
        if self.threads.idle:  # sent by a thread that is not watched, so nobody will report it
            self.report()

    def count_log(self) -> None:
        """Count a message that was sent to /rosout, which keeps the last 100; after `MOST_LOGGED`, wait for them."""
        with self._lock:
            self.logged += 1
            full = self.logged - self._confirmed >= MOST_LOGGED
            if full:
                self._confirmed = self.logged
        if full and self._channel.open:
            self._log_confirmed.clear()
            self._channel.send({"logged": self.logged})
            await_signal(self.threads, self._log_confirmed, LOG_PATIENCE)

    def _obey(self, order: dict[str, Any] | None) -> None:
        """Carry out an order of the grader; None means that the grader is gone. Called in a thread."""
        if grader_requests.hear(order) and order is not None:
            return
        if order is None:
            self._held.let_go()
            self.threads.release_all()
            for each in (self._answered, self._log_confirmed, self._told_time):
                each.set()
        elif "now" in order:
            self.threads.tell(order["now"])
            self._told_time.set()
        elif "wake" in order:
            self.threads.wake(order["wake"], every="every" in order)
            self.report()
        elif "take" in order:
            self._take()
            self.report()
        elif "strays" in order or "ping" in order:
            alive = threading.enumerate()
            self.threads.look_for_strays({t.ident: t.native_id for t in alive if t.ident and t.native_id})
            self.report()
        elif "arrived" in order:
            self._answered.set()
        elif "logs_arrived" in order:
            self._log_confirmed.set()
        elif "hold" in order:
            self._held.holding = True
            self.report()
        elif "free" in order:
            self._held.let_go()
            if "real" in order:
                self.threads.release_all()
        elif "release" in order:
            self._held.release(order["release"])
            self.report()
        elif "again" in order:
            self.again.add(order["again"])
            self.report()
        elif "look" in order:
            with self._lock:
                self._layout = ()
                self._refresh_endpoints()
            self.report()

    def await_match(self, publisher: Any) -> bool:
        """Return whether a publisher has been found by others; False while its process has not waited since it is.

        Simulated time stood still while it was matched on the grader's side, and here it is matched at the latest now:
        a publisher that cannot match (because of its QoS) is delayed for `MATCH_PATIENCE`, once. rclpy offers the
        matched event only through an executor, so this looks repeatedly.
        """
        found = getattr(publisher, "course_found", None)
        if found is None:
            return False
        if found == "awaited":
            return True
        publisher.course_found = "awaited"
        if self._is_met(described("", "publisher", self.topic_of(publisher), publisher, 0)):
            await_found(self.threads, lambda: self._channel.open, publisher.get_subscription_count, MATCH_PATIENCE)
        return True

    def add_node(self, node: Any) -> None:
        """Watch a new node. With the first one, sleeping begins to take simulated time."""
        self.threads.prepare()  # it may have waited unseen, such as for a file
        with self._lock:
            self._nodes[id(node)] = node
        rate = os.environ.get(SIMULATED_CLOCKS)
        if rate and not self.threads.simulated and self._channel.open:
            self._channel.send({"clock": True})
            with self.threads.at_work():
                self._told_time.wait(None)
            if self._channel.open:
                self.threads.start(self.threads.now_ns, float(rate))

    def remove_node(self, node: Any) -> None:
        """Do not watch a node any more that is destroyed."""
        with self._lock:
            self._nodes.pop(id(node), None)

    def announce_early(self, topic: str) -> None:
        """Tell the grader that what comes on a topic is none of its own until the process has waited."""
        with self._lock:
            self._found_at[topic] = NEVER
        self.report()

    @property
    def nodes(self) -> list[Any]:
        """The nodes of this process."""
        return list(self._nodes.values())

    def local_subscriptions(self, topic: str) -> list[Any]:
        """Return the subscriptions of this process to a topic."""
        return [s for n in self.nodes for s in list(n.subscriptions) if self.topic_of(s) == topic]

    def executor_of(self, entity: Any) -> Any:
        """Return the executor that looks at a subscription or guard condition; None if there is none."""
        for node in self.nodes:
            if entity in node._subscriptions or entity in node._guards:
                return node.executor
        return None

    def _take(self) -> None:
        """Take the messages that no executor can take at the moment."""
        with self._lock, self.threads.lock:
            if not self.threads.idle:
                return
            for kind, entity in list(blocked(self._nodes.values())):
                with contextlib.suppress(Exception):  # destroyed meanwhile
                    if kind == "action":
                        entity.course_take_all()
                    else:
                        fill(kind, entity, getattr(self, f"_took_{kind}"))

    def _took_subscription(self, subscription: Any, item: Any) -> bool:
        topic = self.topic_of(subscription)
        if is_copy(subscription, item[0]) and topic in self.again:
            return False
        self.count(self.taken, topic)
        for node in self._nodes.values():
            if node._time_source._clock_sub is subscription:
                self.saw_clock(node._time_source, item[0])
        return True

    def _took_service(self, service: Any, item: Any) -> bool:
        self.count(self.taken, f"request {service.service_name}")
        return True

    def _took_client(self, client: Any, item: Any) -> bool:
        self.count(self.taken, f"response {client.service_name}")
        return True

    def saw_clock(self, source: Any, message: Any) -> None:
        """Note the simulated time that a node has got."""
        now = message.clock.sec * 1_000_000_000 + message.clock.nanosec
        self.clock_seen[id(source)] = max(now, self.clock_seen.get(id(source), 0))
        if self.threads.simulated:
            self.threads.tell(now)

    def _is_met(self, endpoint: dict[str, Any]) -> bool:
        """Return whether the grader has the opposite endpoint, of the same type and with compatible QoS."""
        met, kept = self._topics.get(endpoint["kind"], {}), endpoint["topic"] in self._topics.get(KEPT, {})
        return met.get(endpoint["topic"]) == endpoint["type"] and qos_can_match(**endpoint, kept=kept)

    def sent_reliably(self, topic: str, kind: str) -> bool:
        """Return whether the grader publishes messages of a type on a topic, and reliably."""
        return self._topics.get(RELIABLE, {}).get(topic) == kind

    def topic_of(self, endpoint: Any) -> str:
        """Return the resolved topic name of a publisher or subscription, with its domain if that is another one."""
        topic = self._topic_of.get(id(endpoint))
        if topic is None:
            topic = self._topic_of[id(endpoint)] = endpoint.topic_name + other_domains.of(endpoint)
        return topic

    def impatient(self) -> bool:
        """Return whether an endpoint may still be about to match."""
        now = monotonic()
        return any(now - since < LOOKING for since in self._unmatched_since.values())

    def _now(self) -> tuple[Any, ...]:
        """Return a value that changes when an endpoint comes or goes."""
        return tuple((key, *map(id, n._publishers), *map(id, n._subscriptions)) for key, n in self._nodes.items())

    def _refresh_endpoints(self) -> None:
        layout = self._now()
        if layout == self._layout and not self.impatient():
            return
        if layout != self._layout:
            self._topic_of.clear()  # ids of destroyed endpoints may be used again
        self._layout = layout
        self._endpoints = []
        for node in self._nodes.values():
            name = node.get_fully_qualified_name()
            for publisher in list(node.publishers):
                matched = publisher.get_subscription_count()
                self._endpoints.append(described(name, "publisher", self.topic_of(publisher), publisher, matched))
            for subscription in list(node.subscriptions):
                matched = subscription.get_publisher_count()
                self._endpoints.append(
                    described(name, "subscription", self.topic_of(subscription), subscription, matched)
                )
        self.history.look(self._nodes.values())
        now = monotonic()
        waiting = [(e["kind"], e["topic"]) for e in self._endpoints if not e["matched"] and self._is_met(e)]
        self._unmatched_since = {key: self._unmatched_since.get(key, now) for key in waiting}

    def flush(self) -> None:
        """Wait until the grader has received everything published so far, or for `FLUSH_PATIENCE`."""
        sent = self._sent()
        if not self._channel.open or (sent == self._flushed and not self._held):
            return
        self._answered.clear()
        self._flushes += 1
        self.report(flushing=True)
        if await_signal(self.threads, self._answered, FLUSH_PATIENCE):
            self._flushed = self._sent()
        self._held.send_all()  # not released by the grader in time
        self.report()  # it is at work again: simulated time stands still until it waits or is gone

    def _sent(self) -> int:
        return self._held.released + self.published.total() + self.delivered.total() + self.logged

    def report(self, flushing: bool = False) -> None:
        """Send the counts if they changed since the last report."""
        with self._lock:
            idle = self.threads.idle
            if idle or flushing:
                self._refresh_endpoints()
            if idle and self._found != self._layout:
                self._found = self._layout
                self._found_at = {topic: min(at, time_ns()) for topic, at in self._found_at.items()}
                for publisher in [p for n in self._nodes.values() for p in n.publishers]:
                    publisher.course_found = getattr(publisher, "course_found", "found")
            sources = [n._time_source for n in self._nodes.values() if other_domains.follows_clock(n)]
            report: dict[str, Any] = {
                "clock": min((self.clock_seen.get(id(s), 0) for s in sources), default=None),
                "idle": flushing or idle,
                "taken": self.taken,
                "published": self.published,
                "delivered": self.delivered,
                "holding": self._held.holding,
                "held": len(self._held),
                "released": self._held.released,
                "flushes": self._flushes,
                "logged": self.logged,
                "spun": self.spun,
                "woken": self.threads.woken,
            }
            if (wakes := self.threads.wakes_ns) is not None and self.threads.simulated:
                report["wakes"] = wakes
            if idle and any(True for _ in blocked(self._nodes.values())):
                report["blocked"] = True
            report |= self.history.report()
            if self.lost:
                report["lost"] = self.lost
            if self._found_at:
                report["found_at"] = self._found_at
            if self.again:
                report["again"] = sorted(self.again)
            if self._endpoints != self._reported_endpoints:
                report["endpoints"] = self._reported_endpoints = self._endpoints
            text = json.dumps(report)
            if text != self._last_report:
                self._last_report = text
                self._channel.send_text(text)
