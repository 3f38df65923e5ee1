"""`bridged`, `bridge_lint`, `bridge_qos`: the first thing that is wrong with a bridge is told with its line."""

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.score.checks.bridge_lint import bridge_lint
from gz_course.grader.score.checks.bridge_qos import bridge_qos
from gz_course.grader.score.checks.bridged import bridged

RELIABLE = {"reliability": "RELIABLE", "durability": "VOLATILE", "depth": 10}
SCAN = {
    "source": "bridge.yaml:6",
    "ros_topic": "/scan",
    "ros_type": "sensor_msgs/msg/LaserScan",
    "gz_topic": "/lidar",
    "gz_type": "gz.msgs.LaserScan",
    "direction": "GZ_TO_ROS",
    "to_ros": 20,
    "to_gz": 0,
    "publisher_qos": RELIABLE,
    "subscription_qos": None,
}
COMMAND = {
    "source": "bridge.yaml:11",
    "ros_topic": "/cmd_vel",
    "ros_type": "geometry_msgs/msg/Twist",
    "gz_topic": "/model/robot/cmd_vel",
    "gz_type": "gz.msgs.Twist",
    "direction": "ROS_TO_GZ",
    "to_ros": 0,
    "to_gz": 20,
    "publisher_qos": None,
    "subscription_qos": RELIABLE,
}
CLOCK = SCAN | {
    "source": "bridge.yaml:1",
    "ros_topic": "/clock",
    "ros_type": "rosgraph_msgs/msg/Clock",
    "gz_topic": "/clock",
    "gz_type": "gz.msgs.Clock",
}
GRAPH = {
    "/lidar": {"types": ["gz.msgs.LaserScan"], "publishers": ["gz sim"], "subscribers": ["ros_gz_bridge"]},
    "/imu": {"types": ["gz.msgs.IMU"], "publishers": ["gz sim"], "subscribers": []},
    "/model/robot/cmd_vel": {"types": ["gz.msgs.Twist"], "publishers": [], "subscribers": ["gz sim"]},
}
LISTENER = {
    "kind": "subscription",
    "topic": "/scan",
    "type": "sensor_msgs/msg/LaserScan",
    "node": "/crew",
    "reliability": "RELIABLE",
    "durability": "VOLATILE",
}
KEYS = ("ros_topic", "ros_type", "gz_topic", "gz_type", "direction")


@pytest.fixture
def found(record):
    """Judge bridges by what one of them should be."""

    def judge(*bridges, wanted=SCAN, listener=LISTENER, **parameters):
        recording = record(facts={"bridges": list(bridges), "gz_topics": GRAPH, "endpoints": [listener]})
        table = Table({key: wanted[key] for key in KEYS} | {"at_least": 10} | parameters, "check 'it'")
        finding = bridged(recording, table)
        table.end()
        return finding

    return judge


def test_right_bridges_pass(found):
    assert found(SCAN).passed
    assert found(CLOCK, COMMAND, SCAN, wanted=COMMAND).passed
    assert found(SCAN | {"direction": "BIDIRECTIONAL"}, SCAN).passed, "a second entry may be the right one"
    assert found(SCAN | {"gz_topic": "/imu"}, same=["/imu"]).passed


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"ros_topic": "/laser"}, ["line 6", "Gazebo's /lidar is called /laser in ROS here", "/scan"]),
        ({"ros_topic": "/lidar", "gz_topic": "/scan"}, ["line 6", "the wrong way round", "/lidar is Gazebo's name"]),
        ({"ros_topic": "/scans", "gz_topic": "/x"}, ["no bridge has the ROS topic /scan", "is it '/scans'?"]),
        ({"gz_topic": "/lidarr"}, ["line 6", "nobody in Gazebo publishes /lidarr", "look at its spelling"]),
        ({"gz_topic": "/imu"}, ["line 6", "/imu is not the Gazebo topic that belongs to /scan"]),
        ({"gz_topic": "/lidar,"}, ["in YAML, the , at the end is a part of the name"]),
        ({"gz_topic": "/imu"}, ["it carries turning rates and accelerations, and /scan is to carry scans"]),
        ({"ros_type": "sensor_msgs/msg/Range"}, ["line 6", "but the node uses sensor_msgs/msg/LaserScan"]),
        ({"gz_type": "gz.msgs.IMU"}, ["line 6", "in Gazebo it is gz.msgs.LaserScan"]),
        ({"direction": "BIDIRECTIONAL"}, ["line 6", "goes both ways"]),
        ({"direction": "ROS_TO_GZ", "to_ros": 0}, ["line 6", "wrong way", "Gazebo publishes it"]),
        ({"to_ros": 9}, ["line 6", "only 9 messages"]),
        ({"publisher_qos": RELIABLE | {"reliability": "BEST_EFFORT"}}, ["line 6", "hears nothing", "RELIABLE"]),
    ],
)
def test_the_first_thing_wrong_is_told(found, change, words):
    finding = found(CLOCK, SCAN | change)
    assert not finding.passed
    assert [word for word in words if word not in finding.measured] == [], finding.measured


