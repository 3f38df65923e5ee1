"""The patches of rclpy 7.1 that concern waiting: executors, guard conditions, clocks, services, single messages.

`rclpy_7_1.py` calls `watch_waits`. While a thread waits in one of them it counts as idle, timeouts take simulated time,
and who ends a wait counts its thread as at work again (`thread_monitor.py`).
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from . import inbox
from .executor_monitor import ExecutorMonitor
from .held_messages import UNMATCHED_SLICE
from .patience import await_found
from .rclpy_7_1_coroutines import watch_coroutines
from .signals import Signal
from .thread_monitor import POLL_PERIOD, Wait, monotonic

# [s] of the run's clock for a service to be found: before a client's first request is sent, and before a wait for it
# takes simulated time; the second once nobody else is at work, and shorter than what the grader waits for a node
# (`pace/real_time.py`, PATIENCE).
SERVICE_PATIENCE, SERVICE_LOOK = 2.5, 1.0
# [s] of real time for a pool to start a callback; a pool whose threads are all busy does not. The executor then finds
# it ready again, which costs processor time and changes nothing.
POOL_START = 0.01


def watch_waits(monitor: ExecutorMonitor) -> None:
    """Patch everything in rclpy that waits."""
    _watch_executors(monitor)
    _watch_guard_conditions(monitor)
    _watch_clocks(monitor)
    _watch_single_messages(monitor)
    _wait_for_services(monitor)
    watch_coroutines()


def nudge(monitor: ExecutorMonitor, executor: Any) -> None:
    """Count the thread of a waiting executor as at work, because something has come for it."""
    if executor is None:
        return
    with monitor.threads.lock:
        executor.course_nudged = True
        wait = getattr(executor, "course_wait", None)
        if wait is not None:
            monitor.threads.rouse(wait)


def _watch_executors(monitor: ExecutorMonitor) -> None:
    """Patch the wait of every executor, and the clocks of the nodes."""
    from rclpy.executors import ConditionReachedException, Executor, TimeoutException
    from rclpy.time_source import TimeSource

    wait, clock_callback = Executor.wait_for_ready_callbacks, TimeSource.clock_callback
    threads = monitor.threads

    def watched_wait(executor: Any, timeout_sec: Any = None, nodes: Any = None, condition: Any = lambda: False) -> Any:
        mine = threads.mine()
        threads.calling.discard(mine)
        _await_start(executor, monitor)
        seconds = getattr(timeout_sec, "timeout", timeout_sec)
        seconds = None if seconds is None or seconds < 0 else seconds
        due = _Due(monitor, seconds)
        while True:
            executor.course_nudged = False
            # The rest of an earlier wait set ends in a timeout, too; only a new one shows that there is nothing to do.
            old = executor._cb_iter is not None
            try:
                found = wait(executor, 0.0, nodes, condition)
            except TimeoutException:
                executor._cb_iter = None
                if old:
                    continue
                found = inbox.ready(executor, nodes)
            except ConditionReachedException:
                if condition():
                    raise
                continue
            if found is None and due.reached:
                raise TimeoutException
            if found is None and seconds == 0:
                if not threads.polls_too_often():
                    if not threads.simulated:
                        with threads.waiting():
                            pass
                    raise TimeoutException
                due = _Due(monitor, POLL_PERIOD)
                seconds = POLL_PERIOD
            if found is None:
                found = idle(executor, nodes, condition, due)
            if found is not None:
                if mine is not None:
                    threads.calling.add(mine)
                return found

    def idle(executor: Any, nodes: Any, condition: Any, due: _Due) -> Any:
        """Wait until something is ready, or has come for the executor, or the time is over; return what is ready."""
        executor._guard.course_executor = executor

        def over() -> bool:
            return condition() or executor.course_nudged

        def wake() -> None:
            executor.course_nudged = True
            executor.wake()

        monitor.spun = True
        with threads.lock:
            if executor.course_nudged:
                return None
            executor.course_wait = current = threads.open(due.deadline, wake)
        try:
            if threads.idle:
                monitor.report()
            while not over():
                slice_ = UNMATCHED_SLICE if monitor.impatient() else None
                left = due.left
                patience = left if slice_ is None else slice_ if left is None else min(slice_, left)
                try:
                    return wait(executor, patience, nodes, over)
                except TimeoutException:
                    executor._cb_iter = None
                    if threads.idle:
                        monitor.report()
                    if left is not None and due.reached:
                        break
                except ConditionReachedException:
                    break
            return None
        finally:
            executor.course_wait = None
            threads.end(current)

    def watched_clock(source: Any, message: Any) -> None:
        clock_callback(source, message)
        monitor.saw_clock(source, message)

    Executor.wait_for_ready_callbacks = watched_wait
    TimeSource.clock_callback = watched_clock


class _Due:
    """The end of a wait for some seconds (None: for ever), in simulated time if that is followed."""

    def __init__(self, monitor: ExecutorMonitor, seconds: float | None) -> None:
        self._threads = monitor.threads
        simulated = self._threads.simulated and self._threads.mine() is not None
        timed = seconds is not None and seconds > 0
        self.deadline = self._threads.after(seconds) if simulated and timed and seconds is not None else None
        self._end = monotonic() + seconds if timed and not simulated and seconds is not None else None

    @property
    def left(self) -> float | None:
        """What is left in real time [s]; None if only others end the wait."""
        if self.deadline is not None and not self._threads.simulated and self._end is None:
            self._end = monotonic() + (self.deadline - self._threads.now_ns) / 1e9 / self._threads.rate
        return None if self._end is None else max(1e-6, self._end - monotonic())

    @property
    def reached(self) -> bool:
        if self._end is not None:
            return monotonic() >= self._end
        return self.deadline is not None and self._threads.now_ns >= self.deadline


def _await_start(executor: Any, monitor: ExecutorMonitor) -> None:
    """Wait until the pool of a MultiThreadedExecutor has started the callback it was just given.

    Until then the executor finds the same callback ready again and again and keeps the pool from running.
    """
    pool = getattr(executor, "_executor", None)
    if pool is None:
        return
    started: Signal | None = getattr(pool, "course_started", None)
    if started is None:
        pool.course_started = Signal()
        pool.course_started.set()
        submit = pool.submit

        def noted_submit(callback: Any) -> Any:
            begun = pool.course_started = Signal()

            def run() -> None:
                begun.set()
                mine = monitor.threads.mine()
                if mine is not None:
                    monitor.threads.calling.add(mine)
                try:
                    callback()
                finally:
                    monitor.threads.calling.discard(mine)

            return submit(run)

        pool.submit = noted_submit
    else:
        started.wait(POOL_START)


def _watch_guard_conditions(monitor: ExecutorMonitor) -> None:
    """Patch the way in which threads call an executor."""
    from rclpy.guard_condition import GuardCondition

    trigger = GuardCondition.trigger

    def noted_trigger(guard: Any) -> None:
        nudge(monitor, getattr(guard, "course_executor", None) or monitor.executor_of(guard))
        trigger(guard)

    GuardCondition.trigger = noted_trigger


class _Module:
    """Stands for rclpy's implementation in one of its modules, with some of its classes replaced."""

    def __init__(self, module: Any, **instead: Any) -> None:
        self.__dict__.update(instead)
        self._module = module

    def __getattr__(self, name: str) -> Any:
        return getattr(self._module, name)


