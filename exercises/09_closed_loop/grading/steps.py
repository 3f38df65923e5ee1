"""The cells that the reader of chapter 9 writes."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import yaml

from gz_course.grader.lessons.step import COMMANDS, Tried, expect, step

PERIOD = 0.1  # [s] between two scans
START = 2.02  # [m] the error at first, as in the chapter
BESIDE = 0.8 * math.pi  # [rad] bearing up to which a wall is beside the robot
MOST = 1.5  # [rad/s]
HEARD = 50.0  # [s] until the first message, and until all of them
WANTED, SPEED = 0.6, 0.4  # [m], [m/s] of a drive along a wall in these checks


def response(gain: float, delay: int, seconds: float = 6.0) -> np.ndarray:
    """Return the errors [m] of the chapter's loop on paper, one for each scan."""
    errors = [START]
    while len(errors) * PERIOD < seconds:
        measured = errors[max(0, len(errors) - 1 - delay)]
        errors.append(errors[-1] - gain * measured * PERIOD)
    return np.array(errors)


@step("gain", objective=2)
def gain(tried: Tried) -> str:
    """`gain` brings the error below 2 cm within a second, and does not overshoot."""
    value = float(tried.value("gain", (int, float)))
    expect(value > 0, f"With a gain of {value:g} the robot never drives towards the place where it should be.")
    errors = response(value, delay=0)
    over, after = max(0.0, -float(errors.min())), abs(float(errors[round(1 / PERIOD)]))
    seen = f"With a gain of {value:g} /s the error is {after:z.2f} m after 1 s, and the overshoot {over:z.2f} m"
    expect(over < 0.005, f"{seen}; no overshoot is wanted.")
    expect(after < 0.02, f"{seen}; less than 0.02 m is wanted.")
    return f"{seen}."


@step("late_gain", objective=3)
def late_gain(tried: Tried) -> str:
    """With commands four scans late, `late_gain` overshoots by at most 5 cm and arrives within 4 s."""
    value = float(tried.value("late_gain", (int, float)))
    errors = response(value, delay=4)
    over, after = max(0.0, -float(errors.min())), float(np.abs(errors[round(4 / PERIOD) :]).max())
    seen = f"Four scans late, a gain of {value:g} /s overshoots by {over:z.2f} m"
    expect(over <= 0.05, f"{seen}; at most 0.05 m is wanted.")
    expect(after <= 0.1, f"{seen}, and is {after:z.2f} m off after 4 s; at most 0.1 m is wanted.")
    return f"{seen}, and is at most {after:z.2f} m off after 4 s."


@step("calm", objective=4, form=COMMANDS, limit=120.0)
def calm(tried: Tried) -> str:
    """The keeper goes on keeping its distance, and no longer shakes."""
    tried.place("robot", 2.2, 1.45, math.pi)
    seen = loop_during(tried, scans=50)[5:]
    fast = [each.z for each in seen if abs(each.z) > 0.2]
    changes = sum(a * b < 0 for a, b in itertools.pairwise(fast))
    off = max(abs(each.x - each.y) for each in seen[-8:])
    if changes > 1 or off >= 0.15:  # what this attempt has set is not in the way of the next one
        tried.command("ros2 param set /keeper speed_limit 0.6")
    expect(changes <= 1, f"The keeper changes between forward and back {changes} times in 4.5 s: it still shakes.")
    expect(off < 0.15, f"After 4.5 s the keeper is still {off:z.2f} m away from its distance.")
    return f"The keeper is within {off:z.2f} m of its distance after 4.5 s, and does not shake."


def loop_during(tried: Tried, scans: int) -> list[Any]:
    """Return what the keeper publishes on /loop during so many scans: less where the lidar measures no distance."""
    loop: list[Any] = []
    scanned: list[Any] = []
    with tried.node() as (node, spin_until):
        node.create_subscription(tried.message_type("geometry_msgs/msg/Vector3"), "/loop", loop.append, 10)
        spin_until(lambda: bool(loop), HEARD)
        node.create_subscription(tried.message_type("sensor_msgs/msg/LaserScan"), "/lidar/scan", scanned.append, 10)
        spin_until(lambda: len(scanned) >= scans or len(loop) >= scans, HEARD)
    expect(len(loop) > 5, f"On /loop came {len(loop)} messages; one for each scan is wanted: is the keeper running?")
    return loop


