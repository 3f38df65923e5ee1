"""The cells that the reader of chapter 5 writes."""

from __future__ import annotations

import re

from gz_course.grader.lessons.motion import motion_in_the_middle
from gz_course.grader.lessons.step import NotYet, Tried, expect, step

BRIDGE = "ros2 run ros_gz_bridge"
SCAN = "sensor_msgs/msg/LaserScan"
ERROR = re.compile(r"^\[ERROR\] \[\S+\] \[ros_gz_bridge\]: (.*)$", re.MULTILINE)
FAULT = re.compile(r"^\S+:\d+: (?:error|warning): .*$", re.MULTILINE)
SECONDS = 1.5  # of simulated time in which a motion is looked at
AHEAD = 0.3  # [m/s] that is commanded
MENDED = {
    "/scan": "sensor_msgs/msg/LaserScan",
    "/odom": "nav_msgs/msg/Odometry",
    "/imu/data": "sensor_msgs/msg/Imu",
    "/clock": "rosgraph_msgs/msg/Clock",
    "/camera/image_raw": "sensor_msgs/msg/Image",
}


def bridged(tried: Tried, file: str) -> None:
    """Start a bridge with this file in place of the one before. Raises NotYet with an error that it reports."""
    output = tried.start(f"{BRIDGE} parameter_bridge --ros-args -p config_file:={file}", ready="ready")
    if error := ERROR.search(output):
        raise NotYet(f"The bridge says: {error[1]}.")


def drives_by(tried: Tried, topic: str) -> None:
    """Command the robot ahead on a ROS topic, and expect that it drives, and that no command comes back."""
    expect(tried.subscribers(topic), f"Nobody in ROS listens to {topic}: the bridge carries no command to Gazebo.")
    pub = f"ros2 topic pub --once {topic} geometry_msgs/msg/Twist"
    tried.command(f"{pub} '{{linear: {{x: {AHEAD}}}}}'")
    moves = motion_in_the_middle(tried, SECONDS)
    tried.command(f"{pub} '{{}}'")
    expect(
        abs(moves.speed - AHEAD) < 0.05,
        f"{AHEAD} m/s was commanded on {topic}, and the robot {moves}: who listens to that name in Gazebo?",
    )
    back = tried.both_ways(topic)
    expect(not back, f"The robot obeys, but the bridge also publishes on {topic}; commands go one way only.")


@step("command", objective=4, form="command.yaml")
def command(tried: Tried) -> str:
    """The robot obeys /cmd_vel."""
    bridged(tried, "command.yaml")
    drives_by(tried, "/cmd_vel")
    tried.stop(BRIDGE)
    return f"The robot drives at {AHEAD} m/s, as was commanded on /cmd_vel."


@step("scan", objective=1, form="scan.yaml")
def scan(tried: Tried) -> str:
    """The scans come on /front/scan, in the frame laser, and only while somebody listens."""
    bridged(tried, "scan.yaml")
    expect(tried.publishers("/front/scan"), "The bridge has no topic /front/scan in ROS.")
    lazy = "No subscribers" in tried.command("gz topic -i -t /lidar/scan")
    heard = tried.heard("/front/scan", SCAN)[0]
    frame = heard.header.frame_id
    expect(frame == "laser", f"The scans on /front/scan are in the frame {frame}; laser is wanted.")
    expect(lazy, "The scans come, but the bridge takes them from Gazebo even while nobody in ROS listens.")
    back = tried.both_ways("/front/scan", SCAN)
    expect(not back, f"The scans come, but {', '.join(back)} listens to /front/scan in ROS, to pass it on to Gazebo.")
    tried.stop(BRIDGE)
    return "/front/scan has scans in the frame laser, and Gazebo is asked only while somebody listens."


@step("mended", objective=3, form="mended.yaml")
def mended(tried: Tried) -> str:
    """The five mistakes are gone, and all five topics come."""
    if fault := FAULT.search(tried.command(f"{BRIDGE} lint mended.yaml")):
        raise NotYet(f"lint says: {fault[0]}")
    bridged(tried, "mended.yaml")
    have = tried.topics(*MENDED)
    for topic, kind in MENDED.items():
        expect(kind in have.get(topic, []), f"ROS has no topic {topic} with messages {kind}.")
        tried.heard(topic, kind)
    tried.stop(BRIDGE)
    return "lint finds nothing, and all five topics carry messages."


@step("forwards", objective=2, form="forwards.yaml")
def forwards(tried: Tried) -> str:
    """The robot obeys /drive, and ROS has the clock."""
    bridged(tried, "forwards.yaml")
    drives_by(tried, "/drive")
    tried.heard("/clock", "rosgraph_msgs/msg/Clock")
    expect(
        not tried.both_ways("/clock"),
        "The bridge also listens to /clock in ROS; only Gazebo should say what time it is.",
    )
    tried.stop(BRIDGE)
    return f"The robot drives at {AHEAD} m/s, as was commanded on /drive, and ROS has the clock."