@pytest.mark.parametrize(
    ("gz_topic", "words"),
    [("/lidar", "the one that does stands in the entry of /imu/data"), ("/imu", "the entry of /imu/data (bridge.yaml")],
)
def test_the_topic_of_another_entry_is_told(found, gz_topic, words):
    other = SCAN | {"ros_topic": "/imu/data", "gz_topic": gz_topic, "source": "bridge.yaml:20"}
    finding = found(SCAN | {"gz_topic": "/imu"}, other)
    assert not finding.passed and words in finding.measured and "line 20" in finding.measured, finding.measured


def test_a_topic_that_names_its_world_exists_in_that_world_only(found):
    clock = CLOCK | {"gz_topic": "/world/bay/clock"}
    finding = found(clock, wanted=CLOCK)
    assert not finding.passed and "exists only in the world called bay" in finding.measured, finding.measured


def test_without_the_graph_of_gazebo_nobody_is_said_to_publish_nothing(record):
    recording = record(facts={"bridges": [CLOCK | {"gz_topic": "/stats"}], "endpoints": []})
    finding = bridged(recording, Table({key: CLOCK[key] for key in KEYS} | {"at_least": 10}, "check 'it'"))
    assert "/stats is not the Gazebo topic that belongs to /clock" in finding.measured, finding.measured


def test_messages_of_another_topic_must_not_arrive_at_the_same_place(found):
    other = SCAN | {"source": "bridge.yaml:20", "gz_topic": "/lidar2"}
    mixed = found(SCAN, other)
    assert not mixed.passed
    assert (
        mixed.measured
        == "bridge.yaml, line 20: /lidar2 arrives on /scan, too: a subscription there receives both, mixed"
    )
    assert found(SCAN, other, same=["/lidar2"]).passed, "the same messages under another name"
    assert found(SCAN, other | {"to_ros": 0}).passed, "nothing came of it"
    assert found(SCAN, SCAN | {"ros_topic": "/laser"}).passed, "one topic may go to many places"

    second = COMMAND | {"source": "bridge.yaml:30", "ros_topic": "/other/cmd_vel"}
    obeyed = found(CLOCK, COMMAND, second, wanted=COMMAND)
    assert not obeyed.passed
    assert "line 30: /other/cmd_vel goes to /model/robot/cmd_vel, too" in obeyed.measured
    assert found(CLOCK, COMMAND, second | {"to_gz": 0}, wanted=COMMAND).passed
    assert found(CLOCK, COMMAND, COMMAND | {"gz_topic": "/model/twin/cmd_vel"}, wanted=COMMAND).passed


def test_a_listener_that_asks_for_more_than_is_offered_hears_nothing(found):
    weak = SCAN | {"publisher_qos": RELIABLE | {"reliability": "BEST_EFFORT"}}
    assert found(weak, listener=LISTENER | {"reliability": "BEST_EFFORT"}).passed
    assert not found(SCAN, listener=LISTENER | {"durability": "TRANSIENT_LOCAL"}).passed


def test_commands_that_wait_for_the_clock_are_the_clocks_fault(found):
    silent = COMMAND | {"to_gz": 0}
    without = found(silent, wanted=COMMAND)
    assert (without.passed, without.gated) == (False, True)
    assert "waits for /clock" in without.measured
    assert not found(CLOCK, silent, wanted=COMMAND).gated


def test_nothing_at_all_fails(found):
    finding = found()
    assert (finding.passed, finding.measured) == (False, "no bridge has the ROS topic /scan")


