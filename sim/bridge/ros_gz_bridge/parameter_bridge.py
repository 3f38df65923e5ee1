"""The program `parameter_bridge`, which bridges Gazebo and ROS topics until it is interrupted.

It reads the command line, the ROS parameters and the YAML file, and runs `bridge.Bridge` between one ROS node and one
Gazebo node. All faults of the configuration are reported at the start. Where the original leaves out a bridge or makes
it in spite of the fault, so does this one; where the original ends, and with `--strict` after any error, nothing is
started and the exit code is 2. Importing this module loads no ROS, so that `ros_program.program.run` handles signals
from the start.

Source: README.md, src/parameter_bridge.cpp, src/ros_gz_bridge.cpp and src/bridge_config.cpp of ros_gz_bridge,
https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.ros_program.errors import UsageError
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal

if TYPE_CHECKING:
    from rclpy.node import Node

    from gz_course.sim.bridge.ros_gz_bridge.config import Config
    from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, ServiceEntry
    from gz_course.sim.bridge.ros_gz_bridge.finding import Finding

HELP = """\
usage: parameter_bridge TOPIC@ROS_TYPE@GZ_TYPE ... [--strict] [--ros-args ...]
       parameter_bridge [--strict] --ros-args -p config_file:=FILE

Bridges topics between Gazebo and ROS 2. The mark between the two types is the direction:
  @  both ways          [  from Gazebo to ROS          ]  from ROS to Gazebo
