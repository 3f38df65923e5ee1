"""parameter_bridge as a process, between a Gazebo node and a ROS node of this process."""

import re
import signal
import sys

import pytest
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz_course.sim.gz.msgs.twist_pb2 import Twist as GzTwist
from gz_course.sim.gz.transport import Node
from gz_course.tests import warm_process

DEADLINE = 120.0
COMMAND = [sys.executable, "-m", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge"]


def run(*arguments):
    return warm_process.run([*COMMAND, *arguments], capture_output=True, text=True, timeout=600, check=False)


CONFIG = """\
- ros_topic_name: /base/cmd_vel
  gz_topic_name: /model/robot/cmd_vel
  ros_type_name: geometry_msgs/msg/Twist
  gz_type_name: gz.msgs.Twist
  direction: ROS_TO_GZ
- ros_topic_name: /base/scan
  gz_topic_name: /lidar
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
"""


@pytest.fixture(params=["arguments", "file"])
def bridged(request, start, tmp_path):
    """Return (process, ROS and gz command topic, ROS and gz scan topic) for both kinds of configuration."""
    if request.param == "file":
        file = tmp_path / "bridge.yaml"
        file.write_text(CONFIG)
        process = start("--ros-args", "-p", f"config_file:={file}")
        topics = ("/base/cmd_vel", "/model/robot/cmd_vel", "/base/scan", "/lidar")
    else:
        process = start(
            "/go@geometry_msgs/msg/Twist]gz.msgs.Twist",
            "/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
            "--ros-args",
            "-r",
            "/go:=/renamed",
        )
        topics = ("/renamed", "/go", "/scan", "/scan")
    process.wait_for("ready: 2 bridges")
    return (process, *topics)


def test_messages_pass_both_ways(bridged, ros, inbox, eventually):
    process, ros_command, gz_command, ros_scan, gz_scan = bridged
    commands, scans = inbox(), inbox()
    publisher = ros.node.create_publisher(Twist, ros_command, 10)
    subscription = ros.node.create_subscription(LaserScan, ros_scan, scans, 10)
    try:
        with Node() as gz:
            gz.subscribe(GzTwist, gz_command, commands)
            gz_publisher = gz.advertise(gz_scan, GzLaserScan)
            assert gz_publisher.wait_for_subscribers(timeout=DEADLINE)
            eventually(lambda: publisher.get_subscription_count() == 1, "the bridge listens to ROS")
            eventually(lambda: subscription.get_publisher_count() == 1, "the bridge publishes to ROS")
            twist = Twist()
            twist.linear.x = 1.5
            # Discovery is one-sided at first, so the first messages may have no receiver.
            eventually(lambda: (publisher.publish(twist), commands.messages)[1], "a command arrives")
            scan = GzLaserScan(frame="a::b", count=1, ranges=[2.5])
            eventually(lambda: (gz_publisher.publish(scan), scans.messages)[1], "a scan arrives")
    finally:
        ros.node.destroy_publisher(publisher)
        ros.node.destroy_subscription(subscription)
    assert commands.messages[0].linear.x == 1.5
    assert (scans.messages[0].header.frame_id, list(scans.messages[0].ranges)) == ("a/b", [2.5])
    process.wait_for("Passing message from ROS geometry_msgs/msg/Twist to Gazebo gz.msgs.Twist (showing msg only once")
    assert process.stop() == 0
    log = "\n".join(process.lines)
    assert f"Creating ROS->GZ Bridge: [{'/go' if gz_command == '/go' else ros_command} (geometry_msgs" in log
    assert re.search(rf"Creating GZ->ROS Bridge: \[{gz_scan} \(gz.msgs.LaserScan\) -> {ros_scan} \(sensor_msgs", log)
    assert "Traceback" not in log


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("moment", ["Creating", "ready: 1 bridge"])
def test_a_signal_ends_it_cleanly_at_any_moment(start, number, moment):
    process = start("/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock")
    process.wait_for(moment)
    assert process.stop(number) == 0, process.lines
    assert not [line for line in process.lines if "Traceback" in line or "rror" in line]


def test_an_interrupt_ignored_by_the_parent_still_ends_it(start):
    shell = ["sh", "-c", 'trap "" INT; exec "$@"', "sh", *COMMAND]
    process = start("/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock", command=shell)
    process.wait_for("ready: 1 bridge")
    assert process.stop(signal.SIGINT) == 0


def test_the_command_is_installed_under_its_name(start):
    process = start(
        "/clock@rosgraph_msgs/msg/Clock@gz.msgs.Clock",
        command=[f"{sys.prefix}/bin/parameter_bridge"],
    )
    process.wait_for("ready: 1 bridge")
    process.wait_for("bridge a clock from Gazebo to ROS only")
    assert process.stop() == 0


def test_parameters_that_change_nothing_are_named(start):
    process = start(
        "/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry",
        *("--ros-args", "-p", "confg_file:=x", "-p", "qos_overrides./odm.publisher.depth:=3"),
        *("-p", "qos_overrides./odom.publisher.depth:=3", "-p", "override_frame_id:=map"),
    )
    process.wait_for("ready: 1 bridge")
    warnings = [line.split("]: ", 1)[1] for line in process.lines if "[WARN]" in line]
    assert warnings == [
        "the parameter confg_file is not known here and changes nothing; did you mean 'config_file'?",
        "the parameter qos_overrides./odm.publisher.depth names no endpoint of this bridge and changes "
        "nothing; did you mean 'qos_overrides./odom.publisher.depth'?",
    ]
    assert process.stop() == 0


def test_without_arguments_it_explains_itself(ros_domain):
    done = run()
    assert done.stdout.startswith("usage: parameter_bridge TOPIC@ROS_TYPE@GZ_TYPE")
    assert (done.returncode, done.stderr) == (2, "")
    assert run("--help").returncode == 0


def test_every_fault_is_listed_without_traceback(ros_domain, tmp_path):
    done = run("/a@std_msgs/String@gz.msgs.StringMsg", "/b@std_msgs/msg/Bool", "c")
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 3
    assert all(line.startswith("parameter_bridge: argument '") for line in done.stderr.splitlines())


GOOD = "/a@std_msgs/msg/Bool@gz.msgs.Boolean"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--strict", "--ros-args", "-p", "config_file:=/none.yaml"], "/none.yaml: cannot read the bridge config"),
        (
            ["--strict"],
            "nothing to bridge; give bridges as arguments or -p config_file:=FILE",
        ),
        ([GOOD, "--ros-args", "-p", "lazy:=3"], "the parameter lazy must be true or false, not 3"),
        (
            [GOOD, "--ros-args", "-p", "subscription_heartbeat:=0"],
            "must be a number of ms above 0 and up to an hour, not 0",
        ),
        (
            [GOOD, "--strict", "--ros-args", "-p", "config_file:=x.yaml"],
            "topics are given on the command line, so x.yaml is not read",
        ),
        (
            [GOOD, "--ros-args", "--nonsense"],
            "ROS does not know these arguments after --ros-args: ['--nonsense']",
        ),
        (["/{x}@std_msgs/msg/Bool@gz.msgs.Boolean"], "cannot bridge /{x}: failed to resolve name"),
        ([GOOD, "--ros-args", "-r", ":="], "ROS did not start: Failed to parse ROS arguments"),
    ],
)
def test_a_start_that_fails_says_why_in_one_sentence(ros_domain, arguments, words):
    done = run(*arguments)
    assert done.returncode == 2
    *_, line = done.stderr.splitlines()
    assert "Traceback" not in done.stderr
    assert line.startswith("parameter_bridge: ")
    assert words in line


