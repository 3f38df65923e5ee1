"""The live ROS graph, as seen by a node of the command.

There is no daemon that already knows the graph. Verbs that list wait until every DDS participant of this machine is
known (`discovery`) with all its nodes and endpoints and nothing changes any more (`settle`, or `--spin-time`); verbs
with a target continue as soon as it is found (`wait_for`), or report that it is missing once all participants are
known. Every wait has a deadline. Discovery takes the time of the machine (`machine_clock`); what is awaited while data
is processed (`spin_until`) takes that of the world.
"""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Callable, Iterable
from types import TracebackType
from typing import Any, TypeVar

import rclpy
from rclpy.action.graph import get_action_names_and_types
from rclpy.executors import SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from gz_course.sim import machine_clock
from gz_course.sim.ros.ros2.discovery import Participants
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.exit_deadline import end_within
from gz_course.sim.ros.ros2.interruption import check
from gz_course.sim.ros.ros2.option_values import seconds

FIRST_CONTACT = 3.3  # [s] within which every node announces itself to a new one
OTHER_MACHINES = 0.5  # [s] for answers over a network
QUIET = 0.2  # [s] without a change after which a graph counts as complete
SETTLE_DEADLINE = 6.0  # [s] for a graph that never stops changing
TARGET_DEADLINE = 5.0  # [s] for a target named by the user
GIVE_UP = 2.0  # [s] after which a target is missing if all participants are known; its node may just be starting
_POLL = 0.02  # [s]; the graph reports changes only to a spinning executor, and not all of them
UNKNOWN_NODE = "_NODE_NAME_UNKNOWN_"  # an endpoint whose node has not been announced yet

Found = TypeVar("Found")
NamesAndTypes = list[tuple[str, list[str]]]
_ended: list[Graph] = []  # their nodes are still to be destroyed


