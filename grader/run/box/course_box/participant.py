"""Watches rclpy in a process of the submission, so that the grader can tell when its nodes have nothing left to do.

`hooks.py` calls `install` as soon as rclpy is imported. A few places in rclpy are watched: the executor's wait, every
publish, every take, every request and response, every end of a publisher. `watch.py` counts and reports. Nothing here
is trusted: a process that lies about itself only spoils its own run.
"""

from __future__ import annotations

import atexit
import contextlib
import copy
import json
import os
import runpy
import sys
import threading
import time
import traceback
from pathlib import Path
from typing import Any

from . import lossless
from .channel import channel
from .watch import HOLD, HOUSEKEEPING, POOL_SLICE, TOPICS, Watch

_watch: Watch | None = None


def watch() -> Watch:
    """Return the watch of this process. rclpy must have been imported."""
    assert _watch is not None
    return _watch


def install() -> None:
    """Begin to watch this process; rclpy has just been imported."""
    global _watch
    topics = json.loads(os.environ.get(TOPICS, "{}"))
    _watch = Watch(channel(), topics, bool(os.environ.get(HOLD)))
    _watch_executors(_watch)
    _watch_messages(_watch)
    lossless.install(_watch)
    _watch_services(_watch)
    channel().send({"ros": True})
    _watch.listen()
    atexit.register(_watch.flush)
    sys.excepthook = lambda kind, error, trace: print_traceback(error)


def _watch_executors(watch: Watch) -> None:
    """The wait of every executor, and the clocks of the nodes."""
    from rclpy.executors import ConditionReachedException, Executor, TimeoutException
    from rclpy.time_source import TimeSource

    wait, clock_callback = Executor.wait_for_ready_callbacks, TimeSource.clock_callback

    def watched_wait(executor: Any, timeout_sec: Any = None, nodes: Any = None, condition: Any = lambda: False) -> Any:
        watch.waiting[id(executor)] = False
        watch.await_start(executor)
        seconds = getattr(timeout_sec, "timeout", timeout_sec)
        deadline = None if seconds is None or seconds < 0 else time.monotonic() + seconds
        patience: float | None = 0.0
        while True:
            # A callback may still run in the executor's pool; its end wakes the wait.
            running = [future for future in getattr(executor, "_futures", ()) if not future.done()]

            def ended(running: list[Any] = running) -> bool:
                return condition() or all(future.done() for future in running)

            # What is left of an earlier look ends in a timeout, too; only a new look says that there is nothing to do.
            old = patience == 0.0 and executor._cb_iter is not None
            try:
                found = wait(executor, patience, nodes, ended if running and patience else condition)
            except TimeoutException:
                executor._cb_iter = None
                if old:
                    continue
                if patience and deadline is not None and time.monotonic() >= deadline:
                    raise
            except ConditionReachedException:
                if condition():
                    raise
            else:
                watch.waiting[id(executor)] = False
                return found
            # A callback that has ended becomes `done` a moment after it woke the wait, hence the short slice.
            busy = sum(not future.done() for future in running) > watch.blocked_threads
            slice_ = POOL_SLICE if busy else watch.executor_idle(executor)
            if seconds == 0:
                raise TimeoutException
            left = None if deadline is None else max(1e-6, deadline - time.monotonic())
            patience = left if slice_ is None else slice_ if left is None else min(slice_, left)

    def watched_clock(source: Any, message: Any) -> None:
        clock_callback(source, message)
        watch.clock_seen[id(source)] = message.clock.sec * 1_000_000_000 + message.clock.nanosec

    Executor.wait_for_ready_callbacks = watched_wait
    TimeSource.clock_callback = watched_clock


def _watch_messages(watch: Watch) -> None:
    """Every publish and every take."""
    from rclpy.context import Context
    from rclpy.executors import Executor
    from rclpy.node import Node
    from rclpy.publisher import Publisher

    take, publish = Executor._take_subscription, Publisher.publish

    def watched_take(executor: Any, subscription: Any) -> Any:
        callback = take(executor, subscription)
        if callback is None:
            return None
        topic = watch.topic_of(subscription)
        if lossless.is_copy(subscription, _variables(callback)["msg_tuple"][0]) and topic in watch.again:
            return None
        watch.count(watch.taken, topic)
        return callback

    def emit(publisher: Any, message: Any) -> None:
        readers = publisher.get_subscription_count()
        publish(publisher, message)
        if readers:
            topic = watch.topic_of(publisher)
            watch.count(watch.delivered, topic, readers)
            # A best-effort publisher never matches the grader's subscriptions.
            if publisher.qos_profile.reliability.name != "BEST_EFFORT":
                watch.count(watch.published, topic)

    def watched_publish(publisher: Any, message: Any) -> None:
        if not watch.holds or publisher.topic in HOUSEKEEPING or not isinstance(message, publisher.msg_type | bytes):
            watch.await_match(publisher)
            emit(publisher, message)
            return
        from rclpy.serialization import serialize_message

        # As it is now: what the caller does to the message later does not count.
        data = message if isinstance(message, bytes) else serialize_message(message)
        watch.hold(lambda: emit(publisher, data))

    def flushed(function: Any) -> Any:
        def after_flush(*args: Any, **kwargs: Any) -> Any:
            watch.flush()
            return function(*args, **kwargs)

        return after_flush

    # A writer that goes away takes messages with it that its reader has not looked at yet.
    for owner, name in ((Node, "destroy_node"), (Node, "destroy_publisher"), (Context, "shutdown")):
        setattr(owner, name, flushed(getattr(owner, name)))
    Executor._take_subscription = watched_take
    Publisher.publish = watched_publish