def _watch_clocks(monitor: ExecutorMonitor) -> None:
    """Let the clocks that do not follow `/clock` follow simulated time, and a sleep on any clock be watched."""
    from rclpy import clock as clocks
    from rclpy.clock import Clock, ClockType
    from rclpy.time import Time

    threads, now = monitor.threads, Clock.now
    names = {ClockType.SYSTEM_TIME: "time", ClockType.STEADY_TIME: "monotonic"}

    def watched_now(clock: Any) -> Any:
        kind = clock.clock_type
        name = "time" if kind == ClockType.ROS_TIME and not clock.ros_time_is_active else names.get(kind)
        if name is None or not threads.simulated:
            return now(clock)
        shown = threads.clock_ns(name, lambda: int(now(clock).nanoseconds))
        return Time(nanoseconds=shown, clock_type=kind)

    class WatchedClockEvent:
        """An event with the waits of rclpy's ClockEvent."""

        def __init__(self) -> None:
            self._event = threading.Event()
            self.set, self.clear, self.is_set = self._event.set, self._event.clear, self._event.is_set

        def wait_until_ros(self, clock: Any, until: Any) -> None:
            if clock.get_ros_time_override_is_enabled():
                if clock.get_now().nanoseconds < until.nanoseconds:
                    self._event.wait()
            else:
                self.wait_until_system(clock, until)

        def wait_until_system(self, clock: Any, until: Any) -> None:
            self._wait("time", clock, until)

        def wait_until_steady(self, clock: Any, until: Any) -> None:
            self._wait("monotonic", clock, until)

        def _wait(self, name: str, clock: Any, until: Any) -> None:
            shown = threads.clock_ns(name, lambda: int(clock.get_now().nanoseconds))
            if until.nanoseconds > shown:
                self._event.wait((until.nanoseconds - shown) / 1e9)

    Clock.now = watched_now
    clocks._rclpy = _Module(clocks._rclpy, ClockEvent=WatchedClockEvent)


