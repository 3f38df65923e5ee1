"""The cells that the reader of chapter 7 writes."""

from __future__ import annotations

import math
from collections import deque
from typing import Any

from gz_course.grader.lessons.step import Tried, expect, step

SCAN, SCAN_TYPE = "/scan", "sensor_msgs/msg/LaserScan"
MOUNT = "ros2 run tf2_ros static_transform_publisher"
FIRST, LAST = 10.0, 11.0  # [s] the times of the transforms in a buffer of these checks
SECOND = "robot/second_scanner"
CLOSE = 1e-3  # [m, rad]


@step("nearest", objective=1)
def nearest(tried: Tried) -> str:
    """nearest(scan) is the nearest hit, as x and y in the frame of the scan [m]."""
    function = tried.function("nearest")
    scan, disturbed = tried.heard(SCAN, SCAN_TYPE, 2)
    disturbed.ranges[10], disturbed.ranges[20] = 0.01, math.inf
    for each, where in ((scan, "a scan"), (disturbed, "a scan with a range of 0.01 m, which is below range_min,")):
        said = function(each)
        expect(_numbers(said, 2), f"It returns {said!r}; two numbers, (x, y), are wanted.")
        hits = [(r, i) for i, r in enumerate(each.ranges) if each.range_min < r < each.range_max]
        distance, ray = min(hits)
        angle = each.angle_min + ray * each.angle_increment
        wanted = (distance * math.cos(angle), distance * math.sin(angle))
        seen = f"The nearest hit of {where} is at ({wanted[0]:z.2f}, {wanted[1]:z.2f}) m"
        expect(math.dist(said, wanted) < CLOSE, f"{seen}; nearest says ({said[0]:z.2f}, {said[1]:z.2f}).")
    return f"The nearest hit of the scan is at ({wanted[0]:z.2f}, {wanted[1]:z.2f}) m in `{scan.header.frame_id}`."


@step("camera", objective=2)
def camera(tried: Tried) -> str:
    """The frame robot/camera is 0.1 m behind the robot's origin, 0.25 m above it, and looks to the right."""
    try:
        transform = tried.transform("robot", "robot/camera").transform
    finally:
        tried.stop(MOUNT)
    place, yaw = transform.translation, _yaw(transform.rotation)
    seen = (
        f"`robot/camera` is at ({place.x:z.2f}, {place.y:z.2f}, {place.z:z.2f}) m in `robot`, turned by {yaw:z.2f} rad"
    )
    expect(math.dist((place.x, place.y), (-0.1, 0.0)) < CLOSE, f"{seen}; 0.1 m behind the origin is wanted.")
    expect(abs(place.z - 0.25) < CLOSE, f"{seen}; 0.25 m above it is wanted.")
    expect(abs(yaw + math.pi / 2) < 0.01, f"{seen}; a quarter turn to the right, in radians, is wanted.")
    return f"{seen}."


@step("ready", objective=4)
def ready(tried: Tried) -> str:
    """ready(waiting, buffer) takes the scans whose transform to odom is there out of `waiting`, and returns them."""
    function = tried.function("ready")
    times = (9.0, 10.2, 10.6, 12.0)
    scans = [_scan_at(tried, time) for time in times]
    waiting = deque(scans)
    said = function(waiting, _buffer(tried))
    expect(isinstance(said, list | tuple | deque), f"It returns {said!r}; a list of scans is wanted.")
    returned, left = (
        [time for time, scan in zip(times, scans, strict=True) if scan in each] for each in (said, waiting)
    )
    seen = f"With transforms from {FIRST:g} to {LAST:g} s it returns the scans of {_listed(returned)}"
    expect(returned == [10.2, 10.6], f"{seen}; those of 10.2 and 10.6 s are wanted.")
    expect(left == [9.0, 12.0], f"{seen}, and leaves those of {_listed(left)}; 9 and 12 s should go on waiting.")
    return f"{seen}, and the others go on waiting."


