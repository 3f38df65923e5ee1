"""lint reports the findings of parameter_bridge, and its exit code is that of the worst finding."""

import os
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.bridge.ros_gz_bridge.arguments import read_arguments
from gz_course.sim.bridge.ros_gz_bridge.checks import check, private_gz_names, volatile_static_transforms
from gz_course.sim.bridge.ros_gz_bridge.config import read_yaml
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.bridge.ros_gz_bridge.lint import main

CLOCK = ("rosgraph_msgs/msg/Clock", "gz.msgs.Clock")
TF = ("tf2_msgs/msg/TFMessage", "gz.msgs.Pose_V")
SCAN = ("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan")
TWIST = ("geometry_msgs/msg/Twist", "gz.msgs.Twist")
TO_ROS, TO_GZ, BOTH = Direction.GZ_TO_ROS, Direction.ROS_TO_GZ, Direction.BIDIRECTIONAL

GOOD = """\
- ros_topic_name: /clock
  gz_topic_name: /clock
  ros_type_name: rosgraph_msgs/msg/Clock
  gz_type_name: gz.msgs.Clock
  direction: GZ_TO_ROS
"""


def entry(topic, types, direction=TO_ROS, source="b.yaml:1", **options):
    return BridgeEntry(topic, options.pop("gz_topic", topic), *types, direction, source=source, **options)


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ([entry("/clock", CLOCK, BOTH)], "Gazebo then keeps its own clock off that topic"),
        ([entry("/sim/clock", CLOCK)], "nodes with use_sim_time listen to /clock"),
        ([entry("/clock", CLOCK), entry("/clock", CLOCK, gz_topic="/world/w/clock")], "a second clock on /clock"),
        ([entry("/scan", SCAN, BOTH)], "is enough (without a direction a bridge goes both ways)"),
        ([entry("/model/a/cmd_vel", TWIST)], "did you mean ] or direction: ROS_TO_GZ?"),
        ([entry("/world/w/dynamic_pose/info", TF)], "carry no frames"),
        ([entry("/a", TWIST), entry("/a", TWIST, BOTH)], "bridges /a again (first: b.yaml:1); keep one"),
        ([entry("/cmd_vel", TWIST, TO_GZ, lazy=True)], "loses the commands sent before it connects"),
        ([entry("/twist", TWIST, BOTH, lazy=True)], "counts itself as a listener in the original"),
        ([entry("/twist", TWIST, frame_id="base")], "geometry_msgs/msg/Twist has no header"),
        ([entry("/a", TWIST), entry("/b", SCAN, gz_topic="/a")], "the Gazebo topic /a is gz.msgs.LaserScan here"),
    ],
)
def test_each_warning(entries, words):
    (finding,) = check(entries)
    assert finding.warning
    assert finding.place == "b.yaml:1"
    assert words in finding.sentence


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        ([entry("/a", TWIST), entry("/a", SCAN, TO_ROS, "b.yaml:7", gz_topic="/b")], "a ROS topic has one type"),
        (
            [entry("/a", TWIST, TO_GZ), entry("/b", ("std_msgs/msg/Bool", "gz.msgs.Boolean"), TO_GZ, gz_topic="/a")],
            "the Gazebo topic /a is gz.msgs.Boolean here and gz.msgs.Twist in b.yaml:1",
        ),
    ],
)
def test_each_error_about_several_entries(entries, words):
    (finding,) = check(entries)
    assert not finding.warning
    assert words in finding.sentence


def test_a_bridge_of_static_transforms_needs_a_parameter(tmp_path, capsys):
    file = tmp_path / "b.yaml"
    file.write_text(
        f"- {{topic_name: /tf_static, ros_type_name: {TF[0]}, gz_type_name: {TF[1]}, direction: GZ_TO_ROS}}\n"
    )
    assert main([str(file)]) == 0
    assert "-p qos_overrides./tf_static.publisher.durability:=transient_local" in capsys.readouterr().out
    assert list(volatile_static_transforms([entry("/tf_static", TF, qos_profile="ROSOUT"), entry("/tf", TF)])) == []