def _watch_single_messages(monitor: ExecutorMonitor) -> None:
    """Let `wait_for_message` be a wait that is watched."""
    from rclpy import wait_for_message as module

    real = module._rclpy
    threads = monitor.threads

    class WatchedWaitSet:
        """A wait set with a guard condition of its own, which ends the wait."""

        def __init__(self, subscriptions: int, guards: int, *more: Any) -> None:
            self._set = real.WaitSet(subscriptions, guards + 1, *more)
            self._guard = real.GuardCondition(more[-1])
            self._topics: list[str] = []

        def __getattr__(self, name: str) -> Any:
            return getattr(self._set, name)

        def clear_entities(self) -> None:
            self._set.clear_entities()
            self._set.add_guard_condition(self._guard)

        def add_subscription(self, handle: Any) -> None:
            for node in monitor.nodes:
                for subscription in node.subscriptions:
                    if subscription.handle is handle:
                        subscription.course_waited = True
                        self._topics.append(monitor.topic_of(subscription))
            self._set.add_subscription(handle)

        def wait(self, nanoseconds: int) -> None:
            if not threads.simulated or threads.mine() is None:
                self._set.wait(nanoseconds)
                return
            monitor.spun = True
            deadline = threads.after(nanoseconds / 1e9) if nanoseconds >= 0 else None
            wait: Wait | None = threads.begin(deadline, self._guard.trigger_guard_condition)
            try:
                self._set.wait(-1)
            finally:
                threads.end(wait)
            if self._set.get_ready_entities("subscription"):
                for topic in self._topics:
                    monitor.count(monitor.taken, topic)

    module._rclpy = _Module(real, WaitSet=WatchedWaitSet)


def _wait_for_services(monitor: ExecutorMonitor) -> None:
    """Let simulated time stand still while others are at work or start up, and while discovery may find a service."""
    from rclpy.client import Client

    wait = Client.wait_for_service

    def patient_wait(client: Any, timeout_sec: float | None = None) -> bool:
        await_found(monitor.threads, client.context.ok, client.service_is_ready, SERVICE_LOOK)
        return bool(wait(client, timeout_sec))

    Client.wait_for_service = patient_wait


def may_ask(client: Any, is_found: Callable[[], bool]) -> Callable[[float], bool]:
    """Return a test whether a client's request may leave, given the run's time [s].

    It may when discovery has found the server, or has looked for it since the first request for `SERVICE_PATIENCE`.
    """

    def may(now: float) -> bool:
        client.course_looks_since = getattr(client, "course_looks_since", now)
        return is_found() or now - client.course_looks_since >= SERVICE_PATIENCE

    return may