@step("parameters", objective=4, form="parameters.py")
def parameters(tried: Tried) -> str:
    """The node has the parameters distance, side and speed_limit, with these defaults."""
    command = "python parameters.py --ros-args -p speed_limit:=0.3"
    tried.start(command, ready="ready")
    try:
        printed = tried.command("ros2 param dump /wall_follower", deadline=30.0)
    finally:
        tried.stop(command)
    found = _parameters(printed)
    for name, value in (("distance", 0.6), ("side", "left"), ("speed_limit", 0.3)):
        others = ", ".join(sorted(found)) or "none"
        expect(name in found, f"The node has no parameter `{name}`; it has {others}.")
        got = found[name]
        where = " when the node is started with 0.3" if name == "speed_limit" else ""
        expect(
            got == value and type(got) is type(value),
            f"`{name}` is {got!r}, of type {type(got).__name__}{where}; {value!r} is wanted.",
        )
    return "distance is 0.6 and side 'left' by default, and speed_limit is what the node was started with."


@step("nearest_beside", objective=1)
def nearest_beside(tried: Tried) -> str:
    """nearest_beside(scan, side) is the range and the bearing of the nearest point of the wall on that side."""
    function = tried.function("nearest_beside")
    scan, disturbed = tried.heard("/lidar/scan", "sensor_msgs/msg/LaserScan", 2, deadline=30.0)
    quarter = round((math.pi / 2 - disturbed.angle_min) / disturbed.angle_increment)
    for ray in (quarter, len(disturbed.ranges) - 1 - quarter):  # a quarter turn to each side
        disturbed.ranges[ray] = 0.0
    for each, where in ((scan, "of a real scan"), (disturbed, "of a scan with ranges of 0.0, which are no hits,")):
        for side, sign in (("left", 1.0), ("right", -1.0)):
            rays = [
                (distance, sign * (each.angle_min + i * each.angle_increment))
                for i, distance in enumerate(each.ranges)
                if each.range_min < distance < each.range_max
            ]
            wanted = min(ray for ray in rays if 0 <= ray[1] <= BESIDE)
            said = function(each, side)
            expect(_pair(said), f"It returns {said!r}; two numbers, (range, bearing), are wanted.")
            finite = all(map(math.isfinite, said))
            expect(finite, f"It returns {said!r}; only ranges between range_min and range_max are hits.")
            near = abs(said[0] - wanted[0]) < 1e-3 and abs(said[1] - wanted[1]) < 0.02
            expect(
                near,
                f"On the {side} {where} the nearest point is {wanted[0]:z.2f} m away at {wanted[1]:z.2f} rad; "
                f"nearest_beside says {said[0]:z.2f} m, {said[1]:z.2f} rad.",
            )
    return f"It finds the nearest point on both sides; on the right it is {wanted[0]:z.2f} m away."


@step("turning", objective=1)
def turning(tried: Tried) -> str:
    """turning(distance, bearing, wanted) makes angular.z of both errors, for a wall on the left."""
    function = tried.function("turning")
    for distance, heading in ((1.2, 0.0), (0.35, 0.0), (0.6, 0.5), (0.7, -0.5)):
        begin = f"From {distance:g} m, heading {heading:g} rad towards the wall,"
        distances, rates = _drive(function, distance, heading)
        expect(
            np.abs(rates).max() <= MOST + 1e-6, f"{begin} it turns at {_largest(rates):z.1f} rad/s; the limit is 1.5."
        )
        expect(distances.min() > 0.15, f"{begin} the robot drives into the wall.")
        expect(distances.max() < 2.5, f"{begin} the robot drives away from the wall.")
        off = float(np.abs(distances[-30:] - WANTED).max())
        expect(off < 0.05, f"{begin} the distance is still up to {off:z.2f} m wrong after 20 s.")
    return f"From four starts the robot comes to {WANTED:g} m from the wall and stays there."


def _drive(function: Any, distance: float, heading: float) -> tuple[np.ndarray, np.ndarray]:
    """Drive along a straight wall on the left; return distances [m] and turning rates [rad/s].

    It takes 20 s, or ends where the wall is hit or lost. A command acts one scan late. `heading` [rad] is towards the
    wall.
    """
    distances, rates = [], [0.0]
    for _ in range(200):
        distances.append(distance)
        if not 0.15 < distance < 2.5:
            break
        said = function(distance, math.pi / 2 - heading, WANTED)
        expect(isinstance(said, float | int), f"It returns a {type(said).__name__}; a turning rate is wanted.")
        heading += rates[-1] * PERIOD
        distance -= SPEED * math.sin(heading) * PERIOD
        rates.append(float(said))
    return np.array(distances), np.array(rates)


def _largest(rates: np.ndarray) -> float:
    return float(rates[np.argmax(np.abs(rates))])


def _parameters(printed: str) -> dict[str, Any]:
    """Return the parameters that `ros2 param dump` prints; none if it prints something else."""
    try:
        return dict(yaml.safe_load(printed)["/wall_follower"]["ros__parameters"])
    except (yaml.YAMLError, KeyError, TypeError, ValueError):
        return {}


def _pair(said: Any) -> bool:
    try:
        return len([math.isfinite(each) for each in said]) == 2
    except TypeError:
        return False