Quote each argument: some shells give [ a meaning of their own.

  parameter_bridge '/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist' \\
                   '/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'

A service of Gazebo is offered to ROS with SERVICE@ROS_TYPE or SERVICE@ROS_TYPE@GZ_REQUEST_TYPE@GZ_REPLY_TYPE:
  parameter_bridge /world/empty/control@ros_gz_interfaces/srv/ControlWorld

A bridge that cannot be made is reported and left out; the others are made.
  --strict  start nothing if there is any error

ROS parameters (after --ros-args, each as -p name:=value, or in a file after --params-file):
  config_file                         YAML list of bridges; not together with topics on the command line
  bridge_names                        more bridges, given as parameters: bridges.NAME.ros_topic_name and so on
  lazy                                true: connect a bridge only while somebody listens (default false)
  subscription_heartbeat              how often lazy bridges look for listeners, in ms (default 1000)
  expand_gz_topic_names               true: Gazebo names without / and with ~/ get the namespace of the node
  override_frame_id                   frame_id of every message that goes to ROS
  override_timestamps_with_wall_time  true: stamp messages that go to ROS with the system clock
  qos_overrides./TOPIC.publisher.durability and the like, as for any node
To give a topic another name in ROS: -r /gz/name:=/ros/name
To check a file without starting anything: ros2 run ros_gz_bridge lint FILE
"""

_STRICT = "--strict"
_SWITCH_S = 0.001


def main(argv: list[str] | None = None) -> int:
    """Run the bridge until SIGINT or SIGTERM; return 0, 2 if it could not start, or 1 if a callback failed."""
    if not (sys.argv[1:] if argv is None else argv):
        print(HELP, end="")
        return 2
    return run("parameter_bridge", "ros_gz_bridge", _bridge, HELP, argv, lasting=True, images=True)


def _bridge(node: Node, texts: list[str]) -> int:
    """Set the bridges up, wait for a signal, take them down."""
    from gz_course.sim.bridge.ros_gz_bridge import bridged_topics, parameters
    from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge, BridgeError, HeaderOverrides
    from gz_course.sim.bridge.ros_gz_bridge.checks import volatile_static_transforms
    from gz_course.sim.bridge.ros_gz_bridge.watch import Watch, Watcher
    from gz_course.sim.gz.transport import Node as GzNode
    from gz_course.sim.gz.transport import NodeOptions

    given = parameters.read_parameters(node)
    strict = _STRICT in texts
    config, errors = configured(node, [text for text in texts if text != _STRICT], given, strict=strict)
    logger = node.get_logger()
    for sentence in errors:
        logger.error(sentence)

    def left_out(entry: BridgeEntry | ServiceEntry, sentence: str) -> None:
        logger.error(sentence)
        errors.append(sentence)
        config.topics = [each for each in config.topics if each is not entry]
        config.services = [each for each in config.services if each is not entry]

    heartbeat = given.values["subscription_heartbeat"] / 1000
    overrides = HeaderOverrides(
        frame_id=given.values["override_frame_id"], wall_time=given.values["override_timestamps_with_wall_time"]
    )
    with GzNode(NodeOptions(synchronous=True)) as gz_node:  # GzEcho takes an echo inside publish
        for line in parameters.creation_lines(config):
            logger.info(line)
        try:
            bridge = Bridge(
                node,
                gz_node,
                config.topics,
                overrides=overrides,
                heartbeat=heartbeat,
                services=config.services,
                threaded=True,
                left_out=None if strict else left_out,
            )
        except BridgeError as error:
            raise UsageError(*error.errors) from None
        config.findings += volatile_static_transforms(_volatile(config.topics, node))
        for sentence in [*parameters.advice(node, config.topics), *map(str, config.findings)]:
            logger.warning(sentence)
        bridged_topics.offer(node, config.topics)
        parameters.declare(node)
        # The time after which a thread that converts an image yields to one that bridges the clock.
        sys.setswitchinterval(_SWITCH_S)
        watcher = Watcher(Watch(bridge, gz_node, logger), heartbeat)
        watcher.start()
        count = len(config.topics) + len(config.services)
        without = "; what the errors above name is left out" if errors else ""
        logger.info(f"ready: {count} bridge{'s' if count != 1 else ''}{without}")
        try:
            return wait_for_signal(node)
        finally:
            watcher.stop()
            bridge.close()


def configured(node: Node, texts: list[str], given: Any, strict: bool) -> tuple[Config, list[str]]:
    """Return the bridges of the command line, of the parameters and of the file, and what is said of those left out.

    The warnings are in `findings`. Raises UsageError with every error if one of them is fatal, or any with `strict`.
    """
    from gz_course.sim.bridge.ros_gz_bridge.arguments import read_arguments
    from gz_course.sim.bridge.ros_gz_bridge.checks import check, private_gz_names
    from gz_course.sim.bridge.ros_gz_bridge.config import read_file
    from gz_course.sim.bridge.ros_gz_bridge.finding import Finding

    path, lazy = given.values["config_file"], given.values["lazy"]
    options = [text for text in texts if text.startswith("-")]
    arguments = [text for text in texts if text not in options]
    config: Config = given.config
    config.findings += [Finding("", f"the option {option} is not known (see --help)", fatal=True) for option in options]
    given_here = read_arguments(arguments, lazy=lazy)
    config.include(given_here)
    if path and given_here.topics:  # services on the command line do not switch it off
        sentence = f"topics are given on the command line, so {path} is not read; put all of them in one place"
        config.findings.append(Finding("", sentence, tolerated=True))
    elif path:
        file = read_file(path, lazy=lazy)
        if not (file.topics or file.services or file.findings):
            file.findings.append(Finding(path, "the list of bridges is empty", tolerated=True))
        config.include(file)
    if not (config.topics or config.services or config.findings):
        sentence = "nothing to bridge; give bridges as arguments or -p config_file:=FILE (see --help)"
        config.findings.append(Finding("", sentence))
    config.findings += [each for each in check(config.topics, config.services) if each not in config.findings]
    if given.values["expand_gz_topic_names"]:
        _expand(config, node)
    else:
        config.findings += private_gz_names(config.topics, config.services)
    errors: list[Finding] = [finding for finding in config.findings if not finding.warning]
    if any(strict or finding.fatal for finding in errors):
        raise UsageError(*map(str, errors))
    severe = [finding for finding in errors if not finding.tolerated]
    kept = config.tolerant()
    kept.findings = [finding for finding in config.findings if finding not in severe]
    return kept, [str(finding) for finding in severe]


def _volatile(topics: list[BridgeEntry], node: Node) -> list[BridgeEntry]:
    """Return the entries that no parameter makes transient local, with the name of the ROS topic after remapping."""
    resolved = [replace(entry, ros_topic=node.resolve_topic_name(entry.ros_topic)) for entry in topics]
    overrides = node.get_parameters_by_prefix("qos_overrides")
    durable = {name for name, parameter in overrides.items() if parameter.value == "transient_local"}
    return [each for each in resolved if f"{each.ros_topic}.publisher.durability" not in durable]


def _expand(config: Config, node: Node) -> None:
    """Expand the Gazebo names with the namespace and the name of the node."""
    from gz_course.sim.bridge.ros_gz_bridge.names import expand_gz_name

    namespace, name = node.get_namespace(), node.get_name()
    config.topics = [
        replace(entry, gz_topic=expand_gz_name(entry.gz_topic, namespace, name)) for entry in config.topics
    ]
    config.services = [
        replace(entry, gz_name=expand_gz_name(entry.gz_service, namespace, name)) for entry in config.services
    ]


if __name__ == "__main__":
    sys.exit(main())
