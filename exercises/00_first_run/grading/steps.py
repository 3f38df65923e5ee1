"""The cells that the reader of chapter 0 writes."""

from __future__ import annotations

import math
import re
from typing import Any

from gz_course.grader.lessons.motion import motion_in_the_middle
from gz_course.grader.lessons.observer import SEEN, until_known
from gz_course.grader.lessons.step import COMMANDS, NotYet, Tried, expect, step

POSITION = re.compile(r"\[(-?\d\S*) (-?\d\S*) (-?\d\S*)\]")
TICKS = 45  # tenths of a second that its time lasts
NEAR = 0.5  # [m] that the robot may have driven since its position was printed


def greetings(tried: Tried, command: str) -> list[Any]:
    """Return what comes on /greeting; the node's time begins when it has been found, so that nothing is lost."""
    Clock, String = tried.message_type("rosgraph_msgs/msg/Clock"), tried.message_type("std_msgs/msg/String")
    heard: list[Any] = []
    with tried.node() as (node, spin_until):
        node.create_subscription(String, "/greeting", heard.append, 10)
        clock = node.create_publisher(Clock, "/clock", 10)
        tried.start(command, ready="")
        until_known(node, spin_until, "/greeting")
        spin_until(lambda: clock.get_subscription_count() > 0, SEEN)
        expect(not heard, "A message came on /greeting at once, before the timer fired.")
        for tick in range(1, TICKS):
            now = Clock()
            now.clock.sec, now.clock.nanosec = tick // 10, tick % 10 * 100_000_000
            clock.publish(now)
            spin_until(lambda: False, 0.05)
        spin_until(lambda: bool(heard), SEEN)
    tried.stop(command)
    return heard


@step("drive", objective=2)
def drive(tried: Tried) -> str:
    """The robot drives straight ahead at 0.3 m/s."""
    moves = motion_in_the_middle(tried)
    seen = f"The robot {moves}"
    expect(abs(moves.rate) < 0.03, f"{seen}; straight ahead means 0 rad/s.")
    expect(abs(moves.speed - 0.3) < 0.03, f"{seen}; 0.3 m/s is wanted.")
    return f"{seen}: you have moved a robot."


@step("stop", objective=2, form=COMMANDS)
def stop(tried: Tried) -> str:
    """The robot stands still."""
    moves = motion_in_the_middle(tried)
    expect(moves.stands, f"The robot still {moves}; it obeys the last command it got.")
    return "The robot stands still."


@step("where", objective=1, form=COMMANDS)
def where(tried: Tried) -> str:
    """The position of the robot is printed."""
    found = POSITION.search(tried.output)
    if found is None:
        raise NotYet("The command printed no position, three numbers in brackets.")
    x, y = float(found[1]), float(found[2])
    robot = tried.poses("robot")[-1]
    expect(
        math.hypot(x - robot.x, y - robot.y) < NEAR,
        f"The position printed is ({x:z.2f}, {y:z.2f}) m; the robot is at ({robot.x:z.2f}, {robot.y:z.2f}) m.",
    )
    return f"The robot is at ({x:z.2f}, {y:z.2f}) m, and the command says so."


@step("greeting", objective=3)
def greeting(tried: Tried) -> str:
    """`greeting` is a std_msgs/msg/String that says good night."""
    said = tried.value("greeting", tried.message_type("std_msgs/msg/String")).data
    expect(said == "good night", f"The message says {said!r}; 'good night' is wanted, letter by letter.")
    return "It is a String that says 'good night'."


@step("once", objective=3, form="once_node.py")
def once(tried: Tried) -> str:
    """The node publishes good night on /greeting exactly once, one second after its start."""
    heard = greetings(tried, "python once_node.py --ros-args -p use_sim_time:=true")
    expect(heard, "once_node.py was started, and no message came on /greeting.")
    said = heard[0].data
    expect(said == "good night", f"On /greeting came {said!r}; 'good night' is wanted.")
    expect(len(heard) == 1, "The node greets again and again; once is wanted, so its timer should end.")
    return "'good night' came on /greeting once, and nothing after it."


@step("mean_speed", objective=4)
def mean_speed(tried: Tried) -> str:
    """`mean_speed` is the way of the robot by the time of the run [m/s]."""
    recording = tried.recording()
    way, time = float(recording.signal("truth/robot/distance").values[-1]), recording.ended_s
    said = float(tried.value("mean_speed", (int, float)))
    expect(
        abs(said - way / time) < 0.01,
        f"The robot drove {way:z.2f} m in a run of {time:z.2f} s; {said:z.2f} m/s is not its mean speed.",
    )
    return f"{way:z.2f} m in {time:z.2f} s: on average {said:z.2f} m/s."
