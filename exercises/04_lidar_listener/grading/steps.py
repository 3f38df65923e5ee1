"""The cells that the reader of chapter 4 writes."""

from __future__ import annotations

import copy
import math
import re
from numbers import Integral, Real
from typing import Any

from gz_course.grader.lessons.observer import FOUND, SEEN
from gz_course.grader.lessons.step import NotYet, Tried, expect, step

SCAN, LASER_SCAN = "/lidar/scan", "sensor_msgs/msg/LaserScan"
IMAGE = "sensor_msgs/msg/Image"
LINE = re.compile(r"Scan: (\d+) valid rays, min=(\d+\.\d{2,})m, avg=(\d+\.\d{2,})m")


def scan_of(tried: Tried) -> Any:
    """Return a scan of the room."""
    return tried.heard(SCAN, LASER_SCAN)[0]


def valid(scan: Any) -> list[tuple[int, float]]:
    """Return the beams of a scan that measured something: index, range [m]."""
    return [(i, r) for i, r in enumerate(scan.ranges) if scan.range_min < r < scan.range_max]


@step("camera", objective=1)
def camera(tried: Tried) -> str:
    """ROS has the camera's pictures on /image, and passes nothing back."""
    try:
        picture = tried.heard("/image", IMAGE)[0]
    except NotYet:
        others = [name for name, types in tried.topics().items() if IMAGE in types]
        have = f"the topics with pictures are {', '.join(others)}" if others else "no topic of ROS carries pictures"
        raise NotYet(f"No picture came on /image; {have}.") from None
    back = tried.both_ways("/image")
    expect(not back, "The pictures come, but the bridge also listens to /image in ROS, to pass it on to Gazebo.")
    return f"ROS has pictures of {picture.width} x {picture.height} pixels on /image."


