"""Takes what comes from ROS and hands it to the bridge, in one thread, without the long way through an executor.

An executor of rclpy asks every service, timer and event of the node whether it is its turn, and makes a task of each
message. A command on its way to the simulator need not wait for that: the subscriptions of a ``RosListener`` have a
wait set of their own. ``bridge.Bridge`` makes one when it works with threads, ``link.RosToGz`` adds its subscription
and is called with each message; from there it goes to ``gz.transport`` in the same thread.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from typing import Any, NamedTuple

from rclpy.callback_groups import CallbackGroup
from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.guard_condition import GuardCondition
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.subscription import Subscription

_WITHOUT_END = -1
_STOP_WITHIN_S = 1.0


class ListenerGroup(CallbackGroup):
    """The callback group of a listener's subscriptions: executors leave them alone.

    Their QoS events as well: DDS would wake whoever waits for these with every message, too.
    """

    def can_execute(self, entity: Any) -> bool:
        """Whether an executor may wait for it."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Whether an executor may begin with it."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Nothing is kept."""


class _Input(NamedTuple):
    handle: Any
    message_type: Any
    callback: Callable[[Any, dict[str, int]], None]
    failed: Callable[[Exception], None]


class RosListener:
    """One thread that waits for the messages of many subscriptions. They must be created with its ``group``."""

    def __init__(self, context: Context) -> None:
        """Nothing runs before the first ``add``."""
        self.group = ListenerGroup()
        self._context = context
        self._inputs: dict[Subscription, _Input] = {}
        self._changed = False
        self._open = True
        self._lock = threading.Lock()
        self._wake = GuardCondition(None, None, context)
        self._thread: threading.Thread | None = None

    def add(
        self,
        subscription: Subscription,
        callback: Callable[[Any, dict[str, int]], None],
        failed: Callable[[Exception], None],
    ) -> None:
        """From now on call ``callback(message, what DDS says about it)`` for each message, in the listener's thread.

        What it raises, and what DDS says of a message that cannot be taken, goes to ``failed``.
        """
        with self._lock:
            self._inputs[subscription] = _Input(subscription.handle, subscription.msg_type, callback, failed)
            self._changed = True
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="ros_listener", daemon=True)
                self._thread.start()
        self._wake.trigger()

    def remove(self, subscription: Subscription) -> None:
        """Forget a subscription, which may then be destroyed; a message taken already is still handed over."""
        with self._lock:
            self._inputs.pop(subscription, None)
            self._changed = True
        self._wake.trigger()

    def close(self) -> None:
        """End the thread after the message it is at; harmless when repeated."""
        with self._lock:
            if not self._open:
                return
            self._open = False
            self._changed = True
            thread = self._thread
        self._wake.trigger()
        if thread is not None and thread is not threading.current_thread():
            thread.join(_STOP_WITHIN_S)
        self._wake.destroy()

    def _run(self) -> None:
        while True:
            with self._lock:
                if not self._open:
                    return
                self._changed = False
                inputs = dict(self._inputs)
            self._listen(inputs)

    def _listen(self, inputs: dict[Subscription, _Input]) -> None:
        """Wait for messages and hand them over until there are other subscriptions to wait for."""
        events = []
        with contextlib.ExitStack() as in_use:  # what is in a wait set must not be destroyed
            in_use.enter_context(self._context.handle)
            in_use.enter_context(self._wake.handle)
            for subscription in inputs:
                try:
                    in_use.enter_context(subscription.handle)
                    for event in subscription.event_handlers:
                        in_use.enter_context(event)
                        events.append(event)
                except InvalidHandle:  # destroyed before it was removed
                    self.remove(subscription)
                    return
            wait_set = _rclpy.WaitSet(len(inputs), 1, 0, 0, 0, len(events), self._context.handle)
            while not self._changed:
                wait_set.clear_entities()
                wait_set.add_guard_condition(self._wake.handle)
                for each in inputs.values():
                    wait_set.add_subscription(each.handle)
                for event in events:
                    event.add_to_wait_set(wait_set)
                wait_set.wait(_WITHOUT_END)
                ready = wait_set.get_ready_entities("subscription")
                for each in inputs.values():
                    if each.handle.pointer in ready:
                        _hand_over(each)
                if not ready:
                    for event in events:
                        if event.is_ready(wait_set) and (happened := event.take_data()):
                            event.callback(happened)


def _hand_over(each: _Input) -> None:
    """The next message of a subscription, if nobody else took it."""
    try:
        taken = each.handle.take_message(each.message_type, False)
        if taken is not None:
            each.callback(*taken)
    except Exception as error:
        each.failed(error)
