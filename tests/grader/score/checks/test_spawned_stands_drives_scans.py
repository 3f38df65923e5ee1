"""`spawned`, `stands`, `drives`, `scans`: a robot that a launch put into the world, and sentences about bad ones."""

import json
import math

import numpy as np
import pytest

STEPS = np.arange(0.01, 6.0, 0.05)
PLACE = {"robot": "scout", "x": "x", "y": "y", "yaw": "yaw"}
FRAME = "topics/scan/header/frame_id"
BRIDGE = {
    "source": "argument '/scan@...'",
    "ros_topic": "/scan",
    "ros_type": "sensor_msgs/msg/LaserScan",
    "gz_topic": "/scan",
    "gz_type": "gz.msgs.LaserScan",
    "direction": "GZ_TO_ROS",
    "to_ros": 0,
    "to_gz": 0,
    "publisher_qos": None,
    "subscription_qos": None,
}


def truth(**functions):
    """Signals of a robot that rests at the origin, but for what `functions` of time say."""
    still = dict.fromkeys(("x", "y", "z", "qx", "qy", "yaw", "linear_x", "angular_z", "distance"), lambda at: 0.0)
    return {f"truth/scout/{name}": [(at, of(at)) for at in STEPS] for name, of in (still | functions).items()}


def launched(record, signals=None, arguments=None, **facts):
    trial = json.dumps({"poses": {}, "parameters": arguments or {}})
    lines = facts.pop("lines", ())
    return record(signals, facts={"launch": facts, "sim_seconds": 6.0}, lines=lines, trial_parameters=trial)


@pytest.mark.parametrize(
    ("signals", "facts", "words"),
    [
        (truth(x=lambda at: 1.5, yaw=lambda at: 0.4 - math.tau), {}, ""),
        (truth(yaw=lambda at: 0.4), {}, "the argument x had no effect on the place of scout"),
        (truth(), {}, "the arguments x and yaw had no effect"),
        (truth(x=lambda at: 9.0), {}, "it was at x 9.00 m"),
        ({"truth/robot/x": [(0, 0)]}, {"calls": ["create: done"]}, "create was not told the name scout"),
        ({}, {"calls": []}, "nothing asked Gazebo to create a model"),
        ({}, {"calls": ["create: refused"]}, "Gazebo refused the model"),
        (
            {},
            {"lines": [(0, "[create-3] [ERROR] [1.0] [ros_gz_sim]: the entity was not created: <link> is bad")]},
            "it said: the entity was not created: <link> is bad",
        ),
        (
            {},
            {"lines": [(0, "[ERROR] [robot_state_publisher-2]: process has died [pid 7, exit code 2].")]},
            "robot_state_publisher ended with exit code 2",
        ),
    ],
)
def test_where_a_robot_came(record, found, signals, facts, words):
    finding = found("spawned", launched(record, signals, {"x": "1.5", "yaw": "0.4"}, **facts), **PLACE)
    assert finding.passed is (words == "") and words in finding.explanation + finding.measured


def test_a_robot_that_comes_late_was_not_there(record, found):
    late = {name: rows[20:] for name, rows in truth().items()}
    assert "came only at 1.01 s" in found("spawned", launched(record, late), **PLACE).measured


@pytest.mark.parametrize(
    ("functions", "words"),
    [
        ({}, ""),
        ({"x": lambda at: max(0.0, at - 1.0)}, ""),
        ({"z": lambda at: -0.01 * (at > 0.2)}, ""),
        ({"qy": lambda at: min(at / 2, 0.5)}, "it falls over"),
        ({"qy": lambda at: min(at / 2, 0.12)}, "it leans"),
        ({"qx": lambda at: min(max(at - 3, 0.0), 0.5)}, "tips over when it drives"),
        ({"qx": lambda at: 0.9 * (at > 3)}, "physics explodes"),
        ({"z": lambda at: -at}, "sinks"),
        ({"z": lambda at: at}, "something pushes it up"),
        ({"y": lambda at: 0.2 * at}, "does not rest"),
    ],
)
def test_a_robot_stands_until_it_is_told_to_drive(record, found, functions, words):
    finding = found("stands", record(truth(**functions), facts={"sim_seconds": 6.0}), robot="scout", until=1.0)
    assert finding.passed is (words == "") and words in finding.explanation, finding


def test_no_robot_does_neither_stand_nor_drive(record, found):
    nothing = record(told("linear_x", 0.4), facts={"sim_seconds": 6.0})
    assert not found("stands", nothing, robot="scout", until=1.0).passed
    assert not found("drives", nothing, **drive("linear_x")).passed
    assert not found("drives", record({}, facts={"sim_seconds": 6.0}), **drive("linear_x")).passed


def told(axis, value, taken=1.0):
    base = "script/cmd_vel"
    return {f"{base}/{axis}": [(1.0, value), (5.0, 0.0)], f"{base}/taken": [(1.0, taken), (5.0, taken)]}


def drive(axis):
    return {"robot": "scout", "command": "cmd_vel", "axis": axis, "wheels": "joint_states"}


def moving(value):
    return lambda at: value * (1.0 < at < 5.0)


