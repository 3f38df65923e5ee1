"""A node that looks at the live ROS graph: what `ros2 topic`, `ros2 node` and the like stand on.

There is no daemon that would know the graph already, and Fast DDS answers a newcomer at once or, every third
time, only with its next announcement: nodes repeat theirs every 3 s. Verbs that list wait until everybody has
had a turn and nothing changes any more (`settle`, or `--spin-time` for those in a hurry); verbs with a target
go on as soon as it is there (`wait_for_topic`). Everything has a deadline.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from ros2.errors import CommandError

FIRST_CONTACT = 3.3  # s within which every node there is has announced itself to a new one
QUIET = 0.3  # s without a change after which a graph counts as complete
SETTLE_DEADLINE = 6.0  # s for a graph that never stops changing
TARGET_DEADLINE = 5.0  # s for the topic a user has named
_POLL = 0.05  # s; the graph announces changes only to a spinning executor, and not all of them
_UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"  # an endpoint whose node has not been announced yet


def add_graph_options(parser: argparse.ArgumentParser) -> None:
    """The options of every verb that looks at the graph."""
    parser.add_argument(
        "--spin-time", type=float, metavar="SECONDS", help="Time to wait for discovery (default: as needed)"
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time")
    parser.add_argument("--no-daemon", action="store_true", help="Accepted and ignored: there is no daemon")


def is_hidden(name: str) -> bool:
    """Names with a part that begins with _ are shown on request only."""
    return any(part.startswith("_") for part in name.split("/"))


class Graph:
    """The graph as seen by a node of its own, hidden one (`_ros2cli_<pid>`); a context manager."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._spin_time: float | None = arguments.spin_time
        self._context = rclpy.Context()
        # Shared memory outlives a process that is killed and can block the next one; every node speaks UDP too.
        os.environ.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
        try:
            # No log file is written, so that no writable home is needed; signals stay Python's.
            rclpy.init(
                args=["--ros-args", "--disable-external-lib-logs"],
                context=self._context,
                signal_handler_options=SignalHandlerOptions.NO,
            )
        except rclpy_implementation.RCLError as error:
            raise CommandError(f"ROS did not start: {error}") from None
        self.node: Any = Node(
            f"_ros2cli_{os.getpid()}",
            context=self._context,
            use_global_arguments=False,
            start_parameter_services=False,
            parameter_overrides=[
                Parameter("start_type_description_service", value=False),
                Parameter("use_sim_time", value=arguments.use_sim_time),
            ],
        )
        self._executor: Any = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._born = time.monotonic()

    def __enter__(self) -> Graph:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._executor.shutdown(timeout_sec=0.5)
        self.node.destroy_node()
        self._context.try_shutdown()

    def spin_once(self, timeout: float = 0.1) -> None:
        """Run what has arrived, waiting up to `timeout` seconds for it."""
        self._executor.spin_once(timeout_sec=timeout)

    def topics(self, hidden: bool = False) -> list[tuple[str, list[str]]]:
        """Topics and their types, both sorted."""
        return sorted(
            (name, types) for name, types in self.node.get_topic_names_and_types() if hidden or not is_hidden(name)
        )

    def settle(self) -> None:
        """Wait until the graph is complete as far as one can tell, or exactly --spin-time."""
        if self._spin_time is not None:
            end = self._born + self._spin_time
            self._wait(lambda: time.monotonic() >= end, self._spin_time)
            return
        self._settle(self._born + FIRST_CONTACT, QUIET, SETTLE_DEADLINE)

    def wait_for_topic(self, name: str) -> list[str]:
        """The types of a topic as soon as it is there, or after exactly --spin-time; empty if it does not come."""
        if self._spin_time is not None:
            self.settle()
        elif self._wait(lambda: bool(self._types(name)), TARGET_DEADLINE):
            self._settle(0.0, 0.2, 1.0)
        return self._types(name)

    def wait_for_publisher(self, name: str, timeout: float) -> bool:
        """Whether somebody publishes on a topic within `timeout` seconds."""
        return self._wait(lambda: bool(self.node.count_publishers(name)), timeout)

    def _types(self, name: str) -> list[str]:
        return dict(self.topics(hidden=True)).get(name, [])

    def _wait(self, condition: Callable[[], bool], timeout: float) -> bool:
        end = time.monotonic() + timeout
        while not condition():
            left = end - time.monotonic()
            if left <= 0:
                return False
            time.sleep(min(_POLL, left))
        return True

    def _settle(self, earliest: float, quiet: float, deadline: float) -> None:
        seen = self._snapshot()
        changed = time.monotonic()

        def complete() -> bool:
            nonlocal seen, changed
            now = self._snapshot()
            if now != seen:
                seen, changed = now, time.monotonic()
            nodes, endpoints = seen
            # A node is known a moment before its endpoints, or they before it: both must have arrived.
            whole = nodes == {node for _, node, _ in endpoints}
            return whole and time.monotonic() >= max(earliest, changed + quiet)

        self._wait(complete, deadline)

    def _snapshot(self) -> tuple[set[str], set[tuple[str, str, str]]]:
        """The other nodes, and (topic, node, endpoint's identifier) of their endpoints."""
        own = self.node.get_fully_qualified_name()
        nodes = {f"{namespace.rstrip('/')}/{name}" for name, namespace in self.node.get_node_names_and_namespaces()}
        endpoints = set()
        for topic, _ in self.node.get_topic_names_and_types():
            for ends in (self.node.get_publishers_info_by_topic, self.node.get_subscriptions_info_by_topic):
                for end in ends(topic):
                    name = f"{end.node_namespace.rstrip('/')}/{end.node_name}"
                    known = _UNKNOWN_NODE not in (end.node_name, end.node_namespace)
                    endpoints.add((topic, name if known else "", bytes(end.endpoint_gid).hex()))
        return nodes - {own}, {end for end in endpoints if end[1] != own}