def test_what_cannot_be_bridged_is_named_and_the_rest_is_bridged(start, ros, eventually, tmp_path):
    file = tmp_path / "b.yaml"
    file.write_text(CONFIG.replace("direction", "directon", 1).replace("gz.msgs.LaserScan", "gz.msgs.LaserScn"))
    process = start("--ros-args", "-p", f"config_file:={file}")
    process.wait_for("ready: 1 bridge; what the errors above name is left out")
    eventually(lambda: ros.node.count_subscribers("/base/cmd_vel") == 1, "the good bridge listens")
    assert process.stop() == 0
    (error,) = [line for line in process.lines if "[ERROR]" in line]
    assert f"{file}:8: sensor_msgs/msg/LaserScan cannot become gz.msgs.LaserScn; " in error
    (warning,) = [line for line in process.lines if "[WARN]" in line and "key" in line]
    assert f"{file}:5: the key 'directon' is not known; did you mean 'direction'?" in warning


def test_a_topic_renamed_to_one_of_another_type_is_left_out(start):
    other = GOOD.replace("/a", "/b", 1).replace("Bool@", "Float32@").replace("Boolean", "Float")
    process = start(GOOD.replace("@gz", "[gz"), other, "--ros-args", "-r", "/b:=/a")
    process.wait_for("ready: 1 bridge; what the errors above name is left out")
    assert process.stop() == 0
    (error,) = [line for line in process.lines if "[ERROR]" in line]
    assert f"argument '{other}': cannot bridge /b: " in error


def test_with_nothing_to_bridge_it_says_so_and_waits(start):
    process = start("--ros-args", "-p", "config_file:=/none.yaml")
    process.wait_for("/none.yaml: cannot read the bridge configuration: No such file or directory")
    process.wait_for("ready: 0 bridges")
    assert process.stop() == 0


def test_strict_lists_all_faults_of_a_broken_file(ros_domain, tmp_path):
    file = tmp_path / "b.yaml"
    file.write_text(CONFIG.replace("direction", "directon").replace("gz.msgs.Twist", "gz.msgs.Twit"))
    done = run("--strict", "--ros-args", "-p", f"config_file:={file}")
    assert done.returncode == 2
    places = [line.split(": ")[1] for line in done.stderr.splitlines()]
    assert places == [f"{file}:3", f"{file}:5", f"{file}:10"]


def test_services_of_the_command_line_and_a_file_together(start, tmp_path):
    file = tmp_path / "bridge.yaml"
    file.write_text(CONFIG)
    service = "/world/w/control@ros_gz_interfaces/srv/ControlWorld"
    start(service, "--ros-args", "-p", f"config_file:={file}").wait_for("ready: 3 bridges")


def test_static_transforms_need_a_durability_that_listeners_accept(start):
    bridge = "/model/r/pose_static@tf2_msgs/msg/TFMessage[gz.msgs.Pose_V"
    renamed = ("--ros-args", "-r", "/model/r/pose_static:=/tf_static")
    parameter = "qos_overrides./tf_static.publisher.durability:=transient_local"
    without = start(bridge, *renamed)
    without.wait_for(f"receive nothing from this bridge; add -p {parameter}")
    durable = start(bridge, *renamed, "-p", parameter)
    durable.wait_for("ready: 1 bridge")
    assert not any("receive nothing" in line for line in durable.lines)
