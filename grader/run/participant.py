"""Runs a student's file unmodified and tells the grader when its node has nothing left to do.

This file is started as a script, in the student's own process, by `grader.run.student`; it imports nothing of
ours. It watches three places in rclpy (the executor's wait, every publish, every take) and then runs the file as
`__main__`. Each time an executor is about to go to sleep it sends one report over an inherited socket:

    {"clock": ns, "taken": {topic: n}, "published": {topic: n}, "flushes": n, "endpoints": [...]}

`endpoints` is there only when it changed; `clock` is the smallest simulated time any spinning node has been told;
`taken` and `published` count messages since the start, the latter only while somebody listened; when `flushes` grows,
the process waits for an answer before it takes a publisher down. The grader advances simulated time only when those
numbers show that everything it sent was taken. Nothing here is trusted: a process that lies about itself only spoils
its own run.
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
TOPICS = "COURSE_TOPICS"
UNMATCHED_SLICE = 0.005  # [s] how often an unmatched publisher is looked at; DDS gives no event we could wait for
POOL_START = 0.01  # [s] for a pool to take up a callback; a pool whose threads are all busy does not
POOL_SLICE = 0.001  # [s] how often a running pool callback is looked at, should its end not wake us
FLUSH_PATIENCE = 1.0  # [s] for the grader to receive the last messages before a publisher goes away
MATCH_PATIENCE = 5.0  # [s] after that a publisher nobody matches is simply unmatched


class Watch:
    """Counts what one process publishes and takes, and reports it whenever its executors go idle."""

    def __init__(self, channel: socket.socket, topics: dict[str, dict[str, str]]) -> None:
        self._channel = channel
        self._topics = topics  # where the grader has the other end: kind of ours -> topic -> ROS type
        self._taken: Counter[str] = Counter()
        self._published: Counter[str] = Counter()
        self._clock_seen: dict[int, int] = {}  # id(TimeSource) -> ns
        self._waiting: dict[int, bool] = {}  # id(executor) -> is asleep in its wait
        self._nodes: dict[int, Any] = {}
        self._topic_of: dict[int, str] = {}  # id(subscription) -> topic; asking rcl each time is slow
        self._layout: tuple[Any, ...] = ()
        self._endpoints: list[dict[str, Any]] = []
        self._reported_endpoints: list[dict[str, Any]] = []
        self._unmatched_since: dict[tuple[str, str], float] = {}
        self._awaited: set[int] = set()  # id(publisher) of those whose match was waited for
        self._started: dict[int, threading.Event] = {}  # id(thread pool) -> its last callback was taken up
        self._last_report = ""
        self._flushes = 0

    def install(self) -> None:
        """Put the three watches into rclpy."""
        from rclpy.context import Context
        from rclpy.executors import ConditionReachedException, Executor, TimeoutException
        from rclpy.node import Node
        from rclpy.publisher import Publisher
        from rclpy.time_source import TimeSource

        wait, take = Executor.wait_for_ready_callbacks, Executor._take_subscription
        publish, clock_callback = Publisher.publish, TimeSource.clock_callback
        watch = self

        def watched_wait(
            executor: Any, timeout_sec: Any = None, nodes: Any = None, condition: Any = lambda: False
        ) -> Any:
            watch._waiting[id(executor)] = False
            watch.await_start(executor)
            seconds = getattr(timeout_sec, "timeout", timeout_sec)
            deadline = None if seconds is None or seconds < 0 else time.monotonic() + seconds
            patience: float | None = 0.0
            while True:
                # A callback may still run in the executor's pool; its end wakes the wait.
                running = [future for future in getattr(executor, "_futures", ()) if not future.done()]

                def ended(running: list[Any] = running) -> bool:
                    return condition() or all(future.done() for future in running)

                try:
                    found = wait(executor, patience, nodes, ended if running and patience else condition)
                except TimeoutException:
                    if patience and deadline is not None and time.monotonic() >= deadline:
                        raise
                except ConditionReachedException:
                    if condition():
                        raise
                else:
                    watch._waiting[id(executor)] = False
                    return found
                # A callback that has ended becomes `done` a moment after it woke the wait, hence the short slice.
                busy = any(not future.done() for future in running)
                slice_ = POOL_SLICE if busy else watch.executor_idle(executor)
                if seconds == 0:
                    raise TimeoutException
                left = None if deadline is None else max(1e-6, deadline - time.monotonic())
                patience = left if slice_ is None else slice_ if left is None else min(slice_, left)

        def watched_take(executor: Any, subscription: Any) -> Any:
            callback = take(executor, subscription)
            if callback is not None:
                watch._taken[watch.topic_of(subscription)] += 1
            return callback

        def watched_publish(publisher: Any, message: Any) -> None:
            watch.await_match(publisher)
            heard = publisher.get_subscription_count() > 0
            publish(publisher, message)
            if heard:
                watch._published[watch.topic_of(publisher)] += 1

        def watched_clock(source: Any, message: Any) -> None:
            clock_callback(source, message)
            watch._clock_seen[id(source)] = message.clock.sec * 1_000_000_000 + message.clock.nanosec

        def flushed(function: Any) -> Any:
            def after_flush(*args: Any, **kwargs: Any) -> Any:
                watch.flush()
                return function(*args, **kwargs)

            return after_flush

        # A writer that goes away takes messages with it that its reader has not looked at yet.
        for owner, name in ((Node, "destroy_node"), (Node, "destroy_publisher"), (Context, "shutdown")):
            setattr(owner, name, flushed(getattr(owner, name)))
        Executor.wait_for_ready_callbacks = watched_wait
        Executor._take_subscription = watched_take
        Publisher.publish = watched_publish
        TimeSource.clock_callback = watched_clock

    def await_start(self, executor: Any) -> None:
        """Let a MultiThreadedExecutor's pool take up the callback it was just given.

        Until then the executor finds the same callback ready again and again and keeps the pool from running.
        """
        pool = getattr(executor, "_executor", None)
        if pool is None:
            return
        if id(pool) not in self._started:
            submit = pool.submit

            def noted_submit(callback: Any) -> Any:
                started = self._started[id(pool)] = threading.Event()

                def run() -> None:
                    started.set()
                    callback()

                return submit(run)

            pool.submit = noted_submit
            self._started[id(pool)] = threading.Event()
            self._started[id(pool)].set()
        self._started[id(pool)].wait(POOL_START)

    def await_match(self, publisher: Any) -> None:
        """Hold the first message of a publisher until the grader listens, so that discovery loses none.

        Simulated time stands still meanwhile. A publisher that cannot match (its QoS) is let go after
        `MATCH_PATIENCE`. rclpy offers the matched event only through an executor, so this looks repeatedly.
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
        """Whether the grader has the other end of an endpoint, of the same type and with QoS that fits."""
        met = self._topics.get(endpoint["kind"], {})
        return met.get(endpoint["topic"]) == endpoint["type"] and qos_can_match(**endpoint)

    def topic_of(self, endpoint: Any) -> str:
        """Resolved topic name of a publisher or subscription."""
        topic = self._topic_of.get(id(endpoint))
        if topic is None:
            topic = self._topic_of[id(endpoint)] = endpoint.topic_name
        return topic

    def executor_idle(self, executor: Any) -> float | None:
        """Report if every executor is idle; return how long [s] the coming wait may last (None: for ever)."""
        self._waiting[id(executor)] = True
        for node in executor.get_nodes():
            self._nodes[id(node)] = node
        self._refresh_endpoints()
        if all(self._waiting.values()):
            self.report()
        return UNMATCHED_SLICE if self._impatient() else None

    def _impatient(self) -> bool:
        """Whether an endpoint may still be about to match."""
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
            "type": type_name(endpoint),
            "reliability": qos.reliability.name,
            "durability": qos.durability.name,
            "matched": matched,
        }

    def flush(self) -> None:
        """Wait until the grader has received everything published so far, or for `FLUSH_PATIENCE`."""
        self._flushes += 1
        self.report()
        with contextlib.suppress(OSError):
            self._channel.settimeout(FLUSH_PATIENCE)
            self._channel.recv(64)

    def report(self) -> None:
        """Send the counts if they changed since the last report."""
        spinning = [n._time_source for n in self._nodes.values() if n._time_source.ros_time_is_active]
        report: dict[str, Any] = {
            "clock": min((self._clock_seen.get(id(s), 0) for s in spinning), default=None),
            "taken": self._taken,
            "published": self._published,
            "flushes": self._flushes,
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


def qos_can_match(kind: str, reliability: str, durability: str, **_: Any) -> bool:
    """Whether an endpoint's QoS fits the grader's, which is reliable and volatile as ros_gz_bridge's is.

    A best-effort publisher does not reach it, and a transient-local subscription does not accept it.
    """
    return reliability != "BEST_EFFORT" if kind == "publisher" else durability != "TRANSIENT_LOCAL"


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
    channel = socket.socket(fileno=int(os.environ.pop(SOCKET_FD)))
    os.set_inheritable(channel.fileno(), False)
    watch = Watch(channel, json.loads(os.environ.pop(TOPICS)))
    watch.install()
    sys.path.insert(0, str(Path(file).parent))  # after rclpy is in: nothing beside the file can stand in for it
    try:
        runpy.run_path(file, run_name="__main__")
    except SystemExit:
        raise
    except BaseException as error:
        print_student_traceback(error, file)
        sys.exit(130 if isinstance(error, KeyboardInterrupt) else 1)
    finally:
        watch.flush()


if __name__ == "__main__":
    main()