def _watch_services(watch: Watch) -> None:
    """Requests and responses, on either side."""
    from rclpy.client import Client
    from rclpy.executors import Executor
    from rclpy.service import Service
    from rclpy.task import Future

    take_request, take_response = Executor._take_service, Executor._take_client
    call, respond = Client.call, Service.send_response
    caller = threading.local()

    def watched_take_request(executor: Any, service: Any) -> Any:
        callback = take_request(executor, service)
        if _took(callback, "request_and_header"):
            watch.count(watch.taken, f"request {service.service_name}")
        return callback

    def watched_take_response(executor: Any, client: Any) -> Any:
        callback = take_response(executor, client)
        if _took(callback, "header_and_response"):
            watch.count(watch.taken, f"response {client.service_name}")
        return callback

    def watched_call_async(client: Any, request: Any) -> Any:
        if not isinstance(request, client.srv_type.Request):
            raise TypeError
        asked = copy.deepcopy(request)
        future = Future()
        if calling := getattr(caller, "calling", None):
            future.add_done_callback(lambda _: calling.close())
        future.add_done_callback(client.remove_pending_request)

        def send() -> None:
            if watch.holds:
                watch.await_service(client)
            with client._lock, client.handle:
                if not future.done():
                    sequence = client.handle.send_request(asked)
                    client._pending_requests[sequence] = future
            if client.service_is_ready():
                watch.count(watch.delivered, f"request {client.service_name}")

        watch.hold(send)
        return future

    def watched_call(client: Any, *args: Any, **kwargs: Any) -> Any:
        # Until the response is here, which the future of `call_async` is told first.
        with contextlib.ExitStack() as calling:
            calling.enter_context(watch.blocked())
            caller.calling = calling
            try:
                return call(client, *args, **kwargs)
            finally:
                caller.calling = None

    def watched_respond(service: Any, response: Any, header: Any) -> None:
        if not isinstance(response, service.srv_type.Response):
            raise TypeError

        def send() -> None:
            respond(service, response, header)
            watch.count(watch.delivered, f"response {service.service_name}")

        watch.hold(send)

    Executor._take_service = watched_take_request
    Executor._take_client = watched_take_response
    Client.call_async = watched_call_async
    Client.call = watched_call
    Service.send_response = watched_respond


def _took(callback: Any, pair: str) -> bool:
    """Whether something was there: a client is woken by the responses of others, too, and takes nothing then.

    `callback` is what the executor is going to run, which has what was taken as the variable `pair`.
    """
    if callback is None:
        return False
    variables = _variables(callback)
    return pair in variables and None not in variables[pair]


def _variables(callback: Any) -> dict[str, Any]:
    """What a function took along from where it was defined."""
    cells = callback.__closure__ or ()
    return {name: cell.cell_contents for name, cell in zip(callback.__code__.co_freevars, cells, strict=False)}


def print_traceback(error: BaseException) -> None:
    """Print a traceback that shows none of our own frames, as if the program had been started alone."""
    shown = traceback.TracebackException.from_exception(error)
    seen: set[int] = set()
    chain: list[traceback.TracebackException | None] = [shown]
    while chain:
        part = chain.pop()
        if part is None or id(part) in seen:
            continue
        seen.add(id(part))
        frames = [f for f in part.stack if not _is_ours(f.filename)]
        part.stack = traceback.StackSummary.from_list(frames)
        chain += [part.__cause__, part.__context__]
    sys.stdout.flush()
    print("".join(shown.format()), end="", file=sys.stderr, flush=True)


def _is_ours(file: str) -> bool:
    return file in (runpy.__file__, "<frozen runpy>") or Path(file).parent == Path(__file__).parent
