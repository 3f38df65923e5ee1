"""The cells that the reader of chapter 1 writes."""

from __future__ import annotations

import re
from typing import Any

import yaml

from gz_course.grader.lessons.motion import expect_turn, motion_in_the_middle
from gz_course.grader.lessons.step import COMMANDS, NotYet, Tried, expect, step

GRAVITY = (9.0, 10.6)  # [m/s^2] that an IMU measures upwards while it stands, with its noise
SCAN = "/lidar/scan"
COLUMNS = ("ros_topic", "ros_type", "gz_topic", "gz_type", "direction", "publisher")


def gz_ends(tried: Tried, topic: str) -> dict[str, list[str]]:
    """Return the types of a Gazebo topic's publishers and of its subscribers, one entry for each of them."""
    ends: dict[str, list[str]] = {"Publishers": [], "Subscribers": []}
    group = ""
    for line in tried.command(f"gz topic -i -t {topic}").splitlines():
        group = line.split()[0] if line.startswith(tuple(ends)) else group
        if "tcp://" in line:
            ends[group].append(line.split(", ")[1])
    return ends


@step("measure", objective=1, form=COMMANDS)
def measure(tried: Tried) -> str:
    """One message of the IMU is printed."""
    found = re.search(r"linear_acceleration \{[^}]*z: (\S+)", tried.output)
    count = tried.output.count("linear_acceleration {")
    if found is None:
        raise NotYet("The command printed no message of the IMU, which has a field linear_acceleration.")
    expect(count == 1, f"The command printed {count} messages; one is wanted.")
    upwards = float(found[1])
    expect(GRAVITY[0] < upwards < GRAVITY[1], f"The IMU measures {upwards:z.2f} m/s^2 upwards. Has the robot fallen?")
    return f"The IMU measures {upwards:z.2f} m/s^2 upwards: so strongly the floor holds the robot up."


@step("turn_left", objective=2, form=COMMANDS)
def turn_left(tried: Tried) -> str:
    """The robot turns on the spot, to the left, at 0.5 rad/s, by a command of Gazebo."""
    moves = motion_in_the_middle(tried)
    expect_turn(moves, 0.5)
    return f"The robot {moves}: to the left, on the spot."


@step("through", objective=4, form=COMMANDS)
def through(tried: Tried) -> str:
    """The robot turns on the spot, to the right, at 0.5 rad/s, by a message of ROS."""
    moves = motion_in_the_middle(tried)
    expect_turn(moves, -0.5)
    return f"The robot {moves}: a message of ROS reached a robot in Gazebo."


@step("row", objective=2, form="row.yaml")
def row(tried: Tried) -> str:
    """The row says of /lidar/scan its name and type on either side, its direction, and who publishes it in ROS."""
    try:
        rows = yaml.safe_load(tried.body)
    except yaml.YAMLError as error:
        raise NotYet(f"The row is no YAML: {str(error).partition(chr(10))[0]}.") from None
    one = isinstance(rows, list) and len(rows) == 1 and isinstance(rows[0], dict)
    expect(one, "One row is wanted: a dash, and six columns below each other.")
    said: dict[str, Any] = rows[0]
    missing = [each for each in COLUMNS if said.get(each) is None]
    expect(not missing, f"The row has no {' and no '.join(missing)}.")
    expect(said["ros_topic"] == SCAN, f"The row is about {said['ros_topic']}; one about {SCAN} is wanted.")
    in_ros, in_gazebo = tried.topics(SCAN), tried.gz_topics(str(said["gz_topic"]))
    expect(SCAN in in_ros, f"ROS has no {SCAN} now; run the cell that starts the bridge.")
    expect(said["gz_topic"] in in_gazebo, f"Gazebo has no topic {said['gz_topic']}.")
    ends = gz_ends(tried, str(said["gz_topic"]))
    expect(said["ros_type"] in in_ros[SCAN], f"{said['ros_type']} is not the type that ROS says {SCAN} has.")
    expect(
        said["gz_type"] in ends["Publishers"] + ends["Subscribers"],
        f"{said['gz_type']} is not the type that Gazebo says {said['gz_topic']} has.",
    )
    names = tried.publishers(SCAN)
    expect(
        str(said["publisher"]).strip("/") in names,
        f"In ROS, {said['publisher']} does not publish {SCAN}; who does is a node of ROS.",
    )
    expect(
        said["direction"] == "GZ_TO_ROS",
        f"{said['direction']} is not the way of the scans: Gazebo's lidar publishes, and ROS only receives.",
    )
    return f"Gazebo publishes {said['gz_topic']}, and {names[0]} publishes it again in ROS."


@step("imu_bridge", objective=3)
def imu_bridge(tried: Tried) -> str:
    """A second bridge carries the IMU to ROS, and nothing back."""
    argument = tried.value("argument", str)
    try:
        heard = tried.heard("/imu", "sensor_msgs/msg/Imu", count=3)
    except NotYet:
        raise NotYet(f"No sensor_msgs/msg/Imu came on /imu in ROS; the bridge was told {argument!r}.") from None
    expect(
        not tried.both_ways("/imu"),
        "The measurements come, but the bridge also listens to /imu in ROS, to pass it on to Gazebo.",
    )
    return f"ROS has the IMU: {heard[0].linear_acceleration.z:z.2f} m/s^2 upwards."
