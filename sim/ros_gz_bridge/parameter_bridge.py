"""The command ``parameter_bridge``: bridges Gazebo and ROS topics until it is interrupted.

It reads the command line and the YAML file (``config``), starts one ROS node and one Gazebo node, and lets
``bridge.Bridge`` work between them. Everything wrong is said before anything runs: one sentence a fault, exit
code 2. Importing this module loads nothing heavy, so that ``main`` can hold back signals from the very start.
"""

from __future__ import annotations

import difflib
import os
import signal
import sys
import threading
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rclpy.node import Node

    from ros_gz_bridge.entry import BridgeEntry

HELP = """\
usage: parameter_bridge TOPIC@ROS_TYPE@GZ_TYPE ... [--ros-args ...]
       parameter_bridge --ros-args -p config_file:=FILE

Bridges topics between Gazebo and ROS 2. The mark between the two types is the direction:
  @  both ways          [  from Gazebo to ROS          ]  from ROS to Gazebo
Quote each argument: some shells give [ a meaning of their own.

  parameter_bridge '/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist' \\
                   '/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'

ROS parameters (after --ros-args, each as -p name:=value):
  config_file                         YAML list of bridges; not together with bridges on the command line
  lazy                                true: connect a bridge only while somebody listens (default false)
  subscription_heartbeat              how often lazy bridges look for listeners, in ms (default 1000)
  override_frame_id                   frame_id of every message that goes to ROS
  override_timestamps_with_wall_time  true: stamp messages that go to ROS with the system clock
  qos_overrides./TOPIC.publisher.durability and the like, as for any node
To give a topic another name in ROS: -r /gz/name:=/ros/name
"""

_DEFAULTS: dict[str, Any] = {
    "config_file": "",
    "lazy": False,
    "subscription_heartbeat": 1000,
    "override_frame_id": "",
    "override_timestamps_with_wall_time": False,
}
_WORDS = {str: "a text", bool: "true or false", int: "a whole number"}
_STOP_SIGNALS = {signal.SIGINT, signal.SIGTERM}


class _UsageError(Exception):
    """Faults of the command line or the configuration, one sentence each."""

    def __init__(self, errors: Iterable[str]) -> None:
        self.errors = list(errors)
        super().__init__("\n".join(self.errors))


def main(argv: list[str] | None = None) -> int:
    """Run the bridge until SIGINT or SIGTERM: exit code 0; 2 if it could not start, 1 if it broke."""
    # Signals are blocked in every thread and fetched by one sigwait: none is lost in a library's wait set,
    # none
    # strikes in the middle of setting up, and one the parent ignores (a shell's '&') is heard: Linux keeps a
    # blocked signal whatever its handler.
    signal.pthread_sigmask(signal.SIG_BLOCK, _STOP_SIGNALS)
    argv = sys.argv if argv is None else ["parameter_bridge", *argv]
    if len(argv) == 1 or {"-h", "--help"} & set(argv[1:]):
        print(HELP, end="")
        return 0 if len(argv) > 1 else 2
    try:
        return _run(argv)
    except _UsageError as error:
        for sentence in error.errors:
            print(f"parameter_bridge: {sentence}", file=sys.stderr)
        return 2


def _run(argv: list[str]) -> int:
    import rclpy
    from rclpy.impl.implementation_singleton import rclpy_implementation
    from rclpy.signals import SignalHandlerOptions
    from rclpy.utilities import remove_ros_args

    from ros_gz_bridge.bridge import error_text
    from ros_gz_bridge.config import ConfigError, parse_arguments

    context = rclpy.Context()
    try:
        topics = remove_ros_args(argv)[1:]
        entries = parse_arguments(topics)
        rclpy.init(args=argv, context=context, signal_handler_options=SignalHandlerOptions.NO)
    except ConfigError as error:
        raise _UsageError(error.errors) from None
    except rclpy_implementation.UnknownROSArgsError as error:
        raise _UsageError([f"ROS does not know these arguments after --ros-args: {error}"]) from None
    except Exception as error:
        raise _UsageError([f"ROS did not start: {error_text(error)}"]) from None
    try:
        node = rclpy.create_node("ros_gz_bridge", context=context, automatically_declare_parameters_from_overrides=True)
        try:
            return _bridge(node, entries)
        finally:
            node.destroy_node()
    finally:
        context.try_shutdown()


def _bridge(node: Node, entries: list[BridgeEntry]) -> int:
    """Set the bridges up, wait for a signal, take them down."""
    from rclpy.executors import SingleThreadedExecutor

    from gz.transport import Node as GzNode
    from ros_gz_bridge import bridged_topics
    from ros_gz_bridge.bridge import Bridge, BridgeError, HeaderOverrides

    parameters = _read_parameters(node)
    entries = _all_entries(entries, parameters)
    logger = node.get_logger()
    overrides = HeaderOverrides(
        frame_id=parameters["override_frame_id"], wall_time=parameters["override_timestamps_with_wall_time"]
    )
    with GzNode() as gz_node:
        for line in _creation_lines(entries):
            logger.info(line)
        try:
            bridge = Bridge(
                node,
                gz_node,
                entries,
                overrides=overrides,
                heartbeat=parameters["subscription_heartbeat"] / 1000,
            )
        except BridgeError as error:
            raise _UsageError(error.errors) from None
        for sentence in [*_parameter_advice(node, entries), *_entry_advice(entries)]:
            logger.warning(sentence)
        bridged_topics.offer(node, entries)
        executor = SingleThreadedExecutor(context=node.context)
        executor.add_node(node)
        spinner = _Spinner(executor)
        spinner.start()
        logger.info(f"ready: {len(entries)} bridge{'s' if len(entries) != 1 else ''}")
        signal.sigwait(_STOP_SIGNALS)
        executor.shutdown(timeout_sec=0.5)
        spinner.join(0.5)
        bridge.close()
    return 1 if spinner.broken else 0