@pytest.mark.parametrize(
    ("axis", "functions", "words"),
    [
        ("linear_x", {"linear_x": moving(0.4)}, ""),
        ("linear_x", {"linear_x": moving(0.39), "yaw": moving(0.05)}, ""),
        (
            "linear_x",
            {"linear_x": moving(0.2)},
            "0.50 times as fast as commanded: the plugin's <wheel_radius> is 2.00",
        ),
        ("linear_x", {"linear_x": moving(0.8)}, "<wheel_radius> is 0.50 times"),
        ("linear_x", {"linear_x": moving(-0.4)}, "it drives backwards"),
        ("linear_x", {"linear_x": moving(0.4), "yaw": lambda at: at}, "it drives a curve"),
        ("linear_x", {"yaw": lambda at: at}, "it turned on the spot"),
        ("linear_x", {}, "its wheels did not turn"),
        ("angular_z", {"angular_z": moving(0.4)}, ""),
        ("angular_z", {"angular_z": moving(0.8)}, "<wheel_separation> is 2.00 times the distance"),
        ("angular_z", {"angular_z": moving(-0.4)}, "turns the wrong way"),
        ("angular_z", {"angular_z": moving(0.4), "distance": lambda at: at}, "it does not turn about the middle"),
    ],
)
def test_a_robot_moves_as_it_is_told(record, found, axis, functions, words):
    joints = {"topics/joint_states/position": [(at, [0.0, 0.0]) for at in STEPS]}
    recording = record(truth(**functions) | told(axis, 0.4), arrays=joints, facts={"sim_seconds": 6.0})
    finding = found("drives", recording, **drive(axis))
    assert finding.passed is (words == "") and words in finding.explanation, finding


def test_why_a_robot_does_not_move(record, found):
    turning = {"topics/joint_states/position": [(at, [at, at]) for at in STEPS]}
    still = truth() | told("linear_x", 0.4)
    said = {"launch": {"model_warnings": ["a.sdf:3: DiffDrive's <left_joint> is wrong"]}, "sim_seconds": 6.0}
    for recording, words in (
        (record(still, arrays=turning, facts={"sim_seconds": 6.0}), "did not roll along the ground"),
        (record(still, facts={"sim_seconds": 6.0}), "no states of its joints"),
        (record(still, facts=said), "a.sdf:3: DiffDrive's <left_joint> is wrong"),
        (
            record(
                still,
                facts={"launch": {"model_warnings": ["DiffDrive's <left_joint> names joint 'l', which m has not"]}},
            ),
            "; a joint of type fixed is merged",
        ),
        (record(truth() | told("linear_x", 0.4, 0.0), facts=said), "no bridge carried the commands on /cmd_vel"),
    ):
        assert words in found("drives", recording, **drive("linear_x")).explanation


def scanned(ranges, least=-3.14, most=3.14, longest=12.0, count=60):
    numbers = {"count": 1.0, "angle_min": least, "angle_max": most, "range_max": longest}
    signals = {f"topics/scan/{name}": [(at / 10, value) for at in range(count)] for name, value in numbers.items()}
    return {"signals": signals, "arrays": {"topics/scan/ranges": [(at / 10, ranges) for at in range(count)]}}


GOOD = [2.0] * 200 + [math.inf] * 100


@pytest.mark.parametrize(
    ("scans", "frame", "words"),
    [
        (scanned(GOOD), "lidar_link", ""),
        (scanned(GOOD), "scout/base_link/lidar", "without <gz_frame_id>"),
        (scanned(GOOD, count=10), "lidar_link", "10 scans arrived"),
        (scanned(GOOD[:90]), "lidar_link", "90 rays"),
        (scanned(GOOD, least=0.0), "lidar_link", "over 3.14 rad"),
        (scanned(GOOD, longest=4.0), "lidar_link", "range_max was 4.00 m"),
        (scanned([0.2] * 30 + GOOD), "lidar_link", "sees the robot itself"),
        (scanned([-math.inf] * 30 + GOOD), "lidar_link", "sees the robot itself"),
        (scanned([math.inf] * 300), "lidar_link", "pass over what stands around"),
    ],
)
def test_good_scans_come(record, found, scans, frame, words):
    recording = record(**scans, lines=[(0.1, frame)], log=FRAME, facts={"sim_seconds": 6.0})
    finding = found("scans", recording, topic="scan", frame="lidar_link")
    assert finding.passed is (words == "") and words in finding.explanation + finding.measured, finding


@pytest.mark.parametrize(
    ("bridges", "words"),
    [
        ([], "no bridge has the ROS topic /scan"),
        ([BRIDGE | {"direction": "ROS_TO_GZ"}], "argument '/scan@...': /scan goes the wrong way"),
        ([BRIDGE | {"ros_type": "sensor_msgs/msg/Image"}], "is sensor_msgs/msg/Image here"),
        ([BRIDGE], "nothing in Gazebo publishes /scan"),
    ],
)
def test_why_no_scan_comes(record, found, bridges, words):
    recording = record({}, facts={"sim_seconds": 6.0, "bridges": bridges})
    assert words in found("scans", recording, topic="scan", frame="lidar_link").explanation


def test_an_argument_of_another_name_is_named(record, found):
    trial = json.dumps({"poses": {}, "parameters": {"x": "1.5", "yaw": "0"}})
    places = [{"file": "a.launch.py", "line": 3, "name": name, "default": "0"} for name in ("x_pose", "y", "yaw")]
    recording = record(truth(), facts={"launch": {}, "declared": places}, trial_parameters=trial)
    said = found("spawned", recording, robot="scout", x="x", y="y", yaw="yaw").explanation
    assert said.endswith("declares no argument called x; it declares x_pose, y, yaw"), said


def test_another_program_that_died_is_named_where_nothing_creates_the_robot(record, found):
    lines = ["[spawn-3] there is no option '-topic'", "[ERROR] [spawn-3]: process has died [pid 4, exit code 2]."]
    finding = found(
        "spawned", launched(record, {}, lines=[(0.1, line) for line in lines]), robot="scout", x="x", y="y", yaw="yaw"
    )
    assert "does that; spawn ended with exit code 2; it said: there is no option '-topic'" in finding.measured
