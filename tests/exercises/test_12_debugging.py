"""What is said about a cart that parks wrongly: the misconception, from the distances and the commands."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

NAMES = import_module("gz_course.exercises.12_debugging.grading.misconceptions")
MOUNT = (-0.2, 0.0, 0.19)
TRUTH = np.linspace(3.0, 1.0, 40)
DISTANCE = 1.0 + 2.0 * np.exp(-np.linspace(0.0, 5.0, 60))

SWINGS = 1.0 + 2.0 * np.exp(-np.linspace(0.0, 4.0, 60)) * np.cos(np.linspace(0.0, 20.0, 60))


def driven(distance, left, gain=1.5, fastest=0.6):
    return distance, np.clip(gain * left, -fastest, fastest), 1.0


@pytest.mark.parametrize(
    ("seen", "sign", "words"),
    [
        ((0.2, 0.0, -0.19), -1, "parent and child are swapped"),
        ((0.2, 0.0, -0.19), 1, "its numbers are the place of base_link"),
        ((0.2, 0.0, 0.19), 1, "the sign of x is wrong"),
        ((0.2, 0.0, 0.19), -1, "lidar_link is the parent here, and its numbers do not fit that either"),
        ((-0.2, 0.0, -0.19), -1, "with base_link as the parent, they are x = -0.2, z = 0.19"),
        ((-0.2, 0.0, -0.19), 1, "the sign of z is wrong"),
        ((-0.2, 0.0, 0.25), 1, "above the ground"),
        ((-200.0, 0.0, 190.0), 1, "in millimetres"),
        ((0.0, -0.2, 0.19), 1, "at the wrong axes"),
        ((0.0, 0.0, 0.0), 1, "at the same place"),
        ((-0.3, 0.1, 0.19), 1, ""),
    ],
)
def test_the_place_of_the_lidar(seen, sign, words):
    found = NAMES.of_a_mount(seen, MOUNT, sign)
    assert words in found and bool(words) == bool(found)


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        (TRUTH + 0.01, ""),
        (TRUTH + 0.2, "measured from the lidar"),
        (TRUTH + 0.4, "with the wrong sign"),
        (TRUTH - 0.2, "from the front of the cart"),
        (TRUTH * 100, "in centimetres"),
        (-TRUTH, "has the wrong sign"),
        (np.full(40, 0.8), "every distance is 0.80 m"),
        (TRUTH * 0.5, "nearer than the wall"),
        (TRUTH * 1.5, "too large"),
        (np.floor(TRUTH), "every distance is a whole number of metres"),
        (np.round(TRUTH * 7) + 10, "that is a count, or a place in a list"),
        (TRUTH * 0.97, "the distance is too small, 2.91 m where the wall is 3.00 m away"),
        (TRUTH - 1.0, "every distance is 1.00 m too small, near the wall and far"),
        (TRUTH + 0.5, "every distance is 0.50 m too large"),
        (TRUTH[:3] * 9, ""),
    ],
)
def test_the_distance_to_the_wall(measured, words):
    found = NAMES.of_a_distance(measured, TRUTH[: len(measured)], MOUNT[0])
    assert words in found and bool(words) == bool(found)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (driven(DISTANCE, DISTANCE - 1.0), ""),
        (driven(DISTANCE, 1.0 - DISTANCE), "the sign of linear.x"),
        (driven(DISTANCE, 0.0 * DISTANCE), "every command is zero"),
        (driven(DISTANCE, DISTANCE - 0.5, gain=0.8), "to 0.50 m from the wall, not to the 1 m that stop_at says"),
        (
            driven(DISTANCE, (DISTANCE - 1.0) * (np.arange(60) % 3 > 0)),
            "34 % of the commands before it comes to rest are zero",
        ),
        (driven(DISTANCE, DISTANCE - 1.2), "from the front of the cart"),
        (driven(DISTANCE[:12], DISTANCE[:12] - 1.0, gain=0.1), "still on its way"),
        (driven(DISTANCE, np.sign(DISTANCE - 1.0)), "it does not fall"),
        ((*driven(DISTANCE, DISTANCE - 1.0)[:2], 0.7), "to 1.00 m from the wall, not to the 0.7 m that stop_at"),
        (driven(DISTANCE[:3], DISTANCE[:3]), ""),
        ((DISTANCE, np.full(60, 0.6), 1.2), "every command is 0.60 m/s, however far the wall is"),
        ((DISTANCE, np.clip(1.5 * (DISTANCE - 1.2), 0.1, 0.6), 1.2), "it drives on, with 0.10 m/s or more, where"),
        ((*driven(DISTANCE, DISTANCE, gain=0.4)[:2], 0.8), "which has lost its fraction"),
        ((*driven(DISTANCE, DISTANCE - 1.0)[:2], 0.8), "that stop_at says: that is its default, and"),
        (driven(DISTANCE, DISTANCE, gain=0.2), "to 0.00 m from the wall, not to the 1 m that stop_at says: it is not"),
        ((DISTANCE + 1.0, np.full(60, 0.1), 1.0), "every command is 0.10 m/s, which is too slow: 1.01 m are left"),
        ((DISTANCE - 0.1, np.where(DISTANCE > 1.1, 0.6, -0.6), 1.0), "every command is 0.60 m/s, ahead or back"),
        ((DISTANCE + 0.2, 0.8 * (DISTANCE - 1.0) ** 2, 1.0), "it has come to rest with 0.21 m left"),
        ((SWINGS, np.clip(60 * (SWINGS - 1.0), -0.6, 0.6), 1.0), "the commands jump between -0.60 and 0.60 m/s"),
        ((DISTANCE, 0.02 * np.cumsum(DISTANCE - 1.0), 1.0), "each command is the last one and a share of what is left"),
    ],
)
def test_the_commands(given, words):
    found = NAMES.of_a_driver(*given)
    assert words in found and bool(words) == bool(found), found


@pytest.mark.parametrize(
    ("last", "speed", "words"),
    [(4e9, 0.2, "no command comes after 4.0 s, and"), (4e9, 0.0, ""), (8.9e9, 0.2, "")],
)
def test_commands_that_end_before_the_run(last, speed, words):
    held = [{"line": 38, "code": "if left > 0.1:"}]
    found = NAMES.of_an_end(9e9, last, speed, held)
    assert words in found and bool(words) == bool(found) == ("`if left > 0.1:` in line 38" in found)


def test_a_lidar_that_is_turned():
    assert "by 3.14 rad about z (--yaw)" in NAMES.of_a_turned_mount([0.0, 0.0, 1.0])
    assert "by -0.20 rad about y (--pitch)" in NAMES.of_a_turned_mount([0.0, -0.1, 0.0])


@pytest.mark.parametrize(
    ("sends", "takes", "found"), [("/sensors/wall", "/sensor/wall", True), ("/sensors/wall", "/robot/wall", False)]
)
def test_names_that_are_spelled_differently(sends, takes, found):
    names = import_module("gz_course.exercises.12_debugging.grading.names")
    assert bool(names.of_a_spelling(sends, takes)) == found


@pytest.mark.parametrize(
    ("driven", "ends_at", "found"),
    [(0.55, 8.0, True), (3.0, 8.0, False), (0.55, 1.5, False), (0.0, 8.0, False)],
)
def test_a_distance_that_is_not_renewed(driven, ends_at, found):
    times = np.arange(0.0, ends_at, 0.05)
    distance, speed = np.full(len(times), 3.7), np.where(times < driven, 0.6, 0.0)
    assert ("is not renewed" in NAMES.of_kept_distances(times * 1e9, distance, speed, 1.0)) == found
    assert NAMES.of_kept_distances(times * 1e9, np.full(len(times), 1.0), speed, 1.0) == ""


@pytest.mark.parametrize(
    ("remapping", "words"),
    [
        (("sensors", "sensors/wall", "/wall"), "'sensors/wall', which means /sensors/sensors/wall in the namespace"),
        (("sensors", "/wall_ahead", "/wall"), "the name '/wall_ahead'; the node's topic is /sensors/wall"),
        (("sensors", "/wall", "wall"), "here, they are exchanged"),
        (("", "sensors/wall", "/wall"), "here, they are exchanged"),
        (("", "other", "/wall"), "lives in the namespace /sensors"),
        (("sensors", "wall", "/sensors/wall"), "changes nothing, because 'wall' already means /sensors/wall here"),
        (("sensors", "/sensors/wall", "wall"), "the new name 'wall' in the remapping has no slash at its beginning"),
        (("sensors", "wall", "wall"), "so it means /sensors/wall; the other node uses /wall"),
        (("sensors", "other", "another"), "lives in the namespace /sensors"),
    ],
)
def test_a_remapping_that_joins_nothing(remapping, words):
    checks = import_module("gz_course.exercises.12_debugging.grading.checks")
    each = {"type": "sensor_msgs/msg/Range", "reliability": "RELIABLE", "durability": "VOLATILE"}
    ends = [
        each | {"kind": "publisher", "node": "/sensors/ranger", "topic": "/sensors/wall"},
        each | {"kind": "subscription", "node": "/driver", "topic": "/wall"},
    ]
    place = dict(zip(("namespace", "from", "to"), remapping, strict=True))
    facts = {"endpoints": ends, "remappings": [place | {"file": "bringup.launch.py", "line": 42}]}
    found = checks.same_topic(SimpleNamespace(facts=lambda: facts), {})
    assert not found.passed and words in found.explanation, found.explanation


CHECKS = import_module("gz_course.exercises.12_debugging.grading.checks")
EVIDENCE = import_module("gz_course.exercises.12_debugging.grading.evidence")
PARKING = import_module("gz_course.exercises.12_debugging.grading.parking")


@pytest.mark.parametrize(("stamps", "words"), [([0, 0], "does not set header.stamp"), ([0, 1], ""), ([], "")])
def test_distances_without_a_time(stamps, words):
    recording = SimpleNamespace(signal=lambda name: SimpleNamespace(values=np.array(stamps)))
    found = PARKING._why_stale(recording)
    assert words in found and bool(words) == bool(found)


def test_a_driver_whose_commands_have_another_name():
    end = {"kind": "publisher", "type": "geometry_msgs/msg/Twist", "topic": "/model/robot/cmd_vel", "node": "/driver"}
    recording = SimpleNamespace(facts=lambda: {"endpoints": [end], "launch": {}}, lines=lambda entity: [])
    finding = CHECKS.all_alive(recording, {})
    assert "/driver publishes its commands on /model/robot/cmd_vel" in finding.measured


def test_a_driver_whose_commands_are_in_its_namespace():
    end = {"kind": "publisher", "type": "geometry_msgs/msg/Twist", "topic": "/a/cmd_vel", "node": "/a/driver"}
    recording = SimpleNamespace(facts=lambda: {"endpoints": [end], "launch": {}}, lines=lambda entity: [])
    assert "lives in the namespace /a" in CHECKS.all_alive(recording, {}).explanation


BRIDGE = {
    "source": "bridge.yaml:11",
    "ros_topic": "/model/robot/cmd_vel",
    "ros_type": "geometry_msgs/msg/Twist",
    "gz_topic": "/cmd_vel",
    "gz_type": "gz.msgs.Twist",
    "direction": "ROS_TO_GZ",
    "to_ros": 0,
    "to_gz": 0,
    "publisher_qos": None,
    "subscription_qos": None,
}


@pytest.mark.parametrize(
    ("gz_topic", "words"),
    [("/cmd_vel", "line 11: ros_topic_name and gz_topic_name are exchanged"), ("/x", "in ROS, it")],
)
def test_names_of_the_commands_that_are_exchanged(gz_topic, words):
    recording = SimpleNamespace(facts=lambda: {"bridges": [BRIDGE | {"gz_topic": gz_topic}]})
    assert words in CHECKS.commands_go_to_gazebo(recording, {}).measured


def test_a_direction_that_does_not_exist():
    error = "/submission/bridge.yaml:16: the direction 'ROS_TO_GAZEBO' is none of BIDIRECTIONAL"
    line = SimpleNamespace(text=f"[parameter_bridge-2] [ERROR] [1.0] [ros_gz_bridge]: {error}")
    recording = SimpleNamespace(facts=lambda: {"bridges": []}, lines=lambda entity: [line])
    finding = CHECKS.commands_go_to_gazebo(recording, {})
    assert "bridge.yaml, line 16: the direction 'ROS_TO_GAZEBO' is none of" in finding.explanation


@pytest.mark.parametrize(
    ("direction", "words"), [("BIDIRECTIONAL", "/scan goes both ways"), ("ROS_TO_GZ", "/scan goes the wrong way")]
)
def test_scans_that_go_the_wrong_way(direction, words):
    wrong = BRIDGE | {"ros_topic": "/scan", "gz_topic": "/lidar/scan", "direction": direction}
    finding = CHECKS.scans_are_heard(SimpleNamespace(facts=lambda: {"bridges": [wrong]}), {})
    assert not finding.passed and words in finding.measured


@pytest.mark.parametrize(
    ("distances", "elsewhere", "words"),
    [
        ([1.0], 0, "line 38: ranger_node.py is started without use_sim_time, and its check of how old a scan is"),
        ([], 0, "line 38: ranger_node.py is started without use_sim_time"),
        ([], 24, "line 24 gives it to parameter_bridge instead"),
    ],
)
def test_a_ranger_on_the_wall_clock(distances, elsewhere, words):
    each = {"reliability": "RELIABLE", "durability": "VOLATILE", "type": "sensor_msgs/msg/Range", "topic": "/wall"}
    ends = [
        each | {"kind": "publisher", "node": "/ranger"},
        each | {"kind": "subscription", "node": "/driver"},
        each | {"kind": "subscription", "node": "/driver", "topic": "/clock"},
    ]
    place = {"file": "bringup.launch.py", "line": 38, "program": "ranger_node.py", "sim_time": False}
    place |= {"elsewhere": elsewhere, "executable": "parameter_bridge"}
    recording = SimpleNamespace(
        facts=lambda: {"endpoints": ends, "programs": [place]},
        signal=lambda name: SimpleNamespace(values=np.array(distances)),
    )
    finding = CHECKS.simulated_time(recording, {})
    assert not finding.passed and words in finding.explanation, finding.explanation


def test_a_ranger_on_the_wall_clock_that_takes_scans_of_any_age():
    each = {"reliability": "RELIABLE", "durability": "VOLATILE", "type": "sensor_msgs/msg/Range", "topic": "/wall"}
    place = {"file": "bringup.launch.py", "line": 38, "program": "ranger_node.py", "sim_time": False, "elsewhere": 0}
    suspect = {"file": "ranger_node.py", "line": 9, "about": "any_age", "said": "the limit is too large"}
    facts = {"endpoints": [each | {"kind": "publisher", "node": "/ranger"}], "programs": [place], "suspects": [suspect]}
    recording = SimpleNamespace(facts=lambda: facts, signal=lambda name: SimpleNamespace(values=np.array([1.0])))
    assert "switched off: ranger_node.py, line 9: the limit" in CHECKS.simulated_time(recording, {}).explanation


def test_a_ranger_that_does_not_get_the_simulated_time_of_its_action():
    each = {"reliability": "RELIABLE", "durability": "VOLATILE", "type": "sensor_msgs/msg/Range", "topic": "/wall"}
    place = {"file": "bringup.launch.py", "line": 38, "program": "ranger_node.py", "sim_time": True, "mentioned": True}
    facts = {"endpoints": [each | {"kind": "publisher", "node": "/ranger"}], "programs": [place]}
    recording = SimpleNamespace(facts=lambda: facts, signal=lambda name: SimpleNamespace(values=np.array([])))
    assert "line 38: use_sim_time is mentioned in this action, but" in CHECKS.simulated_time(recording, {}).explanation
    place["mentioned"] = False
    assert CHECKS.simulated_time(recording, {}).explanation == ""


def test_a_suspect_is_that_of_its_file():
    place = {"line": 7, "about": "age", "said": "turned"}
    facts = {"suspects": [place | {"file": "ranger_node.py"}, place | {"file": "driver_node.py", "about": "hidden"}]}
    recording = SimpleNamespace(facts=lambda: facts)
    assert EVIDENCE.suspected_in(recording, "ranger_node.py", "age") == "ranger_node.py, line 7: turned"
    assert EVIDENCE.suspected_in(recording, "driver_node.py", "age") == ""


def test_a_simulator_that_ends_by_itself_has_run():
    recording = SimpleNamespace(facts=lambda: {"launch": {"simulators": [{"ran": False}]}}, ended_s=4.0)
    assert "ended by itself after 4.0 s" in CHECKS.time_runs(recording, {}).measured


@pytest.mark.parametrize(
    ("said", "words"),
    [("the loop in the callback drive keeps the executor", "one of its callbacks hangs"), ("another slip", "")],
)
def test_a_driver_that_publishes_nothing(said, words):
    facts = {"slips": [{"file": "driver_node.py", "line": 3, "said": said}]}
    numbers = {"topics/wall/range": [1.0] * 8, "topics/cmd_vel/count": []}
    recording = SimpleNamespace(facts=lambda: facts, signal=numbers.get, lines=lambda entity: [])
    found = PARKING._why_still(recording)
    assert found.startswith("the driver got 8 distances and published no command")
    assert ("one of its callbacks hangs" in found) == bool(words)


def test_a_ranger_that_publishes_nothing():
    place = {"file": "ranger_node.py", "line": 9, "code": "if ahead:", "sends": 12, "topic": "/wall"}
    recording = SimpleNamespace(
        facts=lambda: {"conditions": [place]}, signal=lambda name: np.array([]), lines=lambda entity: []
    )
    assert "before its publish() stand `if ahead:` in line 9" in PARKING._why_still(recording)


def test_what_the_ranger_warned_of_is_said_first():
    line = SimpleNamespace(text='[python3-5] [WARN] [1.0] [ranger]: no frame for the scan: "lidar" does not exist')
    place = {"file": "ranger_node.py", "line": 9, "code": "if ahead:", "sends": 12, "topic": "/wall"}
    recording = SimpleNamespace(
        facts=lambda: {"conditions": [place]}, signal=lambda name: np.array([]), lines=lambda entity: [line]
    )
    assert "on /wall; it warned: no frame for the scan" in PARKING._why_still(recording)


def test_a_world_without_the_folder_of_the_launch_file():
    error = "world file 'depot.sdf' was not found as a path"
    facts = {"launch": {"simulators": [{"ran": False, "error": error}]}}
    finding = CHECKS.time_runs(SimpleNamespace(facts=lambda: facts, ended_s=0.0, properties=lambda name: {}), {})
    assert "it lies in worlds, beside the launch file" in finding.explanation


def test_a_program_that_ends_itself():
    ends = [{"file": "driver_node.py", "line": 45, "said": "`raise SystemExit` in drive() ends the program"}]
    launch = {"ended_early": [{"program": "driver_node.py", "code": 0}]}
    recording = SimpleNamespace(facts=lambda: {"launch": launch, "own_ends": ends}, lines=lambda entity: [])
    assert "driver_node.py, line 45: `raise SystemExit`" in CHECKS.all_alive(recording, {}).explanation