class _Spinner(threading.Thread):
    """Runs the ROS callbacks; ends the process if the executor breaks."""

    def __init__(self, executor: Any) -> None:
        super().__init__(name="ros_executor", daemon=True)
        self._executor = executor
        self.broken = False

    def run(self) -> None:
        """Spin until the executor is shut down."""
        from rclpy.executors import ExternalShutdownException, ShutdownException

        from ros_gz_bridge.bridge import error_text

        try:
            self._executor.spin()
        except (ExternalShutdownException, ShutdownException):
            pass
        except Exception as error:
            self.broken = True
            print(f"parameter_bridge: the ROS executor broke: {error_text(error)}", file=sys.stderr)
            os.kill(os.getpid(), signal.SIGTERM)


def _read_parameters(node: Node) -> dict[str, Any]:
    values = dict(_DEFAULTS)
    errors = []
    for name, default in _DEFAULTS.items():
        if not node.has_parameter(name):
            continue
        value = node.get_parameter(name).value
        if type(value) is not type(default):
            errors.append(f"the parameter {name} must be {_WORDS[type(default)]}, not {value!r}")
        elif name == "subscription_heartbeat" and value <= 0:
            errors.append(f"the parameter {name} must be a number of ms above 0, not {value}")
        else:
            values[name] = value
    if errors:
        raise _UsageError(errors)
    return values


def _all_entries(entries: list[BridgeEntry], parameters: dict[str, Any]) -> list[BridgeEntry]:
    """The bridges of the command line, or those of the file."""
    from ros_gz_bridge.config import ConfigError, load_yaml

    config_file, lazy = parameters["config_file"], parameters["lazy"]
    if entries and config_file:
        raise _UsageError(
            [
                f"bridges are given on the command line and in {config_file}, which ros_gz_bridge would then "
                "not read; put all of them in one place"
            ]
        )
    if entries:
        return [replace(entry, lazy=lazy) for entry in entries]
    if not config_file:
        raise _UsageError(["nothing to bridge; give bridges as arguments or -p config_file:=FILE (see --help)"])
    try:
        entries = load_yaml(config_file, lazy=lazy)
    except ConfigError as error:
        raise _UsageError(error.errors) from None
    if not entries:
        raise _UsageError([f"{config_file}: the list of bridges is empty"])
    return entries


def _parameter_advice(node: Node, entries: list[BridgeEntry]) -> Iterator[str]:
    """Parameters that change nothing: unknown names, and QoS overrides of endpoints that do not exist."""
    endpoints = []
    for entry in entries:
        topic = node.resolve_topic_name(entry.ros_topic)
        if entry.direction.to_ros:
            endpoints.append(f"qos_overrides.{topic}.publisher.")
        if entry.direction.to_gz:
            endpoints.append(f"qos_overrides.{topic}.subscription.")
    for name in sorted(node.get_parameters_by_prefix("")):
        if name.startswith("qos_overrides."):
            if not name.startswith(tuple(endpoints)):
                nearest = difflib.get_close_matches(name, endpoints, n=1, cutoff=0.0)
                hint = f"; did you mean {nearest[0]}{name.rpartition('.')[2]}?" if nearest else ""
                yield f"the parameter {name} names no endpoint of this bridge and changes nothing{hint}"
        elif name not in _DEFAULTS and name not in _NODE_PARAMETERS:
            nearest = difflib.get_close_matches(name, _DEFAULTS, n=1)
            hint = f"; did you mean {nearest[0]}?" if nearest else ""
            yield f"the parameter {name} is not known here and changes nothing{hint}"


_NODE_PARAMETERS = {"use_sim_time", "start_type_description_service"}


def _entry_advice(entries: list[BridgeEntry]) -> Iterator[str]:
    """Bridges that work as written and yet surprise."""
    from ros_gz_bridge.entry import Direction

    for entry in entries:
        if entry.ros_type == "rosgraph_msgs/msg/Clock" and entry.direction is not Direction.GZ_TO_ROS:
            yield (
                f"{entry.source}: publishes {entry.gz_topic} in Gazebo too, and Gazebo then keeps its "
                "own clock "
                "off that topic; bridge a clock from Gazebo to ROS only ([ or direction: GZ_TO_ROS)"
            )


def _creation_lines(entries: list[BridgeEntry]) -> Iterator[str]:
    """What ros_gz_bridge says for each direction of a bridge."""
    for entry in entries:
        gz, ros = f"{entry.gz_topic} ({entry.gz_type})", f"{entry.ros_topic} ({entry.ros_type})"
        if entry.direction.to_ros:
            yield f"Creating GZ->ROS Bridge: [{gz} -> {ros}] (Lazy {int(entry.lazy)})"
        if entry.direction.to_gz:
            yield f"Creating ROS->GZ Bridge: [{ros} -> {gz}] (Lazy {int(entry.lazy)})"


if __name__ == "__main__":
    sys.exit(main())