@pytest.mark.parametrize("topic, types", [("/clock", CLOCK), ("/scan", SCAN)])
def test_a_direction_that_can_never_work_stops_the_bridge(topic, types, tmp_path, capsys):
    file = tmp_path / "b.yaml"
    good = f"- topic_name: {topic}\n  ros_type_name: {types[0]}\n  gz_type_name: {types[1]}\n"
    file.write_text(good + "  direction: ROS_TO_GZ\n")
    assert main([str(file)]) == 2
    first, last = capsys.readouterr().out.splitlines()
    assert first.startswith(f"{file}:1: error: ")
    assert "did you mean [ or direction: GZ_TO_ROS?" in first
    assert last.startswith("1 error, 0 warnings")
    assert main(["--compat", str(file)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "0 errors, 1 warning; 1 bridge can be made"
    assert main([f"{topic}@{types[0]}]{types[1]}"]) == 2


def test_good_bridges_pass_without_a_word():
    assert (
        list(
            check(
                [
                    entry("/clock", CLOCK),
                    entry("/scan", SCAN, lazy=True, frame_id="lidar"),
                    entry("/cmd_vel", TWIST, TO_GZ, gz_topic="/model/a/cmd_vel"),
                    entry("/twist", TWIST, BOTH),
                ]
            )
        )
        == []
    )
    assert [str(each) for each in private_gz_names([entry("/x", TWIST, gz_topic="~/x")], [])] == [
        "b.yaml:1: the Gazebo name ~/x works only with the parameter expand_gz_topic_names:=true"
    ]


def test_a_good_file(tmp_path, capsys):
    file = tmp_path / "b.yaml"
    file.write_text(GOOD)
    assert main([str(file)]) == 0
    assert capsys.readouterr().out == "0 errors, 0 warnings; 1 bridge can be made\n"


def test_warnings_are_said_and_harmless(tmp_path, capsys):
    file = tmp_path / "b.yaml"
    file.write_text(GOOD.replace("GZ_TO_ROS", "BIDIRECTIONAL"))
    assert main([str(file)]) == 0
    first, last = capsys.readouterr().out.splitlines()
    assert first.startswith(f"{file}:1: warning: publishes /clock in Gazebo too")
    assert last == "0 errors, 1 warning; 1 bridge can be made"


def test_every_error_of_every_file_is_listed(tmp_path, capsys):
    bad, worse = tmp_path / "bad.yaml", tmp_path / "worse.yaml"
    bad.write_text(GOOD.replace("direction", "directon") + GOOD.replace("gz.msgs.Clock", "gz.msgs.Clok"))
    worse.write_text("a: 1")
    assert main([str(bad), str(worse), str(tmp_path / "none.yaml")]) == 2
    lines = capsys.readouterr().out.splitlines()
    errors = [line.split(": error: ")[0] for line in lines if ": error: " in line]
    assert errors == [f"{bad}:5", f"{bad}:8", f"{worse}:1", f"{tmp_path}/none.yaml"]


def test_findings_come_in_the_order_in_which_things_are_written(tmp_path, capsys):
    file = tmp_path / "b.yaml"
    odd = GOOD.replace("gz.msgs.Clock", "gz.msgs.Clok").replace("GZ_TO_ROS", "TO_ROS") + "  directon: x\n"
    file.write_text(GOOD.replace("GZ_TO_ROS", "BIDIRECTIONAL").replace("/clock", "/c") + odd)
    assert main([str(file)]) == 2
    *lines, _ = capsys.readouterr().out.splitlines()
    numbers = [int(line.split(":")[1]) for line in lines]
    assert numbers == sorted(numbers)
    assert len(numbers) > 3
    scan, clock = "/scan@sensor_msgs/msg/LaserScan]gz.msgs.LaserScan", "/clock@rosgraph_msgs/msg/Clock"
    assert main([scan, clock]) == 2
    first, second, _ = capsys.readouterr().out.splitlines()
    assert first.startswith(f"argument '{scan}'")
    assert second.startswith(f"argument '{clock}'")


def test_compat_is_as_lenient_as_the_original(tmp_path, capsys):
    file = tmp_path / "b.yaml"
    file.write_text(GOOD.replace("direction", "directon") + GOOD.replace("gz.msgs.Clock", "gz.msgs.Clok"))
    assert main(["--compat", str(file)]) == 0
    out = capsys.readouterr().out
    assert ": error: " not in out
    assert out.splitlines()[-1] == "0 errors, 3 warnings; 1 bridge can be made"
    config = read_yaml(file.read_text(), "b.yaml").tolerant()
    assert [each.direction for each in config.topics] == [BOTH], "a misspelt key is passed over"


def test_compat_leaves_out_what_cannot_work():
    second = GOOD.replace("rosgraph_msgs/msg/Clock", "std_msgs/msg/Bool").replace("gz.msgs.Clock", "gz.msgs.Boolean")
    config = read_yaml(GOOD + second.replace("gz_topic_name: /clock", "gz_topic_name: /b"), "b.yaml")
    assert [each.place for each in config.findings] == ["b.yaml:6"]
    assert [each.source for each in config.tolerant().topics] == ["b.yaml:1"]


def test_arguments_are_checked_too(capsys):
    assert main(["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"]) == 0
    assert main(["/clock@rosgraph_msgs/msg/Clock"]) == 2
    assert "has no direction and no Gazebo type" in capsys.readouterr().out


@pytest.mark.parametrize(("arguments", "code"), [([], 2), (["--help"], 0), (["--compat"], 2), (["--nope", "x"], 2)])
def test_usage(arguments, code, capsys):
    assert main(arguments) == code
    captured = capsys.readouterr()
    assert "usage: lint" in captured.out or "(see --help)" in captured.err


def test_ros2_run_finds_it(tmp_path):
    file = tmp_path / "b.yaml"
    file.write_text(GOOD.replace("gz.msgs.Clock", "gz.msgs.Clok"))
    command = [f"{sys.prefix}/bin/ros2", "run", "ros_gz_bridge", "lint", str(file)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 2
    assert done.stdout.startswith(f"{file}:3: error: rosgraph_msgs/msg/Clock cannot become gz.msgs.Clok; ")


def test_a_pipe_without_writer_is_refused_at_once(tmp_path, capsys):
    os.mkfifo(tmp_path / "pipe")
    assert main([str(tmp_path / "pipe")]) == 2
    assert "it is no ordinary file" in capsys.readouterr().out


KEYS = """topic_name ros_topic_name gz_topic_name ros_type_name gz_type_name direction lazy directon publisher_queue
subscriber_queue qos_profile frame_id service_name gz_req_type_name '"""
VALUES = """/a;a/b;~/x;std_msgs/msg/Bool;gz.msgs.Boolean;GZ_TO_ROS;BOTH;true;7;-1;1e9;~;[1, 2];{a: b};&a [*a];*b;'
!!python/object:os.system x;!!binary aGk=;!!float x;!!int '';CLOCK;no_pkg/srv/Nope;0x1f;2020-99-99;"""
keys = st.sampled_from(KEYS.split())
values = st.sampled_from([*VALUES.replace("\n", ";").split(";"), "|\n    text"])
files = st.lists(st.lists(st.tuples(keys, values), min_size=1, max_size=5), min_size=1, max_size=3).map(
    lambda entries: "".join("- " + "  ".join(f"{key}: {value}\n" for key, value in entry) for entry in entries)
)


@given(files)
def test_no_file_does_worse_than_a_finding_with_its_line(text):
    config = read_yaml(text, "b.yaml")
    for finding in config.findings:
        assert finding.place.startswith("b.yaml:"), finding
        assert 1 <= int(finding.place.removeprefix("b.yaml:")) <= text.count("\n") + 2
        assert "\n" not in str(finding)
    assert config.topics or config.services or config.findings
    assert not [finding for finding in config.tolerant().findings if not finding.warning]


@given(st.lists(st.text("@[]/ab_.~ msgtrvn\n", max_size=40), min_size=1, max_size=3))
def test_no_argument_does_worse_than_a_finding(texts):
    sentences = [str(finding) for finding in read_arguments(texts).findings]
    assert all(sentence.startswith("argument '") and "\n" not in sentence for sentence in sentences)