def add_graph_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of every verb that looks at the graph."""
    parser.add_argument(
        "--spin-time", type=seconds, metavar="SECONDS", help="Time to wait for discovery (default: as needed)"
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time")
    parser.add_argument("--no-daemon", action="store_true", help="Accepted and ignored: there is no daemon")


def is_hidden(name: str) -> bool:
    """Return whether a part of the name begins with _."""
    return any(part.startswith("_") for part in name.split("/"))


def destroy_ended(exit_code: int | None = None) -> None:
    """Destroy the nodes of all graphs whose `with` block has ended.

    A process that ends with `exit_code` then does so even if DDS blocks.
    """
    if _ended and exit_code is not None:
        end_within(exit_code)
    while _ended:
        _ended.pop().destroy()


class Graph:
    """A context manager for the graph as seen by its own hidden node (`_ros2cli_<pid>`).

    The node lives on until `destroy_ended`, so that what a command prints last is out before DDS can block.
    """

    def __init__(self, arguments: argparse.Namespace, node_name: str | None = None) -> None:
        self._spin_time: float | None = arguments.spin_time
        self._context = rclpy.Context()
        # Shared memory outlives a killed process and can block the next one; every node speaks UDP, too.
        os.environ.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
        try:
            # No log file is written, so that no writable home is needed; Python keeps its signal handlers.
            rclpy.init(
                args=["--ros-args", "--disable-external-lib-logs"],
                context=self._context,
                signal_handler_options=SignalHandlerOptions.NO,
            )
            self._participants = Participants(self._context.get_domain_id())
            self.node: Any = Node(
                node_name or f"_ros2cli_{os.getpid()}",
                context=self._context,
                use_global_arguments=False,
                start_parameter_services=False,
                parameter_overrides=[
                    Parameter("start_type_description_service", value=False),
                    Parameter("use_sim_time", value=arguments.use_sim_time),
                ],
            )
        except (rclpy_implementation.RCLError, ValueError) as error:
            raise CommandError(f"ROS did not start: {str(error).splitlines()[0]}") from None
        self._executor: Any = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self._participants.attach(self.node)
        self._created = machine_clock.now()
        self._seen: Any = None
        self._changed = self._created

    def __enter__(self) -> Graph:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._executor.shutdown(timeout_sec=0.5)
        _ended.append(self)

    def destroy(self) -> None:
        """Destroy the node; DDS may block meanwhile."""
        for waitable in list(self.node.waitables):
            waitable.destroy()  # such as a client of an action, which a node does not destroy itself
        self.node.destroy_node()
        self._context.try_shutdown()

    def spin_once(self, timeout: float = 0.1) -> None:
        """Process received data, waiting up to `timeout` [s] for it."""
        self._executor.spin_once(timeout_sec=timeout)
        check()

    def spin_until(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Process received data until the condition is true; return False if it is not within `timeout` [s]."""
        end = None if timeout is None else time.monotonic() + timeout
        while not condition():
            left = 0.1 if end is None else min(0.1, end - time.monotonic())
            if left <= 0:
                return False
            self.spin_once(left)
        return True

    def spin_for(self, duration: float) -> None:
        """Process received data for `duration` [s]."""
        self.spin_until(lambda: False, duration)

    def topics(self, hidden: bool = False) -> NamesAndTypes:
        """Return topics and their types, both sorted."""
        return _shown(self.node.get_topic_names_and_types(), hidden)

    def services(self, hidden: bool = False) -> NamesAndTypes:
        """Return services and their types, both sorted."""
        return _shown(self.node.get_service_names_and_types(), hidden)

    def actions(self, hidden: bool = True) -> NamesAndTypes:
        """Return actions and their types, both sorted; ROS 2 lists hidden ones, too."""
        return _shown(get_action_names_and_types(self.node), hidden)

    def nodes(self, hidden: bool = False) -> list[str]:
        """Return the full names of the nodes, sorted, with duplicates."""
        names = (_join(namespace, name) for name, namespace in self.node.get_node_names_and_namespaces())
        own = self.node.get_fully_qualified_name()
        return sorted(name for name in names if name != own and (hidden or not is_hidden(name)))

    def settle(self, deadline: float = SETTLE_DEADLINE) -> None:
        """Wait until the graph seems complete, at most `deadline` [s], or exactly --spin-time."""
        if self._spin_time is not None:
            end = self._created + self._spin_time
            # Called each time, because it also sends scouts to missing participants.
            self._wait(lambda: (self._participants.all_known(), machine_clock.now() >= end)[1], self._spin_time)
        else:
            self._wait(lambda: self._complete(QUIET), deadline)

    def wait_for(self, find: Callable[[], Found], timeout: float | None = None) -> Found:
        """Return the first true result of `find`; with --spin-time its result after exactly that time.

        It is looked for until it seems to be missing, or for exactly `timeout` [s].
        """
        if self._spin_time is not None:
            self.settle()
        elif timeout is not None:
            # Called each time, because it also sends scouts.
            self._wait(lambda: (self._participants.all_known(), bool(find()))[1], timeout)
        else:
            given_up = self._created + GIVE_UP

            def decided() -> bool:
                complete = self._complete(QUIET)  # called each time, because it also sends scouts
                return bool(find()) or (complete and machine_clock.now() >= given_up)

            self._wait(decided, TARGET_DEADLINE)
        return find()

    def wait_for_topic(self, name: str) -> list[str]:
        """Return the types of a topic when its endpoints are known; empty if it does not appear."""
        if self.wait_for(lambda: self._types(name)) and self._spin_time is None:
            self._wait(lambda: self._complete(QUIET / 2), 1.0)
        return self._types(name)

    def wait_for_publisher(self, name: str, timeout: float) -> bool:
        """Return whether a publisher of the topic appears within `timeout` [s]."""
        return self._wait(lambda: self._participants.all_known() and self.node.count_publishers(name) > 0, timeout)

    def _types(self, name: str) -> list[str]:
        return dict(self.topics(hidden=True)).get(name, [])

    def _wait(self, condition: Callable[[], bool | None], timeout: float) -> bool:
        end = machine_clock.now() + timeout
        while not condition():
            left = end - machine_clock.now()
            if left <= 0:
                return False
            machine_clock.pause(min(_POLL, left))
            check()
        return True

    def _complete(self, quiet: float) -> bool:
        """Return whether all participants and their endpoints are known, and nothing has changed for `quiet` [s]."""
        now, seen = machine_clock.now(), self._snapshot()
        if seen != self._seen:
            self._seen, self._changed = seen, now
        all_known = self._participants.all_known()
        earliest = self._created + (OTHER_MACHINES if _listens_to_other_machines() else 0.0)
        if all_known is not True:
            # Unknown, or a participant does not answer: a program that is no ROS node, or one that hangs.
            earliest = self._created + FIRST_CONTACT
        nodes, endpoints, _ = seen
        # A node and its endpoints arrive separately in any order; both must be known.
        whole = nodes == {node for _, node, _ in endpoints}
        return whole and now >= max(earliest, self._changed + quiet)

    def _snapshot(self) -> tuple[set[str], set[tuple[str, str, str]], set[str]]:
        """Return the other nodes, (topic, node, GUID) of their endpoints, and all services."""
        own = self.node.get_fully_qualified_name()
        endpoints = set()
        for topic, _ in self.node.get_topic_names_and_types():
            for ends in (self.node.get_publishers_info_by_topic, self.node.get_subscriptions_info_by_topic):
                for end in ends(topic):
                    known = UNKNOWN_NODE not in (end.node_name, end.node_namespace)
                    name = _join(end.node_namespace, end.node_name) if known else ""
                    endpoints.add((topic, name, bytes(end.endpoint_gid).hex()))
        services = {name for name, _ in self.node.get_service_names_and_types()}
        return set(self.nodes(hidden=True)), {end for end in endpoints if end[1] != own}, services


def _join(namespace: str, name: str) -> str:
    return f"{namespace.rstrip('/')}/{name}"


def _shown(found: Iterable[tuple[str, list[str]]], hidden: bool) -> NamesAndTypes:
    return sorted((name, sorted(types)) for name, types in found if hidden or not is_hidden(name))


def _listens_to_other_machines() -> bool:
    reach = os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE", "").upper()
    if os.environ.get("ROS_LOCALHOST_ONLY") == "1":
        return False
    return reach not in ("LOCALHOST", "OFF") or bool(os.environ.get("ROS_STATIC_PEERS"))
