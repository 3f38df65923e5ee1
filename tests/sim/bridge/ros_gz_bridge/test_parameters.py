"""The effects of the ROS parameters of a bridge in real processes: all ways to set them, and errors."""

import os
import signal
import sys

import pytest
from rclpy.qos import DurabilityPolicy, ReliabilityPolicy
from sensor_msgs.msg import LaserScan

from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz_course.sim.gz.transport import Node
from gz_course.tests import warm_process

DEADLINE = 120.0
PARAMETERS = """\
/**:
  ros__parameters:
    bridge_names: [scan, go]
    expand_gz_topic_names: true
    bridges:
      scan:
        ros_topic_name: scan
        gz_topic_name: ~/lidar
        ros_type_name: sensor_msgs/msg/LaserScan
        gz_type_name: gz.msgs.LaserScan
        direction: GZ_TO_ROS
        publisher_queue: 3
        frame_id: front
      go:
        topic_name: cmd
        ros_type_name: geometry_msgs/msg/Twist
        gz_type_name: gz.msgs.Twist
        direction: ROS_TO_GZ
        qos_profile: SENSOR_DATA
"""


def fails(*arguments):
    """Return the error sentences of a bridge that does not start."""
    command = [sys.executable, "-m", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge", *arguments]
    done = warm_process.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    return [line.removeprefix("parameter_bridge: ") for line in done.stderr.splitlines()]


def test_bridges_from_a_parameter_file_in_a_namespace(start, ros, inbox, eventually, tmp_path):
    file = tmp_path / "parameters.yaml"
    file.write_text(PARAMETERS)
    process = start("--ros-args", "--params-file", str(file), "-r", "__ns:=/robot1", "-r", "__node:=my_bridge")
    process.wait_for("ready: 2 bridges")
    process.wait_for("'qos_profile' is known to newer releases than Jazzy only")
    scans = inbox()
    subscription = ros.node.create_subscription(LaserScan, "/robot1/scan", scans, 10)
    try:
        with Node() as gz:
            publisher = gz.advertise("/robot1/my_bridge/lidar", GzLaserScan)
            assert publisher.wait_for_subscribers(timeout=DEADLINE)
            eventually(lambda: (publisher.publish(GzLaserScan(frame="x")), scans.messages)[1], "a scan arrives")
            assert scans.messages[0].header.frame_id == "front"

        def known() -> bool:  # DDS announces endpoints before the names of their nodes
            found = ros.node.get_subscriptions_info_by_topic("/robot1/cmd")
            return bool(found) and not found[0].node_name.startswith("_NODE_NAME_UNKNOWN")

        eventually(known, "the bridge listens")
        (info,) = ros.node.get_subscriptions_info_by_topic("/robot1/cmd")
        assert info.node_name == "my_bridge"
        assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    finally:
        ros.node.destroy_subscription(subscription)
    assert process.stop() == 0


def test_qos_overrides_reach_the_endpoint(start, ros, eventually):
    name = "qos_overrides./odom.publisher.durability"
    process = start("/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry", "--ros-args", "-p", f"{name}:=transient_local")
    process.wait_for("ready: 1 bridge")
    eventually(lambda: ros.node.get_publishers_info_by_topic("/odom"), "the bridge publishes")
    (info,) = ros.node.get_publishers_info_by_topic("/odom")
    assert info.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert process.stop() == 0


GOOD = "/a@std_msgs/msg/Bool@gz.msgs.Boolean"


def test_every_fault_of_every_source_at_once(ros_domain):
    sentences = fails(
        *("x", "--nope", "--ros-args", "-p", "lazy:=3", "-p", "bridge_names:=[scan, empty]"),
        *("-p", "bridges.scan.topic_name:=/s", "-p", "bridges.scan.lazy:=maybe", "-p", "bridges.scna.lazy:=true"),
        *("-p", "bridges.scan.directon:=GZ_TO_ROS"),
    )
    found = "\n".join(sentences)
    for words in (
        "the parameter lazy must be true or false, not 3",
        "parameter bridges.scan.directon: the key 'directon' is not known; did you mean 'direction'?",
        "parameter bridges.scan.lazy: 'lazy' must be true or false, not maybe",
        "parameter bridges.scan: 'ros_type_name' is missing",
        "parameter bridges.empty: bridge_names has this name, but there are no parameters of it",
        "parameter bridges.scna.lazy: scna is not in bridge_names, so it is not bridged; did you mean 'scan'?",
        "the option --nope is not known",
        "argument 'x': has no '@'",
    ):
        assert words in found


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--strict", GOOD, "/b@std_msgs/msg/Bol@gz.msgs.Boolean"], "std_msgs/msg/Bol"),
        ([GOOD, "--ros-args", "-p", "bridge_names:=3"], "the parameter bridge_names must be a list of texts, not 3"),
        ([GOOD, "--ros-args", "-r", "__node:=1x"], "ROS did not start"),
        ([GOOD, "--ros-args", "--params-file", "/none.yaml"], "ROS did not start"),
    ],
)
def test_a_start_that_fails(ros_domain, arguments, words):
    assert words in "\n".join(fails(*arguments))


