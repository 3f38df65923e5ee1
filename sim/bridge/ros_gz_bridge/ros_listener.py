"""A thread that takes ROS messages with a wait set of its own, faster than an executor.

An executor of rclpy checks every service, timer and event of the node and makes a task of each message, which delays
commands to the simulator. `bridge.Bridge` makes one `RosListener` if it is threaded; `link.RosToGz` adds its
subscription, and its callback passes each message to `gz.transport` in the same thread.
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
    """The callback group of a listener's subscriptions and their QoS events, which executors ignore.

    An executor that waits for the QoS events would also be woken by every message.
    """

    def can_execute(self, entity: Any) -> bool:
        return False

    def beginning_execution(self, entity: Any) -> bool:
        return False

    def ending_execution(self, entity: Any) -> None:
        """Do nothing: there is no state."""


class _Input(NamedTuple):
    handle: Any
    message_type: Any
    callback: Callable[[Any, dict[str, int]], None]
    failed: Callable[[Exception], None]


class RosListener:
    """One thread that waits for the messages of many subscriptions, which must be created with its `group`.

    It starts with the first `add`. Thread-safe.
    """

    def __init__(self, context: Context) -> None:
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
        """Call `callback(message, message info)` for each message from now on, in the listener's thread.

        `failed` gets the exceptions of `callback`, and those of messages that cannot be taken.
        """
        with self._lock:
            self._inputs[subscription] = _Input(subscription.handle, subscription.msg_type, callback, failed)
            self._changed = True
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="ros_listener", daemon=True)
                self._thread.start()
        self._wake.trigger()

    def remove(self, subscription: Subscription) -> None:
        """Stop waiting for a subscription, which may then be destroyed; a message already taken is still delivered."""
        with self._lock:
            self._inputs.pop(subscription, None)
            self._changed = True
        self._wake.trigger()

    def close(self) -> None:
        """End the thread after the current message; may be repeated."""
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
        """Wait for messages and deliver them until the set of subscriptions changes."""
        events = []
        with contextlib.ExitStack() as in_use:  # entities of a wait set must not be destroyed
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
    """Take the next message of a subscription and call its callback."""
    try:
        taken = each.handle.take_message(each.message_type, False)
        if taken is not None:
            each.callback(*taken)
    except Exception as error:
        each.failed(error)
