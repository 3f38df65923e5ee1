"""The program that lists the pairs: its output, its errors, and finding it by `ros2 run`."""

import subprocess
import sys

import pytest

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.bridge_types import main


def test_every_pair_is_printed_once(capsys):
    assert main(["--print-pairs"]) == 0
    lines = [tuple(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert lines == [(pair.ros_type, pair.gz_type) for pair in type_pairs.pairs()]
    assert len(set(lines)) == len(lines) == 69


@pytest.mark.parametrize(("option", "kind"), [("--print-gz", "gz_type"), ("--print-ros", "ros_type")])
def test_every_type_is_printed_once(capsys, option, kind):
    assert main([option]) == 0
    assert capsys.readouterr().out.splitlines() == sorted({getattr(pair, kind) for pair in type_pairs.pairs()})


@pytest.mark.parametrize("spelling", ["gz.msgs.Twist", "ignition.msgs.Twist"])
def test_all_partners_of_a_gazebo_type(capsys, spelling):
    assert main(["--get-gz-to-ros", spelling]) == 0
    assert capsys.readouterr().out.split() == ["geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"]


def test_all_partners_of_a_ros_type(capsys):
    assert main(["--get-ros-to-gz", "nav_msgs/msg/Odometry"]) == 0
    assert capsys.readouterr().out.split() == ["gz.msgs.Odometry", "gz.msgs.OdometryWithCovariance"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--get-gz-to-ros", "gz.msgs.Twits"], "no ROS type is known for gz.msgs.Twits"),
        (["--get-gz-to-ros", "gz.msgs.Twits"], "the nearest Gazebo type is gz.msgs.Twist"),
        (["--get-ros-to-gz", "geometry_msgs/Twist"], "the nearest ROS type is geometry_msgs/msg/Twist"),
        (["--get-ros-to-gz", ""], "no Gazebo type is known for"),
    ],
)
def test_a_type_without_partner_is_named_with_the_nearest(capsys, arguments, words):
    assert main(arguments) == 1
    output = capsys.readouterr()
    assert output.out == "" and words in output.err and output.err.count("\n") == 1


def test_the_package_that_is_missing_is_named(capsys, monkeypatch):
    monkeypatch.setattr(type_pairs, "_installed", lambda package: package != "tf2_msgs")
    assert main(["--get-ros-to-gz", "tf2_msgs/msg/TFMessage"]) == 1
    assert "needs the ROS package tf2_msgs" in capsys.readouterr().err
    assert main(["--print-pairs"]) == 0
    assert "tf2_msgs" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [[], ["--nope"], ["--print-gz", "--print-ros"], ["--get-gz-to-ros"]])
def test_a_wrong_call_says_how_it_is_done(capsys, arguments):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2
    assert "usage: bridge_types" in capsys.readouterr().err


def test_ros2_run_finds_it():
    ros2 = "import sys; from gz_course.sim.ros.ros2.command_line import main; sys.exit(main())"
    command = [sys.executable, "-c", ros2, "run", "ros_gz_bridge", "bridge_types"]
    done = subprocess.run(
        [*command, "--get-gz-to-ros", "gz.msgs.Clock"], capture_output=True, text=True, timeout=600, check=False
    )
    assert (done.returncode, done.stdout.split()) == (0, ["rosgraph_msgs/msg/Clock"]), done.stderr


def test_a_reader_that_has_seen_enough_is_no_fault():
    with subprocess.Popen(
        [sys.executable, "-m", "gz_course.sim.bridge.ros_gz_bridge.bridge_types", "--print-pairs"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        process.stdout.close()
        error = process.stderr.read()
        assert process.wait(120) == 0
    assert "Traceback" not in error and "BrokenPipe" not in error