def test_a_direction_that_is_none_is_the_authors_mistake(found):
    with pytest.raises(ManifestError, match="did you mean 'GZ_TO_ROS'"):
        found(SCAN, direction="GZ_TO_RSO")


def lint(record, findings, bridges, carried=1):
    recording = record(facts={"lint": findings, "bridges": bridges})
    return bridge_lint(recording, Table({"carried": carried}, "check 'it'"))


def test_lint_tells_the_first_error_before_any_warning(record):
    warning = {"place": "bridge.yaml:1", "sentence": "odd", "warning": True}
    error = {"place": "/some/where/bridge.yaml:7", "sentence": "wrong", "warning": False}
    finding = lint(record, [warning, error], [SCAN])
    assert (finding.passed, finding.measured) == (False, "error in bridge.yaml, line 7: wrong (and 1 more)")
    assert lint(record, [warning], [SCAN]).measured == "warning in bridge.yaml, line 1: odd"
    assert lint(record, [], [SCAN]).passed


def test_a_clean_file_that_carries_nothing_earns_nothing(record):
    silent = SCAN | {"to_ros": 0}
    assert lint(record, [], [SCAN, silent], carried=1).passed
    finding = lint(record, [], [SCAN, silent], carried=2)
    assert (finding.passed, finding.gated) == (False, True)
    assert not lint(record, [], []).passed


@pytest.mark.parametrize(
    ("offer", "parameters", "passed"),
    [
        ({"depth": 1}, {}, True),
        ({"depth": 2}, {}, False),
        ({"depth": 2}, {"depth": [1, 2]}, True),
        ({"depth": 1}, {"reliability": "RELIABLE"}, True),
        ({"depth": 1, "reliability": "BEST_EFFORT"}, {"reliability": "RELIABLE"}, False),
    ],
)
def test_qos_is_that_of_the_bridges_publisher(record, offer, parameters, passed):
    recording = record(facts={"bridges": [SCAN | {"publisher_qos": RELIABLE | offer}]})
    table = Table({"ros_topic": "/scan", "depth": [1, 1], "at_least": 5} | parameters, "check 'it'")
    assert bridge_qos(recording, table).passed is passed


def test_the_qos_of_a_topic_without_messages_is_worth_nothing(record):
    for bridges in ([], [SCAN | {"to_ros": 4}]):
        recording = record(facts={"bridges": bridges})
        finding = bridge_qos(recording, Table({"ros_topic": "/scan", "depth": [1, 99], "at_least": 5}, "check 'it'"))
        assert (finding.passed, finding.gated) == (False, True)


@pytest.mark.parametrize(
    ("facts", "words"),
    [
        (
            {"lint": [{"sentence": "'subscriber_queue' changes nothing here"}]},
            "subscriber_queue is the queue of a bridge",
        ),
        ({"lazy": ["/scan"]}, "lazy opens a bridge only while somebody listens"),
        ({"lazy": ["/image"]}, ""),
        ({}, ""),
    ],
)
def test_what_was_taken_for_the_number_of_messages_is_named(record, facts, words):
    table = Table({"ros_topic": "/scan", "depth": [1, 1], "at_least": 5}, "check 'it'")
    finding = bridge_qos(record(facts={"bridges": [SCAN]} | facts), table)
    assert not finding.passed and words in finding.explanation and bool(words) == bool(finding.explanation)


def test_another_bridge_that_keeps_so_few_is_named(record):
    other = SCAN | {"ros_topic": "/image", "publisher_qos": RELIABLE | {"depth": 1}}
    table = Table({"ros_topic": "/scan", "depth": [1, 1], "at_least": 5}, "check 'it'")
    finding = bridge_qos(record(facts={"bridges": [SCAN, other]}), table)
    assert finding.explanation == "bridge.yaml, line 6: /image sets this; the task asks for it at /scan"


def test_the_topic_of_another_model_is_told_by_its_name(record):
    other = {"types": ["gz.msgs.Twist"], "publishers": [], "subscribers": ["gz sim"]}
    facts = {"bridges": [COMMAND | {"gz_topic": "/model/other/cmd_vel"}], "gz_topics": {"/model/other/cmd_vel": other}}
    wanted = {key: COMMAND[key] for key in KEYS} | {"at_least": 10}
    finding = bridged(record(facts=facts), Table(wanted, "check 'it'", "parameter"))
    assert finding.measured.endswith("belongs to /cmd_vel: it is that of the model other, not of robot")
