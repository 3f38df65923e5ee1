"""`table_rows` and `table_column`: each fault of a row is found, and told with its line and the nearest right name."""

import pytest

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.score.checks.table_column import table_column
from gz_course.grader.score.checks.table_rows import table_rows

BRIDGE = {"publisher_qos": None, "subscription_qos": None, "source": "bridge.yaml:1"}
FACTS = {
    "bridges": [
        BRIDGE
        | {
            "ros_topic": "/scan",
            "ros_type": "sensor_msgs/msg/LaserScan",
            "gz_topic": "/lidar",
            "gz_type": "gz.msgs.LaserScan",
            "direction": "BIDIRECTIONAL",
            "to_ros": 9,
            "to_gz": 0,
        },
        BRIDGE
        | {
            "ros_topic": "/cmd_vel",
            "ros_type": "geometry_msgs/msg/Twist",
            "gz_topic": "/model/robot/cmd_vel",
            "gz_type": "gz.msgs.Twist",
            "direction": "ROS_TO_GZ",
            "to_ros": 0,
            "to_gz": 5,
        },
    ],
    "ros_topics": {
        "/scan": {
            "types": ["sensor_msgs/msg/LaserScan"],
            "publishers": ["ros_gz_bridge"],
            "subscribers": ["patrol", "ros_gz_bridge"],
        },
        "/cmd_vel": {
            "types": ["geometry_msgs/msg/Twist"],
            "publishers": ["patrol"],
            "subscribers": ["ros_gz_bridge"],
        },
        "/state": {"types": ["std_msgs/msg/String"], "publishers": ["patrol"], "subscribers": []},
    },
    "gz_topics": {
        "/lidar": {"types": ["gz.msgs.LaserScan"], "publishers": ["gz sim"], "subscribers": ["ros_gz_bridge"]},
        "/imu": {"types": ["gz.msgs.IMU"], "publishers": ["gz sim"], "subscribers": []},
        "/model/robot/cmd_vel": {
            "types": ["gz.msgs.Twist"],
            "publishers": ["ros_gz_bridge"],
            "subscribers": ["gz sim"],
        },
    },
}
SCAN = {
    "line": 1,
    "ros_topic": "/scan",
    "ros_type": "sensor_msgs/msg/LaserScan",
    "gz_topic": "/lidar",
    "gz_type": "gz.msgs.LaserScan",
    "direction": "GZ_TO_ROS",
    "publisher": "ros_gz_bridge",
}
COMMAND = {
    "line": 8,
    "ros_topic": "/cmd_vel",
    "ros_type": "geometry_msgs/msg/Twist",
    "gz_topic": "/model/robot/cmd_vel",
    "gz_type": "gz.msgs.Twist",
    "direction": "ROS_TO_GZ",
    "publisher": "patrol",
}
COLUMNS = ("ros_type", "gz_topic", "gz_type", "direction", "publisher")


@pytest.fixture
def found(record):
    """Apply the check on rows, or on one column, to a table."""

    def judge(rows, column=None, at_least=2):
        recording = record(facts=FACTS | {"table": rows})
        if column is None:
            return table_rows(recording, Table({}, "check 'it'"))
        return table_column(recording, Table({"column": column, "at_least": at_least}, "check 'it'"))

    return judge


def test_the_right_table_passes_every_check(found):
    for rows in ([SCAN, COMMAND], [COMMAND, SCAN]):
        assert found(rows).passed
        assert [column for column in COLUMNS if not found(rows, column).passed] == []


def test_slashes_before_names_of_nodes_and_gazebo_topics_may_come_or_go(found):
    rows = [SCAN | {"gz_topic": "lidar", "publisher": "/ros_gz_bridge"}, COMMAND]
    assert found(rows, "gz_topic").passed and found(rows, "publisher").passed


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([], ["there is no row for /cmd_vel and 1 more"]),
        ([SCAN], ["there is no row for /cmd_vel"]),
        ([SCAN, COMMAND, SCAN | {"line": 15}], ["line 1: /scan has 2 rows"]),
        ([SCAN, COMMAND, SCAN | {"ros_topic": "/state", "line": 15}], ["line 15: /state is a topic of ROS alone"]),
        ([SCAN, COMMAND, SCAN | {"ros_topic": "/rosout", "line": 15}], ["line 15: /rosout is a topic of ROS alone"]),
        ([SCAN, COMMAND, SCAN | {"ros_topic": "/imu", "line": 15}], ["line 15: /imu is a topic of Gazebo alone"]),
        (
            [SCAN | {"ros_topic": "/lidar"}, COMMAND],
            ["line 1: /lidar is what Gazebo calls it; in ROS it has another name"],
        ),
        ([SCAN | {"ros_topic": "/scann"}, COMMAND], ["no topic /scann in ROS", "look at its spelling"]),
        ([SCAN | {"ros_topic": ""}, COMMAND], ["line 1: this row has no ros_topic"]),
    ],
)
def test_a_row_too_many_or_too_few(found, rows, words):
    finding = found(rows)
    assert not finding.passed
    assert [word for word in words if word not in finding.measured] == []


@pytest.mark.parametrize(
    ("column", "said", "words"),
    [
        ("ros_type", "sensor_msgs/LaserScan", ["is no type of ROS 2", "package/msg/Name"]),
        ("ros_type", "gz.msgs.LaserScan", ["is Gazebo's type"]),
        ("ros_type", "", ["the ROS type of /scan is not filled in"]),
        ("gz_topic", "/scan", ["is what ROS calls it"]),
        ("gz_topic", "/imu", ["not the one that /scan is joined with"]),
        ("gz_topic", "/lidarr", ["Gazebo has no topic /lidarr", "look at its spelling"]),
        ("gz_topic", "gz.msgs.LaserScan", ["is a type, and the column asks for a topic"]),
        ("gz_type", "/lidar", ["is a topic, and the column asks for the type"]),
        ("gz_type", "sensor_msgs/msg/LaserScan", ["is a ROS type"]),
        ("gz_type", "gz/msgs/LaserScan", ["is not how Gazebo writes a type", "gz.msgs.Name"]),
        ("gz_type", "gz.msgs.Laserscan", ["does not carry", "look at its spelling"]),
        ("direction", "ROS_TO_GZ", ["travel the other way"]),
        ("direction", "BIDIRECTIONAL", ["one way only"]),
        ("direction", "gz_to_ros", ["is no direction", "did you mean 'GZ_TO_ROS'?"]),
        ("publisher", "patrol", ["patrol listens to /scan"]),
        ("publisher", "gz sim", ["Gazebo itself is not in it"]),
        ("publisher", "gz_bridge", ["no node called gz_bridge", "ros2 node list"]),
    ],
)
def test_what_is_wrong_in_a_column_is_told_with_its_line(found, column, said, words):
    rows = [SCAN | {column: said, "line": 3}, COMMAND]
    finding = found(rows, column)
    assert not finding.passed
    assert finding.measured.startswith("line 3: ")
    assert [word for word in words if word not in finding.measured] == []
    assert [other for other in COLUMNS if other != column and not found(rows, other).passed] == []


def test_the_direction_is_that_of_the_messages_not_of_the_configuration(found):
    """The bridge of /scan is set up for both ways, and nothing goes to Gazebo."""
    assert found([SCAN, COMMAND], "direction").passed


def test_an_empty_table_and_one_with_too_few_rows_earn_nothing(found):
    for rows in ([], [SCAN]):
        assert [column for column in COLUMNS if found(rows, column).passed] == []
        assert found(rows, "gz_type").gated
    assert found([SCAN], "gz_type", at_least=1).passed
