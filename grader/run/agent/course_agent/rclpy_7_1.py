"""All patches of rclpy 7.1 (ROS 2 Jazzy): they report when a process has nothing left to do.

`import_hooks.py` calls `install` as soon as rclpy is imported. Patched are every publish and take, and
the destruction of publishers; in `rclpy_7_1_services.py` requests and responses; in `rclpy_7_1_waits.py` the executor's
wait and all others. `executor_monitor.py`
counts and reports. `RELIED_UPON` lists everything in rclpy on which this depends. The grader trusts none of it: a
process that reports falsely only spoils its own run.
"""

from __future__ import annotations

import atexit
import functools
import json
import os
import sys
from typing import Any

from . import other_domains
from .channel import channel
from .endpoint_description import type_name
from .executor_monitor import HOLD, HOUSEKEEPING, SIMULATED_CLOCKS, TOPICS, ExecutorMonitor
from .history import kept_depth
from .inbox import Kept, fill, has_kept, is_copy, kept
from .python_3_threads import install_threads
from .rclpy_7_1_services import variables_of, watch_services
from .rclpy_7_1_waits import nudge, watch_waits
from .rosout_counter import watch_logging
from .self_check import Reliance, misfits
from .tracebacks import print_traceback

VERSION = "7.1"
EXISTS: Reliance = ("", "")
# Source: the Python files of rclpy 7.1.6, https://github.com/ros2/rclpy/tree/jazzy/rclpy/rclpy
RELIED_UPON: dict[str, Reliance] = {
    "rclpy.executors:Executor.wait_for_ready_callbacks": ("self", "_cb_iter _wait_for_ready_callbacks"),
    "rclpy.executors:Executor._wait_for_ready_callbacks": ("self timeout_sec nodes condition", "executing"),
    "rclpy.executors:Executor._take_subscription": ("self sub", "msg_tuple"),
    "rclpy.executors:Executor._take_service": ("self srv", "request_and_header"),
    "rclpy.executors:Executor._take_client": ("self client", "header_and_response"),
    "rclpy.executors:Executor._take_waitable": ("self waitable", ""),
    "rclpy.executors:Executor.get_nodes": ("self", ""),
    "rclpy.executors:MultiThreadedExecutor.__init__": ("", "_futures _executor"),
    "rclpy.executors:ConditionReachedException": EXISTS,
    "rclpy.executors:TimeoutException": EXISTS,
    "rclpy.time_source:TimeSource.clock_callback": ("self msg", ""),
    "rclpy.time_source:TimeSource._subscribe_to_clock_topic": ("self", "_clock_sub"),
    "rclpy.time_source:TimeSource.ros_time_is_active": EXISTS,
    "rclpy.executors:Executor._make_handler": ("self entity node take_from_wait_list", "_guard"),
    "rclpy.executors:Executor.can_execute": ("self entity", "_executor_event"),
    "rclpy.executors:Executor.wake": ("self", "_guard trigger"),
    "rclpy.task:Future.__await__": ("self", "_pending result"),
    "rclpy.task:Future.add_done_callback": ("self callback", ""),
    "rclpy.task:Task.__call__": ("self", "_handler send"),
    "rclpy.task:Task.executing": ("self", "_executing"),
    "rclpy.guard_condition:GuardCondition.trigger": ("self", ""),
    "rclpy.wait_for_message:wait_for_message": ("msg_type node topic", "_rclpy WaitSet wait"),
    "rclpy.clock:Clock.sleep_until": ("self until context", "_rclpy ClockEvent set wait_until_ros"),
    "rclpy.clock:Clock.now": ("self", ""),
    "rclpy.timer:Rate.sleep": ("self", "_event wait"),
    "rclpy.node:Node.__init__": ("", "_publishers _subscriptions _time_source _guards"),
    "rclpy.node:Node.create_publisher": ("", "_rclpy Publisher"),
    "rclpy.node:Node.create_subscription": ("", "_rclpy Subscription"),
    "rclpy.node:Node.create_client": ("", "_rclpy Client"),
    "rclpy.node:Node.create_service": ("", "_rclpy Service"),
    "rclpy.node:Node.executor": EXISTS,
    "rclpy.node:Node.destroy_node": EXISTS,
    "rclpy.node:Node.get_publishers_info_by_topic": EXISTS,
    "rclpy.node:Node.destroy_publisher": EXISTS,
    "rclpy.node:Node.get_fully_qualified_name": ("self", ""),
    "rclpy.context:Context.shutdown": EXISTS,
    "rclpy.context:Context.get_domain_id": ("self", ""),
    "rclpy.publisher:Publisher.publish": ("self msg", ""),
    "rclpy.publisher:Publisher.get_subscription_count": ("self", ""),
    "rclpy.subscription:Subscription.get_publisher_count": ("self", ""),
    "rclpy.client:Client.call_async": ("self request", "_lock _pending_requests send_request"),
    "rclpy.client:Client.remove_pending_request": ("self future", ""),
    "rclpy.client:Client.service_is_ready": ("self", ""),
    "rclpy.service:Service.send_response": ("self response header", ""),
    "rclpy.impl.implementation_singleton:rclpy_implementation.rmw_qos_profile_t.to_dict": EXISTS,
    "rclpy.qos:QoSProfile.get_c_qos_profile": ("self", ""),
    "rclpy.impl.implementation_singleton:rclpy_implementation.Subscription": EXISTS,
    "rclpy.impl.rcutils_logger:RcutilsLogger.log": ("self message severity", "_rclpy rclpy_logging_rcutils_log"),
    "rclpy.impl.rcutils_logger:RcutilsLogger.get_child": ("self name", "rclpy_logging_rosout_add_sublogger"),
    "rclpy.impl.rcutils_logger:RcutilsLogger.__del__": ("self", "rclpy_logging_rosout_remove_sublogger"),
    "rclpy.impl.implementation_singleton:rclpy_implementation.rclpy_resolve_name": EXISTS,
}
CLOCK = "/clock"  # the grader sends it again until it is seen

