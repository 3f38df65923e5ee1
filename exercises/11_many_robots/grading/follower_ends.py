"""Why a follower gets or sends nothing although its topics have the right names: types and quality of service."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.launched import own_end, without_sim_time

SELDOM = 0.4  # [s] between the commands of a follower
SILENT = 2.5  # [s] before the end of a run
FEWEST = 8  # commands of a follower that goes on
__all__ = ["without_sim_time"]  # for `convoy_checks.py`
BY_OTHERS = re.compile(
    r"^\[INFO\] \[(?!gz-|gazebo-|parameter_bridge-|create-|ruby-|ros2-)([^\]]+)-\d+\]: process started"
)
NO_PROGRAM = re.compile(r"there is no program '(.*)' to be started")
TWIST, ODOMETRY = "geometry_msgs/msg/Twist", "nav_msgs/msg/Odometry"


def unheard(ends: list[Any], name: str, front: str) -> str:
    """Return what keeps the messages of a follower's topics from arriving; empty if nothing is seen."""
    mine = [end for end in ends if end["node"] == f"/{name}/follower"]
    for end in mine:
        listens = end["kind"] == "subscription" and end["topic"] in (f"/{name}/odom", f"/{front}/odom")
        speaks = end["kind"] == "publisher" and end["topic"] == f"/{name}/cmd_vel"
        if not listens and not speaks:
            continue
        what, kind = ("subscription to", ODOMETRY) if listens else ("publisher on", TWIST)
        given = end.get("type", kind)
        if given != kind:
            return (
                f"its {what} {end['topic']} has the type {given}, and the topic carries {kind}: DDS connects equal "
                "types only, so nothing arrives"
            )
        if speaks and end.get("reliability") == "BEST_EFFORT":
            return (
                f"its publisher on {end['topic']} offers the reliability BEST_EFFORT, and the bridge asks for "
                "RELIABLE, so not one command arrives: use the default QoS, a depth of 10"
            )
        if listens and end.get("durability") == "TRANSIENT_LOCAL":
            return (
                f"its subscription to {end['topic']} asks for the durability TRANSIENT_LOCAL, which the bridge does "
                "not offer, so it gets nothing: use the default QoS, a depth of 10"
            )
    return ""


def ended_by_itself(recording: Recording) -> str:
    """Return which line of a program of the submission has ended it without an error; empty if none is known."""
    ended = recording.facts().get("launch", {}).get("ended_early", [])
    return next(filter(None, (own_end(recording, each["program"]) for each in ended if not each["code"])), "")


def few(recording: Recording, name: str) -> str:
    """Return that a follower stopped sending commands after the first; empty if it did not."""
    times = recording.signal(f"topics/{name}/cmd_vel/linear/x").times / 1e9
    seen = recording.signal(f"truth/{name}/distance").times / 1e9
    rest = float(seen[-1] - times[-1]) if len(seen) and len(times) else 0.0
    silent = rest > max(SILENT, 3 * float(np.diff(times).max(initial=0.0)))
    if not len(times) or (len(times) >= FEWEST and not silent):
        return ""
    last = f"its last command comes at {times[-1]:.1f} s"
    if silent and (said := ended_by_itself(recording)):
        last += f", because its process has ended by itself: {said}"
    elif silent and (said := suspect(recording, "silenced")):
        last += f": {said}"
    return f"its node publishes {len(times)} command{'s' if len(times) > 1 else ''} only, and {last}"


def too_seldom(recording: Recording, name: str) -> str:
    """Return that a follower sends its commands too seldom; empty if it does not."""
    times = recording.signal(f"topics/{name}/cmd_vel/linear/x").times / 1e9
    if len(times) < 3 or (apart := float(np.median(np.diff(times)))) < SELDOM:
        return ""
    return (
        f"its node sends a command every {apart:.1f} s only, and the robot obeys the old one meanwhile: it falls "
        "behind, and drives on when it should stop; call create_timer with a shorter period [s], such as 0.1"
    )


def one_name_for_several(started: int, followers: list[str]) -> str:
    """Return that several programs have become one node, by its name; empty if as many have started as there are."""
    if not followers or started <= len(followers):
        return ""
    return (
        f"{started} programs were started, and all are called {' or '.join(followers)}: each takes its namespace "
        "from its command line, -r __ns:=/robot3, of which the first one counts, unless its own code names one"
    )


def missing(name: str, names: list[str], followers: list[str]) -> str:
    """Return which robots have no follower, if it is only the last one, or all but the last one; else nothing."""
    if name == names[-1] and followers == [f"/{each}/follower" for each in names[1:-1]]:
        return f"only the last robot, {name}, has no follower, as with a range(2, n), which ends before n"
    if followers == [f"/{names[-1]}/follower"]:
        return (
            f"only the last robot, {names[-1]}, has a follower: its action is made once, behind the loop over the "
            "robots, or each turn of the loop replaces that of the one before"
        )
    return ""


def started(recording: Recording) -> int:
    """Return how often the launch has started the program that it starts most, besides simulator, bridges, create."""
    names = [match[1] for line in recording.lines("log/student") if (match := BY_OTHERS.match(line.text))]
    return max((names.count(name) for name in names), default=0)


def no_program(recording: Recording) -> str:
    """Return the program of an action that the launch did not find; empty if it found all."""
    lines = (NO_PROGRAM.search(line.text) for line in recording.lines("log/student"))
    return next((match[1] for match in lines if match), "")
