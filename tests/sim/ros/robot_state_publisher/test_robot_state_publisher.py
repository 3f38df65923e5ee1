"""The executable robot_state_publisher: sources of the robot, messages, and an installed one in its place."""

import signal

import pytest

URDF = "<robot name='r'><link name='a'/></robot>"
XACRO = (
    "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:property name='n' value='left'/>"
    "<link name='${n}_wheel'/></robot>"
)


@pytest.fixture
def latched(ros_node, spin_until):
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    def text(topic):
        heard = []
        profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        ros_node.create_subscription(String, topic, heard.append, profile)
        spin_until(lambda: heard, topic)
        return heard[0].data

    return text


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_who_comes_later_hears_the_description(programs, latched, number):
    name = f"robot_{number}"
    words = ["--ros-args", "-r", f"__ns:=/{name}", "-p", f"robot_description:={URDF}"]
    program = programs.ros2("run", "robot_state_publisher", "robot_state_publisher", *words)
    program.wait_for("Robot initialized")
    assert latched(f"/{name}/robot_description") == URDF
    assert program.stop(number) == 0


def test_a_xacro_file_is_expanded(programs, latched):
    from gz_course.sim.ros.robot_state_publisher.kinematics import Kinematics

    (programs.folder / "robot.urdf.xacro").write_text(XACRO)
    program = programs.module("gz_course.sim.ros.robot_state_publisher.robot_state_publisher", "robot.urdf.xacro")
    program.wait_for("Robot initialized")
    text = latched("/robot_description")
    assert "_place_" not in text
    assert Kinematics.from_urdf(text).root == "left_wheel"
    assert program.stop() == 0


def test_an_installed_one_does_the_work(programs):
    program = programs.folder / "lib" / "robot_state_publisher" / "robot_state_publisher"
    program.parent.mkdir(parents=True)
    program.write_text('#!/bin/sh\necho "the real one: $*"\nexit 7\n')
    program.chmod(0o755)
    path = f"{programs.environment['AMENT_PREFIX_PATH']}:{programs.folder}"
    ended, said = programs.finished(
        "gz_course.sim.ros.robot_state_publisher.robot_state_publisher", "a.urdf", AMENT_PREFIX_PATH=path
    )
    assert (ended, said) == (7, "the real one: a.urdf\n")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "no robot is given; give a URDF file"),
        (["nothing.urdf"], "nothing.urdf: the file cannot be read (No such file or directory)"),
        (["a.urdf", "b.urdf"], "one URDF file can be given, not 2: a.urdf b.urdf"),
        (["--urdf"], "there is no option '--urdf'"),
        (["a.urdf", "--ros-args", "-p", f"robot_description:={URDF}"], "given as a file and in robot_description"),
        (["--ros-args", "-p", "robot_description:=<robot name='r'/>"], "robot 'r' has no <link>"),
        (["--ros-args", "-p", "robot_description:=5"], "the parameter robot_description must be a text, not 5"),
        (
            ["--ros-args", "-p", f"robot_description:={URDF}", "-p", "publish_frequency:=-1"],
            "the parameter publish_frequency must be 0 to 1000 Hz, not -1",
        ),
    ],
)
def test_what_makes_no_sense(call, words, sentence):
    code, said = call("gz_course.sim.ros.robot_state_publisher.robot_state_publisher", *words)
    assert (code, sentence in said) == (2, True), said
