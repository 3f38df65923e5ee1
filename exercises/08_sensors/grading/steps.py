"""The cells that the reader of chapter 8 writes."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from gz_course.grader.lessons.step import COMMANDS, Tried, expect, step

IMAGE = "sensor_msgs/msg/Image"
COLOUR, DEPTH = "/camera/image", "/depth/image"
STANDING = 1.0  # [s] in which the robot stands, in these checks
SAME = 1e-3  # [s] between equal stamps
ASIDE = 1.5  # [columns] that the middle of a post may be off


@step("depth_header", objective=3, form=COMMANDS, limit=45.0)
def depth_header(tried: Tried) -> str:
    """One message of the depth camera arrives, without its pixels."""
    found = {key: value for key, value in re.findall(r"^(\w+): '?(\w+)'?$", tried.output, re.MULTILINE)}
    expect(tried.output.strip(), "Nothing was printed: no message reached your command.")
    expect("encoding" in found, "What was printed is no message of a camera.")
    seen = f"A picture of {found.get('width')} by {found.get('height')} pixels came, encoded as {found['encoding']}"
    expect(found["encoding"] == "32FC1", f"{seen}; the depth camera sends 32FC1.")
    expect(tried.output.count("encoding:") == 1, f"{seen}, and more; one message is wanted.")
    expect(len(tried.output) < 2000, f"{seen}, with all its pixels; without them is wanted.")
    return f"{seen}, with {found.get('step')} bytes a row."


@step("depth_at", objective=1)
def depth_at(tried: Tried) -> str:
    """depth_at(depth, row, column) reads the depth of one pixel from the bytes of an Image, in metres."""
    function = tried.function("depth_at")
    depth = tried.heard(DEPTH, IMAGE)[0]
    rows = np.frombuffer(bytes(depth.data), dtype=np.uint8).reshape(depth.height, depth.step)
    truth = rows[:, : 4 * depth.width].copy().view(np.float32)
    padded = type(depth)(encoding=depth.encoding, width=depth.width, height=depth.height, step=depth.step + 32)
    padded.data = np.pad(rows, ((0, 0), (0, 32))).tobytes()
    low = depth.height - 2  # the floor before the robot
    for image, row, column in ((depth, low, 20), (depth, low - 9, 100), (padded, low, 140)):
        wanted = float(truth[row, column])
        said = function(image, row, column)
        expect(
            isinstance(said, float | np.floating), f"It returns a {type(said).__name__}; a depth in metres is wanted."
        )
        there = f"At row {row}, column {column} the depth is {wanted:z.3f} m"
        where = there if image is depth else f"{there} in a picture with {padded.step} bytes a row"
        expect(abs(said - wanted) < 1e-4, f"{where}; depth_at says {said:.3g}.")
    return f"{there}, also if each row has bytes to spare."


@step("red_columns", objective=2)
def red_columns(tried: Tried) -> str:
    """red_columns(colours) gives the middle column of each red thing in a picture, from left to right."""
    function = tried.function("red_columns")
    picture = np.full((120, 160, 3), 200, dtype=np.uint8)  # bright, as the floor
    picture[:60] = (150, 150, 155)
    for first, last, colour in ((20, 34, (180, 25, 20)), (70, 80, (30, 40, 190)), (100, 109, (200, 30, 30))):
        picture[40:80, first : last + 1] = colour
    picture[40:80, 140:150] = (230, 120, 25)  # orange
    none = picture[:, 35:100]
    for colours, wanted in ((picture, [27.0, 104.5]), (picture[:, :70], [27.0]), (none, [])):
        said = function(colours)
        expect(_listed(said), f"It returns {said!r}; a list of columns is wanted.")
        got = [float(each) for each in said]
        seen = (
            f"In a picture with {len(wanted)} red posts it finds {len(got)}"
            if wanted
            else f"Without red it finds {len(got)}"
        )
        expect(len(got) == len(wanted), f"{seen}; each red post is one, and bright grey, blue and orange are none.")
        off = [abs(a - b) for a, b in zip(sorted(got), wanted, strict=True)]
        words = ", ".join(f"{each:z.0f}" for each in got)
        expect(max(off, default=0.0) < ASIDE, f"The middles are at {wanted}; red_columns says {words}.")
    return "Two posts are two columns, one is one, and other colours are none."


@step("turned", objective=4)
def turned(tried: Tried) -> str:
    """turned(times, rates, standing) is the angle turned in the end [rad], without the bias of the gyroscope."""
    function = tried.function("turned")
    chance = np.random.default_rng(1)
    for bias, speed in ((0.06, 0.8), (-0.05, -0.5)):
        times = np.arange(0.0, 6.0, 0.04)
        times = times[(chance.random(len(times)) > 0.2) | (times == 0)]  # some messages are lost
        rates = np.where(times > STANDING + 0.2, speed, 0.0) + bias + chance.normal(0.0, 0.005, len(times))
        wanted = speed * (times[-1] - times[times <= STANDING + 0.2][-1])
        said = function(times, rates, STANDING)
        expect(isinstance(said, float | np.floating), f"It returns a {type(said).__name__}; an angle is wanted.")
        seen = f"A robot with a bias of {bias:g} rad/s truly turned by {wanted:z.2f} rad"
        expect(abs(said - wanted) < 0.06, f"{seen}; turned says {said:z.2f}.")
    messages = tried.heard("/imu", "sensor_msgs/msg/Imu", 50, deadline=30.0)
    times = np.array([each.header.stamp.sec + each.header.stamp.nanosec / 1e9 for each in messages])
    still = float(function(times, np.array([each.angular_velocity.z for each in messages]), STANDING))
    expect(abs(still) < 0.06, f"The real robot stands, and turned says that it has turned by {still:z.2f} rad.")
    return f"{seen}, and turned says {said:z.2f}; the real robot stands, at {still:z.2f} rad."


@step("in_pairs", objective=5)
def in_pairs(tried: Tried) -> str:
    """in_pairs(colour, depth, callback) calls callback(image, depth) with pictures of the same moment."""
    function = tried.function("in_pairs")
    picture = type(tried.heard(COLOUR, IMAGE, deadline=60.0)[0])
    colour, depth = Input(), Input()
    pairs: list[tuple[Any, ...]] = []
    kept = function(colour, depth, lambda *messages: pairs.append(messages))
    for tick in range(12):  # 5 colour pictures a second, half as many of the other, which come three pictures late
        colour.signal(_stamped(picture(encoding="rgb8"), 0.2 * tick))
        if tick >= 3 and tick % 2:
            depth.signal(_stamped(picture(encoding="32FC1"), 0.2 * (tick - 3)))
    del kept
    expect(pairs, "Pictures of both cameras came, and the callback was never called.")
    first = pairs[0]
    expect(len(first) == 2, f"The callback got {len(first)} messages; two are wanted.")
    kinds = (first[0].encoding, first[1].encoding)
    expect(kinds == ("rgb8", "32FC1"), f"The callback got {kinds[0]} first, then {kinds[1]}; colour comes first.")
    apart = max(abs(_seconds(a) - _seconds(b)) for a, b in pairs)
    expect(apart < SAME, f"The two pictures of a pair are up to {apart:z.1f} s apart; the same moment is wanted.")
    times = [_seconds(each) for each, _ in pairs]
    expect(len(times) == 5, f"{len(times)} of 5 pairs came: a depth picture comes 0.6 s after its colour picture.")
    expect(all(a < b for a, b in itertools.pairwise(times)), "A pair came twice.")
    return "5 of 5 pairs came, each of one moment."


class Input:
    """What a synchronizer listens to, as a `message_filters.Subscriber`."""

    def __init__(self) -> None:
        self._callbacks: list[tuple[Callable[..., None], tuple[Any, ...]]] = []

    def registerCallback(self, callback: Callable[..., None], *arguments: Any) -> int:
        self._callbacks.append((callback, arguments))
        return len(self._callbacks) - 1

    def signal(self, message: Any) -> None:
        for callback, arguments in self._callbacks:
            callback(message, *arguments)


def _stamped(message: Any, time: float) -> Any:
    message.header.stamp.sec, message.header.stamp.nanosec = int(time), round(time % 1 * 1e9)
    return message


def _seconds(message: Any) -> float:
    return float(message.header.stamp.sec + message.header.stamp.nanosec / 1e9)


def _listed(said: Any) -> bool:
    try:
        return all(math.isfinite(each) for each in said)
    except TypeError:
        return False