def test_private_names_need_the_parameter(ros_domain, tmp_path):
    file = tmp_path / "b.yaml"
    file.write_text(
        "- {ros_topic_name: /a, gz_topic_name: ~/a, ros_type_name: std_msgs/msg/Bool, gz_type_name: gz.msgs.Boolean}\n"
    )
    (sentence,) = fails("--strict", "--ros-args", "-p", f"config_file:={file}")
    assert sentence.endswith("b.yaml:1: the Gazebo name ~/a works only with the parameter expand_gz_topic_names:=true")


def test_it_starts_with_what_can_be_bridged(start, tmp_path):
    file = tmp_path / "b.yaml"
    file.write_text(PARAMETERS)
    process = start(GOOD, "/b@std_msgs/msg/Bol@gz.msgs.Boolean", "--ros-args", "-p", f"config_file:={file}")
    process.wait_for("ready: 1 bridge")
    process.wait_for("topics are given on the command line, so")
    process.wait_for("[ERROR]")
    assert process.stop() == 0


def test_parameters_are_shown_and_cannot_be_changed_while_it_runs(start):
    process = start(GOOD)
    process.wait_for("ready: 1 bridge")
    environment = dict(os.environ)
    ros2 = [f"{sys.prefix}/bin/ros2", "param"]
    done = warm_process.run(
        [*ros2, "set", "/ros_gz_bridge", "lazy", "true"],
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
        env=environment,
    )
    assert "lazy is read when the bridge starts; stop it and start it with the new value" in done.stdout + done.stderr
    assert process.stop() == 0


def test_a_lazy_bridge_lets_the_simulator_rest_while_nobody_listens(start, ros, inbox, eventually):
    with Node() as gz:
        publisher = gz.advertise("/lazy/scan", GzLaserScan)
        lazy = ("-p", "lazy:=true", "-p", "subscription_heartbeat:=50")
        process = start("/lazy/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", "--ros-args", *lazy)
        process.wait_for("ready: 1 bridge")
        assert not publisher.has_connections()
        subscription = ros.node.create_subscription(LaserScan, "/lazy/scan", inbox(), 10)
        assert publisher.wait_for_subscribers(timeout=DEADLINE)
        ros.node.destroy_subscription(subscription)
        eventually(lambda: not publisher.has_connections(), "the sensor may rest")
    assert process.stop() == 0


SIMULATOR = """
import sys
from gz.msgs.laserscan_pb2 import LaserScan
from gz.transport import Node
import threading
publisher = Node().advertise("/lidar", LaserScan)
pause = threading.Event()
while not pause.wait(0.02):
    publisher.publish(LaserScan(frame=sys.argv[1]))
"""


def test_a_killed_simulator_and_a_killed_bridge_are_recovered_from(start, ros, inbox, eventually):
    argument = "/lidar@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan"
    bridge = start(argument, "--ros-args", "-p", "subscription_heartbeat:=100")
    bridge.wait_for("ready: 1 bridge")
    scans = inbox()
    subscription = ros.node.create_subscription(LaserScan, "/lidar", scans, 10)

    def heard(frame):
        return lambda: any(scan.header.frame_id == frame for scan in scans.messages)

    try:
        first = start("first", command=[sys.executable, "-c", SIMULATOR])
        eventually(heard("first"), "the first simulator is heard")
        first.stop(signal.SIGKILL)
        bridge.wait_for("nobody in Gazebo publishes /lidar any more: the simulator has ended or was killed")
        start("second", command=[sys.executable, "-c", SIMULATOR])
        bridge.wait_for("Gazebo publishes /lidar again")
        eventually(heard("second"), "the second simulator is heard")
        bridge.stop(signal.SIGKILL)
        scans.messages.clear()
        start(argument).wait_for("ready: 1 bridge")
        eventually(lambda: scans.messages, "another bridge takes its place")
    finally:
        ros.node.destroy_subscription(subscription)