_monitor: ExecutorMonitor | None = None


def monitor() -> ExecutorMonitor:
    """Return the monitor of this process. rclpy must have been imported."""
    assert _monitor is not None
    return _monitor


def install() -> None:
    """Start to watch this process. Raises ImportError if the imported rclpy is not the one expected."""
    global _monitor
    if found := misfits(RELIED_UPON):
        raise ImportError(f"this rclpy cannot be kept in step: {found[0]}")
    topics = json.loads(os.environ.get(TOPICS, "{}"))
    _monitor = ExecutorMonitor(channel(), topics, bool(os.environ.get(HOLD)))
    _monitor.listen()  # in a thread that is not watched
    install_threads(_monitor.threads)
    watch_waits(_monitor)
    _watch_messages(_monitor)
    _watch_nodes(_monitor)
    _make_subscriptions_reliable(_monitor)
    watch_services(_monitor)
    watch_logging(_monitor)
    channel().send({"ros": True})
    atexit.register(_monitor.flush)
    sys.excepthook = lambda kind, error, trace: print_traceback(error)


def _watch_messages(monitor: ExecutorMonitor) -> None:
    """Patch every publish, every take and every destruction of a publisher."""
    from rclpy.context import Context
    from rclpy.executors import Executor
    from rclpy.node import Node
    from rclpy.publisher import Publisher
    from rclpy.serialization import deserialize_message, serialize_message

    take, publish = Executor._take_subscription, Publisher.publish

    def watched_take(executor: Any, subscription: Any) -> Any:
        if has_kept(subscription):
            fill("subscription", subscription, monitor._took_subscription)
            return take(executor, Kept(subscription, kept(subscription).popleft()))
        callback = take(executor, subscription)
        if callback is None:
            return None
        topic = monitor.topic_of(subscription)
        if is_copy(subscription, variables_of(callback)["msg_tuple"][0]) and topic in monitor.again:
            return None
        monitor.count(monitor.taken, topic)
        return callback

    def emit(publisher: Any, message: Any) -> None:
        readers = publisher.get_subscription_count()
        publish(publisher, message)
        monitor.history.count(publisher)
        if readers:
            topic = monitor.topic_of(publisher)
            monitor.count(monitor.delivered, topic, readers)
            # A best-effort publisher never matches the grader's subscriptions.
            if publisher.qos_profile.reliability.name != "BEST_EFFORT":
                monitor.count(monitor.published, topic)
            for subscription in monitor.local_subscriptions(topic):
                nudge(monitor, monitor.executor_of(subscription))

    def lose(publisher: Any, message: Any) -> None:
        """Publish to nobody but this process and to those who join later and ask for what was before."""
        topic = monitor.topic_of(publisher)
        monitor.count(monitor.lost, topic)
        if publisher.qos_profile.durability.name == "TRANSIENT_LOCAL":
            monitor.announce_early(topic)
            publish(publisher, message)
            monitor.history.count(publisher)
            return
        for subscription in monitor.local_subscriptions(topic):
            if subscription.msg_type is publisher.msg_type and hears(subscription, publisher):
                data = message if isinstance(message, bytes) else serialize_message(message)
                own = data if subscription.raw else deserialize_message(data, subscription.msg_type)
                kept(subscription).append((own, {"source_timestamp": 0, "received_timestamp": 0}))
                nudge(monitor, monitor.executor_of(subscription))

    def watched_publish(publisher: Any, message: Any) -> None:
        if publisher.topic in HOUSEKEEPING or not isinstance(message, publisher.msg_type | bytes):
            publish(publisher, message)
        elif not monitor.await_match(publisher):
            lose(publisher, message)
        elif not monitor.holds:
            emit(publisher, message)
        else:
            # Serialized at once, because the caller may change the message later.
            data = message if isinstance(message, bytes) else serialize_message(message)
            monitor.hold(lambda: emit(publisher, data))

    def flushed(function: Any) -> Any:
        def after_flush(*args: Any, **kwargs: Any) -> Any:
            monitor.flush()
            return function(*args, **kwargs)

        return after_flush

    # A writer that is destroyed discards messages that its reader has not taken yet.
    for owner, name in ((Node, "destroy_node"), (Node, "destroy_publisher"), (Context, "shutdown")):
        setattr(owner, name, flushed(getattr(owner, name)))
    Executor._take_subscription = watched_take
    Publisher.publish = watched_publish