@step("beam_at", objective=2)
def beam_at(tried: Tried) -> str:
    """beam_at(scan, angle) is the index of the beam that points nearest to an angle [rad]."""
    function, scan = tried.function("beam_at"), scan_of(tried)
    other = copy.deepcopy(scan)  # another lidar, whose first beam points ahead
    other.angle_min, other.angle_increment = 0.0, math.tau / len(scan.ranges)
    for lidar, what in ((scan, "this lidar"), (other, "a lidar whose first beam points ahead")):
        for beam in (0, 10, len(lidar.ranges) // 2):
            angle = lidar.angle_min + (beam + 0.3) * lidar.angle_increment
            for aside, right in ((0.0, beam), (0.4 * lidar.angle_increment, beam + 1)):
                said = function(lidar, angle + aside)
                whole = isinstance(said, Integral)
                expect(whole, f"beam_at returns a {type(said).__name__}; an index is a whole number.")
                expect(
                    said == right,
                    f"For {what} and {angle + aside:z.4f} rad it says beam {said}; beam {right} points nearest.",
                )
    return "It finds the beam for this lidar, and for one that begins ahead."


@step("valid_ranges", objective=3)
def valid_ranges(tried: Tried) -> str:
    """valid_ranges(scan) are the ranges between the limits of the lidar [m]."""
    function, scan = tried.function("valid_ranges"), scan_of(tried)
    made = copy.deepcopy(scan)
    kept = [scan.range_min + 0.5, scan.range_min + 1.0]
    strange = [math.inf, -math.inf, math.nan, 0.0, scan.range_min / 2, scan.range_max + 1.0]
    made.ranges = [*strange, *kept]
    for lidar in (scan, made):
        said = [float(each) for each in function(lidar)]
        wanted = [r for _, r in valid(lidar)]
        wrong = [each for each in said if not lidar.range_min < each < lidar.range_max]
        limits = f"{lidar.range_min:g} to {lidar.range_max:g} m"
        expect(not wrong, f"It keeps {wrong[0] if wrong else 0:g}; this lidar measures {limits}.")
        expect(len(said) == len(wanted), f"It keeps {len(said)} ranges; {len(wanted)} are within {limits}.")
        same = all(abs(a - b) < 1e-6 for a, b in zip(said, wanted, strict=True))
        expect(same, "It keeps as many ranges as are valid, but changes them.")
    return f"It keeps {len(valid(scan))} of the {len(scan.ranges)} ranges, and none that is no distance."


@step("point_of", objective=4)
def point_of(tried: Tried) -> str:
    """point_of(scan, i) is where beam i ends, ahead and to the left of the lidar [m]."""
    function, scan = tried.function("point_of"), scan_of(tried)
    beams = valid(scan)
    for i, distance in beams[:: max(1, len(beams) // 7)]:
        said = function(scan, i)
        pair = isinstance(said, tuple | list) and len(said) == 2 and all(isinstance(each, Real) for each in said)
        expect(pair, f"point_of returns a {type(said).__name__}; two numbers, ahead and left, are wanted.")
        angle = scan.angle_min + i * scan.angle_increment
        ahead, left = distance * math.cos(angle), distance * math.sin(angle)
        close = math.hypot(said[0] - ahead, said[1] - left) < 1e-3
        where = f"({said[0]:z.2f}, {said[1]:z.2f}) m"
        expect(close, f"Beam {i} measures {distance:z.2f} m at {angle:z.2f} rad; {where} is not where it ends.")
    return "Each beam ends where the function says."


@step("subscribe", objective=5)
def subscribe(tried: Tried) -> str:
    """subscribe(node, on_message) makes a subscription that receives what comes on /trial."""
    expect(tried.publishers("/trial"), "Nobody publishes on /trial; run the cell that starts `sensor` again.")
    function = tried.function("subscribe")
    found: list[Any] = []
    with tried.node() as (node, spin_until):
        function(node, found.append)
        spin_until(lambda: node.count_publishers("/trial") > 0, FOUND)
        spin_until(lambda: len(found) >= 3, SEEN)
        made = [each.topic_name for each in node.subscriptions]
    expect("/trial" in made, f"It subscribes to {', '.join(made) or 'nothing'}; /trial is wanted.")
    expect(found, "Its subscription to /trial received nothing, and its publisher is best effort.")
    return "It receives what a best-effort publisher sends."


@step("mean_range", objective=6, form="mean_range.py")
def mean_range(tried: Tried) -> str:
    """For each scan the node publishes the mean of the valid ranges [m] on /mean_range."""
    ranges = [r for _, r in valid(scan_of(tried))]
    wanted = sum(ranges) / len(ranges)
    heard = tried.heard_from("python mean_range.py", "/mean_range", "std_msgs/msg/Float32", count=5, after=8.0)
    said = heard[-1].data
    came = f"On /mean_range came {said:z.2f} m"
    expect(abs(said - wanted) < 0.1, f"{came}; the mean of the valid ranges is {wanted:z.2f} m.")
    expect(len(heard) == 5, f"On /mean_range came {len(heard)} messages; one for each scan is wanted.")
    return f"On /mean_range comes {said:z.2f} m, again and again: one for each scan."


@step("report", objective=6)
def report(tried: Tried) -> str:
    """report(valid) is the line of the exercise, with two decimals."""
    function = tried.function("report")
    for ranges in ([1.0, 2.5, 4.0], [0.123, 0.5]):
        said = function(ranges)
        expect(isinstance(said, str), f"report returns a {type(said).__name__}; a text is wanted.")
        found = LINE.fullmatch(said)
        if found is None:
            raise NotYet(f"It says {said[:60]!r}; each sign counts, and two decimals.")
        count, least, mean = int(found[1]), float(found[2]), float(found[3])
        expect(count == len(ranges), f"For {ranges} it says {count} rays; {len(ranges)} are given.")
        expect(abs(least - min(ranges)) < 0.006, f"For {ranges} it says min={least}.")
        expect(abs(mean - sum(ranges) / len(ranges)) < 0.006, f"For {ranges} it says avg={mean}.")
    return f"It says {said!r}."