@step("scan_to_odom", objective=3)
def scan_to_odom(tried: Tried) -> str:
    """scan_to_odom(buffer, scan) is the transform that takes points of a scan to odom, at the time of the scan."""
    function = tried.function("scan_to_odom")
    buffer = _buffer(tried)
    for time, frame in ((10.2, "robot/scanner"), (10.725, SECOND)):
        scan = _scan_at(tried, time, frame)
        said = function(buffer, scan)
        expect(hasattr(said, "child_frame_id"), f"It returns {said!r}; a transform is wanted.")
        expect(
            (said.header.frame_id, said.child_frame_id) == ("odom", frame),
            f"For a scan in `{frame}` it goes from `{said.child_frame_id}` to `{said.header.frame_id}`.",
        )
        wanted = buffer.lookup_transform("odom", frame, tried.time(scan.header.stamp))
        got, want = said.transform.translation, wanted.transform.translation
        expect(
            math.dist((got.x, got.y, got.z), (want.x, want.y, want.z)) < CLOSE,
            f"At {time:g} s the scanner was at ({want.x:z.2f}, {want.y:z.2f}) m; "
            f"your transform puts it at ({got.x:z.2f}, {got.y:z.2f}).",
        )
    return "At two times, for two scanners, it is the transform of that time."


@step("point_in_odom", objective=5)
def point_in_odom(tried: Tried) -> str:
    """point_in_odom(scan, transform, x, y) is a point of the scan in odom, as PointStamped with the scan's time."""
    function = tried.function("point_in_odom")
    scan = _scan_at(tried, 10.725)
    transform = _buffer(tried).lookup_transform("odom", "robot/scanner", tried.time(scan.header.stamp))
    said = function(scan, transform, 1.5, -0.5)
    expect(type(said).__name__ == "PointStamped", f"It returns a {type(said).__name__}; a PointStamped is wanted.")
    got, frame, stamp = said.point, said.header.frame_id, said.header.stamp
    yaw, place = _yaw(transform.transform.rotation), transform.transform.translation
    wanted = (
        place.x + 1.5 * math.cos(yaw) + 0.5 * math.sin(yaw),
        place.y + 1.5 * math.sin(yaw) - 0.5 * math.cos(yaw),
        place.z,
    )
    seen = f"It says ({got.x:z.2f}, {got.y:z.2f}, {got.z:z.2f}) in `{frame}`"
    expect(frame == "odom", f"{seen}; the frame should be `odom`.")
    there = f"({wanted[0]:z.2f}, {wanted[1]:z.2f}, {wanted[2]:z.2f})"
    expect(math.dist((got.x, got.y, got.z), wanted) < CLOSE, f"{seen}; the hit was at {there}.")
    said_time, time = (each.sec + each.nanosec / 1e9 for each in (stamp, scan.header.stamp))
    expect(stamp == scan.header.stamp, f"Its stamp is {said_time:g} s; the scan was taken at {time:g} s.")
    return f"{seen}, with the stamp of the scan."


def _buffer(tried: Tried) -> Any:
    """Return a buffer with the transforms of one second, in which a robot drives and turns, and two scanners on it."""
    kind = type(tried.transform("odom", "robot"))

    def transform(parent: str, child: str, time: float, x: float, y: float, z: float, yaw: float) -> Any:
        made = kind(child_frame_id=child)
        made.header.frame_id = parent
        made.header.stamp.sec, made.header.stamp.nanosec = int(time), round(time % 1 * 1e9)
        put, turn = made.transform.translation, made.transform.rotation
        put.x, put.y, put.z = x, y, z
        turn.z, turn.w = math.sin(yaw / 2), math.cos(yaw / 2)
        return made

    buffer = tried.value("Buffer")()
    for tick in range(21):
        passed = 0.05 * tick
        pose = 1.0 + 0.4 * passed, -0.5 * passed, 0.0, 1.8 * passed
        buffer.set_transform(transform("odom", "robot", FIRST + passed, *pose), "check")
    buffer.set_transform_static(transform("robot", "robot/scanner", 0.0, 0.2, -0.14, 0.3, 2.0), "check")
    buffer.set_transform_static(transform("robot", SECOND, 0.0, -0.3, 0.1, 0.5, -1.0), "check")
    return buffer


def _scan_at(tried: Tried, time: float, frame: str = "robot/scanner") -> Any:
    """Return a scan of the running world with another time [s] and frame."""
    scan = tried.heard(SCAN, SCAN_TYPE)[0]
    scan.header.stamp.sec, scan.header.stamp.nanosec = int(time), round(time % 1 * 1e9)
    scan.header.frame_id = frame
    return scan


def _yaw(turn: Any) -> float:
    return math.atan2(2 * (turn.w * turn.z + turn.x * turn.y), 1 - 2 * (turn.y**2 + turn.z**2))


def _numbers(said: Any, count: int) -> bool:
    try:
        return len(said) == count and all(math.isfinite(each) for each in said)
    except TypeError:
        return False


def _listed(times: list[float]) -> str:
    return " and ".join(f"{time:g}" for time in times) + " s" if times else "no time"