def hears(subscription: Any, publisher: Any) -> bool:
    """Return whether a subscription gets what a publisher of the same topic and type sends."""
    asked, offered = subscription.qos_profile, publisher.qos_profile
    return (asked.reliability.name != "RELIABLE" or offered.reliability.name != "BEST_EFFORT") and (
        asked.durability.name != "TRANSIENT_LOCAL" or offered.durability.name == "TRANSIENT_LOCAL"
    )


def _watch_nodes(monitor: ExecutorMonitor) -> None:
    """Patch the beginning and the end of nodes, and what makes endpoints: it may wait in DDS, for a lock or a file."""
    from rclpy.node import Node

    for name in ("__init__", "create_publisher", "create_subscription", "create_client", "create_service"):
        setattr(Node, name, monitor.threads.working(getattr(Node, name)))
    for name in ("create_publisher", "create_subscription"):
        setattr(Node, name, _marking(getattr(Node, name)))
    begin, destroy = Node.__init__, Node.destroy_node

    def watched_begin(node: Any, *arguments: Any, **options: Any) -> None:
        begin(node, *arguments, **options)
        monitor.add_node(node)

    def watched_destroy(node: Any) -> None:
        destroy(node)
        monitor.remove_node(node)

    Node.__init__, Node.destroy_node = watched_begin, watched_destroy


def _marking(create: Any) -> Any:
    """Return a function that makes the same endpoint, which says in which domain it is."""

    @functools.wraps(create)
    def marked(node: Any, *arguments: Any, **options: Any) -> Any:
        endpoint = create(node, *arguments, **options)
        other_domains.mark(endpoint, node)
        return endpoint

    return marked


def _make_subscriptions_reliable(monitor: ExecutorMonitor) -> None:
    """Make subscriptions lose nothing of what the grader publishes reliably, whatever reliability they ask for.

    A picture crosses the network in dozens of fragments. A lost fragment is sent again to a reliable reader; a
    best-effort reader loses the whole picture, and lock-step would wait for it in vain. How many are lost depends on
    how busy the machine is. So where the grader publishes reliably, a best-effort subscription reads reliably.
    Elsewhere its QoS stays, because QoS decides which endpoints match; there the grader sends a lost message again, and
    readers that had it already drop the copy (`is_copy`). What a node knows about its subscriptions
    (`qos_profile`, parameters) stays what it asked for.
    """
    from rclpy.impl.implementation_singleton import rclpy_implementation as rcl

    subscription = rcl.Subscription
    simulated = bool(os.environ.get(SIMULATED_CLOCKS))

    def lossless_subscription(node: Any, kind: Any, topic: str, profile: Any) -> Any:
        name = rcl.rclpy_resolve_name(node, topic, False, False)
        apart = any(each.handle is node and other_domains.apart(each) for each in monitor.nodes)
        if name != CLOCK and not apart and monitor.sent_reliably(name, type_name(kind)):
            profile = _reliable(profile)
        return subscription(node, kind, topic, _unlimited(profile) if simulated else profile)

    rcl.Subscription = lossless_subscription


def _reliable(profile: Any) -> Any:
    """Return the same profile, but reliable instead of best effort."""
    from rclpy.qos import QoSProfile, ReliabilityPolicy

    asked = QoSProfile(**profile.to_dict())
    if asked.reliability != ReliabilityPolicy.BEST_EFFORT:
        return profile
    asked.reliability = ReliabilityPolicy.RELIABLE
    return asked.get_c_qos_profile()


def _unlimited(profile: Any) -> Any:
    """Return the same profile, but with room for all that publishers keep for those who join late, if it asks for that.

    It comes at once, and how much of it a node has taken when the next piece comes depends on the machine.
    """
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile

    if profile.to_dict()["durability"] != DurabilityPolicy.TRANSIENT_LOCAL:
        return profile
    asked = QoSProfile(**profile.to_dict())
    if not kept_depth(asked):
        return profile
    asked.history = HistoryPolicy.KEEP_ALL
    return asked.get_c_qos_profile()
