"""A node that looks at the ROS graph for a check, and its waits: each ends with the event that it waits for.

Nodes find each other within a second on an idle machine, and within several on a busy one: an announcement that is lost
is made again after seconds. So a wait for what should be there is long, and costs its length only if it is not there.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable, Iterator
from typing import Any

from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.sandbox.resource_monitor import descendants

NAME = "step"
FOUND = 20.0  # [s] until any node is found at all
SEEN = 8.0  # [s] from the first node found to the last
BOTH = 5.0  # [s] from one end of a node's topic to its other end
ANEW = 9  # times the deadline that a wait lasts at most, however crowded the machine

SpinUntil = Callable[[Callable[[], bool], float], None]


@contextlib.contextmanager
def observer() -> Iterator[tuple[Any, SpinUntil]]:
    """Give a node of its own, and a function that spins it until something holds or a deadline [s] has passed.

    Time in which this process and its programs wait for a processor does not count.
    """
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.signals import SignalHandlerOptions

    clock = FairClock(lambda: [os.getpid(), *descendants(os.getpid())])
    context = rclpy.Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        node = rclpy.create_node(NAME, context=context, enable_rosout=False, start_parameter_services=False)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)

        def spin_until(holds: Callable[[], bool], deadline: float) -> None:
            patience, end = Patience(clock, deadline), time.monotonic() + ANEW * deadline
            while not holds() and not patience.over() and time.monotonic() < end:
                executor.spin_once(timeout_sec=min(deadline, 0.1))

        yield node, spin_until
        executor.shutdown()
        node.destroy_node()
    finally:
        rclpy.shutdown(context=context)


def until_found(node: Any, spin_until: SpinUntil, holds: Callable[[], bool]) -> None:
    """Spin until something about other nodes holds, at most `SEEN` seconds from the first that is found."""
    spin_until(lambda: holds() or _others(node), FOUND)
    spin_until(holds, SEEN)


def until_known(node: Any, spin_until: SpinUntil, topic: str) -> None:
    """Spin until the publisher of a topic has found what `node` has made so far, so that no message is lost.

    Its node is asked for a parameter: DDS announces in order, so who answers has heard of what was made before.
    """
    from rcl_interfaces.srv import GetParameters

    until_found(node, spin_until, lambda: named(node.get_publishers_info_by_topic(topic)))
    for end in node.get_publishers_info_by_topic(topic)[:1]:
        service = f"{end.node_namespace.rstrip('/')}/{end.node_name}/get_parameters"
        client = node.create_client(GetParameters, service)
        spin_until(client.service_is_ready, SEEN)
        answer = client.call_async(GetParameters.Request(names=["use_sim_time"]))
        spin_until(answer.done, SEEN)
        node.destroy_client(client)


def named(ends: list[Any]) -> bool:
    """Tell whether there are ends of a topic, and the node of each is known by now."""
    return bool(ends) and all(each.node_name and "UNKNOWN" not in each.node_name for each in ends)


def both_ways(node: Any, spin_until: SpinUntil, topic: str) -> set[str]:
    """Return the nodes that publish a topic and also subscribe to it, as a bridge in both directions does."""

    def ends() -> tuple[list[Any], ...]:
        some = node.get_publishers_info_by_topic(topic), node.get_subscriptions_info_by_topic(topic)
        return tuple([each for each in those if each.node_name != NAME] for those in some)

    def both() -> set[str]:
        publishers, subscribers = ({each.node_name for each in some if named([each])} for some in ends())
        return publishers & subscribers

    until_found(node, spin_until, lambda: any(named(some) for some in ends()))
    spin_until(lambda: bool(both()), BOTH)
    return both()


def _others(node: Any) -> bool:
    """Tell whether another node is known. Those of the ROS commands, which are hidden, do not count."""
    return any(name != NAME and not name.startswith("_") for name in node.get_node_names())
