"""The cells that the reader of chapter 11 writes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from gz_course.grader.lessons.motion import motion_of
from gz_course.grader.lessons.step import COMMANDS, NotYet, Tried, expect, step

ODOMETRY, FLOAT = "nav_msgs/msg/Odometry", "std_msgs/msg/Float64"
BRIDGE = "ros2 run ros_gz_bridge parameter_bridge"
PLACES = {"robot1": (0.0, 0.0), "robot2": (-1.2, 0.0), "robot3": (-1.2, 1.2)}  # [m]
OFF = 0.1  # [m] that a robot may be beside its place
TURNS = 4  # [s] of simulated time in which a robot begins to turn
GRAPH = 8.0  # [s] until a node that has said "ready" is known with all its topics
LAUNCHED = 20.0  # [s] until several nodes are
STARTED = "process started with pid"  # what launch says of each process

Seen = TypeVar("Seen")


def seen(tried: Tried, look: Callable[[Any], Seen], right: Callable[[Seen], bool], deadline: float = GRAPH) -> Seen:
    """Return what a node sees of the graph as soon as it is right, or in the end [s]."""
    with tried.node() as (node, spin_until):
        spin_until(lambda: right(look(node)), deadline)
        return look(node)


def robots_topics(node: Any) -> list[str]:
    """Return all topics but the clock, and those that every node has."""
    every = {"/clock", "/rosout", "/parameter_events"}
    return sorted({name for name, _ in node.get_topic_names_and_types()} - every)


def steered(node: Any) -> list[str]:
    """Return the topics of commands on which somebody publishes."""
    return [name for name in robots_topics(node) if name.endswith("/cmd_vel") and node.count_publishers(name)]


@step("third", objective=1, form=COMMANDS)
def third(tried: Tried) -> str:
    """robot3 stands 1.2 m to the left of robot2."""
    try:
        at = tried.poses("robot3")[-1]
        where = f"robot3 is at x = {at.x:z.2f} m, y = {at.y:z.2f} m"
        right = abs(at.x - PLACES["robot3"][0]) < OFF and abs(at.y - PLACES["robot3"][1]) < OFF
        expect(right, f"{where}; 1.2 m to the left of robot2 is wanted. It is taken out of the world again.")
    except NotYet:
        for name in ("robot3", "robot"):  # what a wrong cell created is not in the way of the next one
            tried.remove(name)
        for name in ("robot1", "robot2"):
            tried.place(name, *PLACES[name])
        raise
    return f"{where}, to the left of robot2."


@step("own_names", objective=2, form="robot2.yaml")
def own_names(tried: Tried) -> str:
    """The bridge joins /robot2/cmd_vel and /robot2/odom with the topics of robot2 in Gazebo."""
    tried.start(f"{BRIDGE} --ros-args -p config_file:=robot2.yaml", ready="ready")
    wanted = ["/robot2/cmd_vel", "/robot2/odom"]
    there = seen(tried, robots_topics, lambda names: names == wanted)
    expect(there == wanted, f"The bridge has {' and '.join(there) or 'no topics'}; {' and '.join(wanted)} are wanted.")
    tried.heard("/robot2/odom", ODOMETRY)
    tried.place("robot2", *PLACES["robot2"])
    try:
        tried.command(_say("/robot2/cmd_vel", 0.2))
        speed = motion_of(tried.poses("robot2", 1.0)).speed
        says = tried.heard("/robot2/odom", ODOMETRY)[0].twist.twist.linear.x
        expect(abs(speed) > 0.1, "0.2 m/s on /robot2/cmd_vel, and robot2 does not drive: Gazebo has another topic.")
        expect(abs(says - speed) < 0.1, f"robot2 drives at {speed:z.1f} m/s, and /robot2/odom says {says:z.1f} m/s.")
    finally:
        for name in ("robot1", "robot2"):
            tried.command(f"gz topic -t /model/{name}/cmd_vel -m gz.msgs.Twist -p ''")
    return f"0.2 m/s on /robot2/cmd_vel, and robot2 drives at {speed:z.1f} m/s, as /robot2/odom says."


def _say(topic: str, speed: float) -> str:
    return f"ros2 topic pub --times 10 --rate 10 {topic} geometry_msgs/msg/Twist '{{linear: {{x: {speed}}}}}'"


@step("for_robot1", objective=3)
def for_robot1(tried: Tried) -> str:
    """The node of spinner.py turns robot1."""
    topics = seen(tried, steered, bool, LAUNCHED)
    expect(topics, "No node publishes commands.")
    expect(
        topics == ["/robot1/cmd_vel"],
        f"Your node publishes on {topics[0]}{', which steers no robot' if topics[0] == '/cmd_vel' else ''}; "
        "/robot1/cmd_vel is wanted.",
    )
    for _ in range(TURNS):
        rate = motion_of(tried.poses("robot1", 1.0)).rate
        if rate > 0.3:
            break
    expect(rate > 0.3, f"robot1 turns at {rate:z.1f} rad/s; 0.5 is wanted.")
    return f"The node is in the namespace /robot1, and robot1 turns at {rate:z.1f} rad/s."


@step("any_robot", objective=3, form="gap.py")
def any_robot(tried: Tried) -> str:
    """The node measures the gap between any two robots: names of its own robot, and of `front`."""
    for name, x, option in (("cart", 1.0, "--rate"), ("lead", 3.0, "-r")):
        topic = f"/{name}/odom nav_msgs/msg/Odometry '{{pose: {{pose: {{position: {{x: {x}}}}}}}}}'"
        tried.start(f"ros2 topic pub {option} 10 {topic}", ready="publishing #1")
    try:
        for own, front, wanted in (("cart", "lead", 3.2), ("lead", "cart", -0.8)):
            tried.start(f"python gap.py --ros-args -r __ns:=/{own} -r front/odom:=/{front}/odom", ready="ready")
            gaps = seen(tried, lambda node: [each for each in robots_topics(node) if each.endswith("gap")], bool)
            expect(gaps, "The node publishes on no topic called gap.")
            expect(gaps != ["/gap"], f"In the namespace /{own} the node publishes on /gap, which is in no namespace.")
            said = tried.heard(f"/{own}/gap", FLOAT)[0].data
            expect(
                abs(said - wanted) < 0.01,
                f"/{own}/odom and /{front}/odom are {wanted:z.2f} m apart, with the gap; it says {said:z.2f} m.",
            )
    finally:
        for command in ("python gap.py", "ros2 topic pub"):
            tried.stop(command)
    return "In two namespaces the node heard its own robot and the one in front, and published the gap."


@step("for_each", objective=4, form="spinners.launch.py")
def for_each(tried: Tried) -> str:
    """With robots:=4, a spinner runs for robot2, robot3 and robot4."""
    tried.stop("python spinner.py")
    wanted = [f"/robot{number}/cmd_vel" for number in (2, 3, 4)]
    try:
        tried.start("ros2 launch spinners.launch.py robots:=4", ready="ready")
        topics = seen(tried, steered, lambda names: set(wanted) <= set(names), LAUNCHED)
    finally:
        started = tried.stop("ros2 launch").count(STARTED)
    for number, name in enumerate(wanted, 2):
        expect(name in topics, f"With robots:=4, robot{number} has no spinner.")
    expect(started == len(wanted), f"With robots:=4, {started} spinners run; 3 are wanted, for robots 2, 3 and 4.")
    return "With robots:=4 there is a spinner for robot2, robot3 and robot4."
