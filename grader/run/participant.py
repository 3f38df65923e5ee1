"""Runs a student's file unmodified and tells the grader when its node has nothing left to do.

This file is started as a script, in the student's own process, by `grader.run.student`; it imports nothing of
ours. It watches three places in rclpy (the executor's wait, every publish, every take) and then runs the file as
`__main__`. Each time an executor is about to go to sleep it sends one report over an inherited socket:

    {"clock": ns, "taken": {topic: n}, "published": {topic: n}, "endpoints": [...]}

`endpoints` is there only when it changed; `clock` is the smallest simulated time any spinning node has been told, `taken` and `published` count messages
since the start. The grader advances simulated time only when those numbers show that everything it sent was
taken. Nothing here is trusted: a process that lies about itself only spoils its own run.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import runpy
import signal
import socket
import sys
import threading
import time
import traceback
from collections import Counter
from pathlib import Path
from typing import Any

PR_SET_PDEATHSIG = 1
SOCKET_FD = "COURSE_PARTICIPANT_FD"
LISTENED = "COURSE_LISTENED_TOPICS"
UNMATCHED_SLICE = 0.005  # [s] how often an unmatched publisher is looked at; DDS gives no event we could wait for
MATCH_PATIENCE = 2.0  # [s] after that a publisher nobody matches is simply unmatched


class Watch:
    """Counts what one process publishes and takes, and reports it whenever its executors go idle."""

    def __init__(self, channel: socket.socket, listened: dict[str, str]) -> None:
        self._channel = channel
        self._listened = listened  # topic -> ROS type the grader subscribes to
        self._taken: Counter[str] = Counter()
        self._published: Counter[str] = Counter()
        self._clock_seen: dict[int, int] = {}  # id(TimeSource) -> ns
        self._waiting: dict[int, bool] = {}  # id(executor) -> is asleep in its wait
        self._nodes: dict[int, Any] = {}
        self._topic_of: dict[int, str] = {}  # id(subscription) -> topic; asking rcl each time is slow
        self._layout: tuple[Any, ...] = ()
        self._endpoints: list[dict[str, Any]] = []
        self._reported_endpoints: list[dict[str, Any]] = []
        self._unmatched_since: dict[str, float] = {}
        self._awaited: set[int] = set()  # id(publisher) of those whose match was waited for
        self._last_report = ""

    def install(self) -> None:
        """Put the three watches into rclpy."""
        from rclpy.executors import Executor, TimeoutException
        from rclpy.publisher import Publisher
        from rclpy.time_source import TimeSource

        wait, take = Executor.wait_for_ready_callbacks, Executor._take_subscription
        publish, clock_callback = Publisher.publish, TimeSource.clock_callback
        watch = self

        def watched_wait(
            executor: Any, timeout_sec: Any = None, nodes: Any = None, condition: Any = lambda: False
        ) -> Any:
            watch._waiting[id(executor)] = False
            try:
                return wait(executor, 0, nodes, condition)
            except TimeoutException:
                if timeout_sec is not None and not hasattr(timeout_sec, "timeout") and timeout_sec == 0:
                    watch.executor_idle(executor)
                    raise
            deadline = None
            seconds = getattr(timeout_sec, "timeout", timeout_sec)
            if seconds is not None and seconds >= 0:
                deadline = time.monotonic() + seconds
            while True:
                left = None if deadline is None else max(0.0, deadline - time.monotonic())
                slice_ = watch.executor_idle(executor)
                patience = left if slice_ is None else slice_ if left is None else min(slice_, left)
                try:
                    found = wait(executor, patience, nodes, condition)
                except TimeoutException:
                    if deadline is not None and time.monotonic() >= deadline:
                        raise
                else:
                    watch._waiting[id(executor)] = False
                    return found

        def watched_take(executor: Any, subscription: Any) -> Any:
            callback = take(executor, subscription)
            if callback is not None:
                watch._taken[watch.topic_of(subscription)] += 1
            return callback

        def watched_publish(publisher: Any, message: Any) -> None:
            watch.await_match(publisher)
            publish(publisher, message)
            watch._published[watch.topic_of(publisher)] += 1

        def watched_clock(source: Any, message: Any) -> None:
            clock_callback(source, message)
            watch._clock_seen[id(source)] = message.clock.sec * 1_000_000_000 + message.clock.nanosec

        Executor.wait_for_ready_callbacks = watched_wait
        Executor._take_subscription = watched_take
        Publisher.publish = watched_publish
        TimeSource.clock_callback = watched_clock

    def await_match(self, publisher: Any) -> None:
        """Hold the first message of a publisher until the grader listens, so that discovery loses none.

        Simulated time stands still meanwhile. A publisher that cannot match (its QoS) is let go after
        `MATCH_PATIENCE`. rclpy offers the matched event only through an executor, so this looks repeatedly.
        """
        if id(publisher) in self._awaited:
            return
        self._awaited.add(id(publisher))
        if self._listened.get(self.topic_of(publisher)) != type_name(publisher):
            return
        deadline = time.monotonic() + MATCH_PATIENCE
        while not publisher.get_subscription_count() and time.monotonic() < deadline:
            threading.Event().wait(UNMATCHED_SLICE)

    def topic_of(self, endpoint: Any) -> str:
        """Resolved topic name of a publisher or subscription."""
        topic = self._topic_of.get(id(endpoint))
        if topic is None:
            topic = self._topic_of[id(endpoint)] = endpoint.topic_name
        return topic

    def executor_idle(self, executor: Any) -> float | None:
        """Report if every executor is idle; return how long [s] the coming wait may last (None: for ever)."""
        if any(not future.done() for future in getattr(executor, "_futures", ())):
            return 0.001  # a callback still runs in the executor's thread pool
        self._waiting[id(executor)] = True
        for node in executor.get_nodes():
            self._nodes[id(node)] = node
        self._refresh_endpoints()
        if all(self._waiting.values()):
            self.report()
        return UNMATCHED_SLICE if self._unmatched_since else None

    def _refresh_endpoints(self) -> None:
        layout = tuple((key, len(n._publishers), len(n._subscriptions)) for key, n in self._nodes.items())
        if layout == self._layout and not self._unmatched_since:
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
        waiting = {
            e["topic"]
            for e in self._endpoints
            if e["kind"] == "publisher" and not e["matched"] and self._listened.get(e["topic"]) == e["type"]
        }
        self._unmatched_since = {
            topic: since
            for topic in waiting
            if now - (since := self._unmatched_since.get(topic, now)) < MATCH_PATIENCE
        }

    def _describe(self, node: str, kind: str, endpoint: Any, matched: int) -> dict[str, Any]:
        qos = endpoint.qos_profile
        return {
            "node": node,
            "kind": kind,
            "topic": self.topic_of(endpoint),
            "type": type_name(endpoint),
            "reliability": qos.reliability.name,
            "durability": qos.durability.name,
            "matched": matched,
        }

    def report(self) -> None:
        """Send the counts if they changed since the last report."""
        spinning = [n._time_source for n in self._nodes.values() if n._time_source.ros_time_is_active]
        report: dict[str, Any] = {
            "clock": min((self._clock_seen.get(id(s), 0) for s in spinning), default=None),
            "taken": self._taken,
            "published": self._published,
        }
        if self._endpoints != self._reported_endpoints:
            report["endpoints"] = self._reported_endpoints = self._endpoints
        text = json.dumps(report)
        if text != self._last_report:
            self._last_report = text
            with contextlib.suppress(OSError):  # the grader is gone: carry on like any node would
                self._channel.send(text.encode())


def type_name(endpoint: Any) -> str:
    """ROS type of a publisher or subscription, such as `geometry_msgs/msg/Twist`."""
    return f"{endpoint.msg_type.__module__.split('.')[0]}/msg/{endpoint.msg_type.__name__}"


def print_student_traceback(error: BaseException, file: str) -> None:
    """Print a traceback that starts in the student's file and shows none of the frames of this one."""
    shown = traceback.TracebackException.from_exception(error)
    seen: set[int] = set()
    chain: list[traceback.TracebackException | None] = [shown]
    while chain:
        part = chain.pop()
        if part is None or id(part) in seen:
            continue
        seen.add(id(part))
        frames = [f for f in part.stack if f.filename not in (__file__, runpy.__file__, "<frozen runpy>")]
        part.stack = traceback.StackSummary.from_list(frames)
        chain += [part.__cause__, part.__context__]
    sys.stdout.flush()
    print("".join(shown.format()), end="", file=sys.stderr, flush=True)


def main() -> None:
    """Watch rclpy, then run the file named in argv[1] as `__main__` with the remaining arguments."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # never outlive the grader
    file = sys.argv[1]
    sys.argv = sys.argv[1:]
    sys.path.insert(0, str(Path(file).parent))
    channel = socket.socket(fileno=int(os.environ.pop(SOCKET_FD)))
    os.set_inheritable(channel.fileno(), False)
    watch = Watch(channel, json.loads(os.environ.pop(LISTENED)))
    watch.install()
    try:
        runpy.run_path(file, run_name="__main__")
    except SystemExit:
        raise
    except BaseException as error:
        print_student_traceback(error, file)
        sys.exit(130 if isinstance(error, KeyboardInterrupt) else 1)
    finally:
        watch.report()  # what was published after the last wait


if __name__ == "__main__":
    main()
