"""`scans`: do good scans of a 2-D lidar arrive in ROS: often, with the right frame, and of the world, not of the robot?

kind = "scans"
topic = "scan"            # ROS topic
frame = "lidar_link"      # header.frame_id
rate = 5.0                # optional: [Hz] at least, over the whole run
rays = 180                # optional: at least
round = 6.2               # optional: [rad] from the first ray to the last, at least
reach = 10.0              # optional: [m] range_max, at least
clear = 0.35              # optional: [m] around the lidar in which there is nothing but the robot
robot = "scout"           # optional: model with the lidar, whose parts may tell what is wrong
sees = 0.6                # optional: fraction of the rays that hit something, at least
"""

from __future__ import annotations

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.predictions.of_robots import scanning
from gz_course.grader.feedback.predictions.of_robots.topics import why_not_carried
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding, check_kind
from gz_course.grader.score.graphs import bridges
from gz_course.grader.score.launched import logged_error
from gz_course.grader.score.robots import Robot, robot_of
from gz_course.grader.score.steps import told

TYPE = "sensor_msgs/msg/LaserScan"
OWN = 0.02  # fraction of the rays that may be shorter than `clear`


@check_kind("scans")
def scans(recording: Recording, parameters: Table) -> Finding:
    """Pass if the scans came at the rate, with the frame, number and reach of rays, and show what stands around."""
    topic, frame = parameters.text("topic"), parameters.text("frame")
    rate, rays = parameters.number("rate", 5.0, above=0), parameters.number("rays", 180, above=0)
    turn, reach = parameters.number("round", 6.2, above=0), parameters.number("reach", 10.0, above=0)
    clear, sees = parameters.number("clear", 0.35, above=0), parameters.number("sees", 0.6, above=0)
    expected = f"scans with the frame {frame} on /{topic}, of what stands around the robot"
    name = parameters.text("robot") if parameters.has("robot") else ""
    body = robot_of(recording, name) if name else None
    base = f"topics/{topic}"
    count = len(recording.signal(f"{base}/count"))
    least = rate * (recording.ended_s - 0.5)
    _, ranges = recording.arrays(f"{base}/ranges")
    if not count or not ranges:
        return Finding(False, expected, "no scan arrived", explanation=_why_none(recording, f"/{topic}", body))
    if body and (why := scanning.of_gazebo_classic(body)):
        return Finding(False, expected, "scans came here, and would not come in Gazebo", explanation=why)
    if count < least:
        measured = f"{count} scans arrived, less than {rate:g} in a second of simulated time"
        return Finding(False, expected, measured, explanation=scanning.few_scans(body, rate) if body else "")
    frames = [line.text for line in recording.lines(f"{base}/header/frame_id")]
    if frames != [frame]:
        given = frames[0] if frames else ""
        why = scanning.other_frame(body, frame, given) if body else ""
        if not why and "/" in given:
            why = "without <gz_frame_id> Gazebo makes a name of model, link and sensor"
        return Finding(False, expected, f"the frame_id was {given!r}", explanation=why)
    first, last = (float(recording.signal(f"{base}/angle_{end}").values[-1]) for end in ("min", "max"))
    if min(map(len, ranges)) < rays or last - first < turn:
        measured = f"a scan had {len(ranges[-1])} rays over {told(last - first)} rad"
        measured += f"; at least {rays:g} over {told(turn)} rad are asked for"
        return Finding(False, expected, measured, explanation=scanning.narrow(body, turn) if body else "")
    longest = float(recording.signal(f"{base}/range_max").values[-1])
    if longest < reach:
        measured = f"range_max was {told(longest)} m; at least {told(reach)} m is asked for"
        return Finding(False, expected, measured, explanation=scanning.range_of(body) if body else "")
    every = np.concatenate(ranges)
    with np.errstate(invalid="ignore"):
        own = float(np.mean(every < clear))  # -inf is nearer than the lidar can measure
        hits = float(np.mean((every >= clear) & (every <= longest)))
    if own > OWN:
        why = "the lidar sees the robot itself: it must stand higher than all the rest, or out of its way"
        why = (scanning.tilted(body) or scanning.enclosed(body) if body else "") or why
        measured = f"{_percent(own)} of the rays ended within {told(clear)} m, where nothing else stands"
        return Finding(False, expected, measured, explanation=why)
    if hits < sees:
        why = "the rays pass over what stands around, or miss it: look at the height and tilt of the lidar"
        height = recording.signal(f"truth/{name}/z").values
        if body and len(height) and (place := scanning.height_and_tilt(body, float(height[-1]))):
            why = f"the rays pass over what stands around, or miss it: {place}"
        return Finding(False, expected, f"only {_percent(hits)} of the rays hit anything", explanation=why)
    return Finding(True, expected, f"{count} scans, {_percent(hits)} of their rays hit something")


def _percent(fraction: float) -> str:
    return f"{100 * fraction:.0f} %"


def _why_none(recording: Recording, topic: str, body: Robot | None) -> str:
    """Return why no scan came: no bridge, its direction or type is wrong, or nothing publishes in Gazebo."""
    made = bridges(recording)
    said, remapped = logged_error(recording, "parameter_bridge"), recording.facts().get("remappings", [])
    if why := why_not_carried(made, topic, TYPE, to_gz=False, said=said, remapped=remapped):
        return why
    bridge = next(each for each in made if each.ros_topic == topic)
    if body and (why := scanning.no_scan(body, bridge)):
        return why
    return f"{bridge.place}: nothing in Gazebo publishes {bridge.gz_topic}: no sensor has that topic, or none is there"
