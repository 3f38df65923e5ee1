"""The cells that the reader of chapter 12 writes."""

from __future__ import annotations

import re
from collections.abc import Callable

import yaml

from gz_course.grader.lessons.motion import motion_in_the_middle, motion_of
from gz_course.grader.lessons.observer import SEEN
from gz_course.grader.lessons.step import COMMANDS, Tried, expect, step

SCAN, TWIST, CLOCK, FLOAT = (
    "sensor_msgs/msg/LaserScan",
    "geometry_msgs/msg/Twist",
    "rosgraph_msgs/msg/Clock",
    "std_msgs/msg/Float64",
)
NODE = "stopper"  # which computes the commands of this system
BRIDGE = "ros2 run ros_gz_bridge parameter_bridge"
TRIES = 4  # a single message may be lost
IN_ROS, COMMAND, WHEELS = 3, 5, 7  # numbers of stations: /scan and /cmd_vel in ROS, the wheels


def publishers(tried: Tried, known: Callable[[dict[str, list[str]]], object]) -> dict[str, list[str]]:
    """Return who publishes on each topic of the system, as soon as it is known, or in the end."""
    with tried.node() as (node, spin_until):

        def look() -> dict[str, list[str]]:
            ends = {topic: node.get_publishers_info_by_topic(topic) for topic in ("/clock", "/scan", "/cmd_vel")}
            named = {topic: sorted(each.node_name for each in found) for topic, found in ends.items()}
            return {topic: [name for name in names if "UNKNOWN" not in name] for topic, names in named.items()}

        spin_until(lambda: bool(known(look())), SEEN)
        return look()


def stand(tried: Tried) -> None:
    """Let the robot stand: it keeps the last command that a bridge has carried to it."""
    for _ in range(TRIES):
        tried.command("gz topic -t /model/robot/cmd_vel -m gz.msgs.Twist -p ''")
        if motion_of(tried.poses("robot", 0.5)).way < 0.01:
            return


@step("let_run", objective=2, form=COMMANDS)
def let_run(tried: Tried) -> str:
    """Time runs in the world that was paused."""
    said = tried.command("gz topic -e -t /stats -n 1")
    found = re.search(r"iterations: (\d+)", said)
    at = f" at step {found[1]}" if found else ""
    expect("paused: true" not in said, f"The world is paused{at}; time that runs is wanted.")
    expect(found, "The world says nothing on /stats.")
    return f"The world is not paused any more; it is{at}."


@step("reached", objective=1)
def reached(tried: Tried) -> str:
    """`reached` is the last station that data reaches."""
    said, stations = tried.value("reached", str), list(tried.value("stations", list))
    expect(said in stations, f"{said!r} is none of the stations.")
    tried.heard("/scan", SCAN)
    last = IN_ROS
    if not tried.silent("/cmd_vel", TWIST, 3.0):
        last = WHEELS if motion_of(tried.poses("robot", 1.0)).way > 0.02 else COMMAND
    name, number = said.replace("\n", " "), stations.index(said)
    expect(number >= last, f"The data comes further than `{name}`: count the messages of the station after it.")
    expect(number <= last, f"The data does not come to `{name}`: count the messages of the station before it.")
    return f"The data comes to `{name}`, and no further: look at the way from there to the next station."


@step("repaired_qos", objective=2, form="free.py")
def repaired_qos(tried: Tried) -> str:
    """The node gets scans, and publishes the free distance."""
    tried.start("python free.py --ros-args -p use_sim_time:=true", ready="ready")
    try:
        free = tried.heard("/free", FLOAT, deadline=6.0)[0].data
        scan = tried.heard("/scan", SCAN)[0]
    finally:
        tried.stop("python free.py")
    nearest = min(r for r in scan.ranges if scan.range_min < r < scan.range_max)
    expect(
        abs(free - nearest) < 0.3,
        f"The node says {free:z.1f} m, and the nearest point of the scan is {nearest:z.1f} m away.",
    )
    return f"The node gets scans, and publishes {free:z.1f} m."


@step("culprit", objective=2)
def culprit(tried: Tried) -> str:
    """`culprit` is the node that publishes on /cmd_vel, and should subscribe there."""
    said = tried.value("culprit", str).strip("/")
    there = publishers(tried, lambda ends: len(ends["/cmd_vel"]) > 1)["/cmd_vel"]
    expect(there != [NODE], f"Only {NODE} publishes on /cmd_vel now; run the cells from the one that makes `room`.")
    expect(said in there, f"No node called {said} publishes on /cmd_vel.")
    expect(said != NODE, f"{NODE} computes the commands, so it publishes rightly.")
    return f"{said} publishes on /cmd_vel, as {NODE} does, and should take the commands from there."


@step("three_topics", objective=2, form="system.yaml")
def three_topics(tried: Tried) -> str:
    """The bridge carries the clock and the scans to ROS, and the commands to Gazebo."""
    tried.stop(BRIDGE)
    stand(tried)
    tried.start(f"{BRIDGE} --ros-args -p config_file:=system.yaml", ready="ready")
    ends = publishers(tried, lambda ends: ends["/clock"] and ends["/scan"] and ends["/cmd_vel"])
    others = [name for name in ends["/cmd_vel"] if name != NODE]
    expect(not others, f"The bridge also publishes on /cmd_vel; one way is wanted, from {NODE} to Gazebo.")
    tried.heard("/clock", CLOCK, deadline=5.0)
    tried.heard("/scan", SCAN, deadline=5.0)
    speed = motion_in_the_middle(tried, 1.0).speed
    expect(speed > 0.05, f"{NODE} commands 0.1 m/s, and the robot does not drive: the commands go elsewhere in Gazebo.")
    return f"Clock and scans come, commands go one way, and the robot drives at {speed:z.1f} m/s."


@step("lidar_behind", objective=2)
def lidar_behind(tried: Tried) -> str:
    """The frame of the lidar is 0.2 m behind that of base_link."""
    said = tried.command("ros2 topic echo --once --qos-durability transient_local /tf_static")
    found = (yaml.safe_load(said.partition("\n---")[0]) or {}).get("transforms", [])
    expect(found, "Nobody publishes a frame that stands still.")
    parent, child = found[0]["header"]["frame_id"], found[0]["child_frame_id"]
    expect(
        {parent, child} == {"base_link", "lidar_link"},
        f"The transform is between {parent} and {child}; base_link and lidar_link are wanted.",
    )
    x = found[0]["transform"]["translation"]["x"] * (1 if parent == "base_link" else -1)
    where = f"The lidar is {abs(x):z.2f} m {'behind' if x < 0 else 'in front of'} base_link"
    expect(abs(x + 0.2) < 0.005, f"{where}; 0.2 m behind is wanted.")
    return f"{where}, and {parent} is the parent."


@step("commands_bag", objective=3)
def commands_bag(tried: Tried) -> str:
    """The bag runs/commands has the commands of the node, and nothing else."""
    expect((tried.folder / "runs/commands").is_dir(), "There is no bag runs/commands.")
    said = tried.command("ros2 bag info runs/commands")
    found = {topic: int(count) for topic, count in re.findall(r"Topic: (\S+).*?Count: (\d+)", said)}
    others = sorted(found.keys() - {"/cmd_vel"})
    expect(not others, f"The bag has {', '.join(others)}; only /cmd_vel is wanted.")
    count = found.get("/cmd_vel", 0)
    expect(count >= 2, f"The bag runs/commands has {count} messages of /cmd_vel; at least two are wanted.")
    return f"The bag has {count} commands, and nothing else."
