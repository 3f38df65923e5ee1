"""The cells that the reader of chapter 3 writes."""

from __future__ import annotations

from typing import Any

from gz_course.grader.lessons.motion import expect_turn, motion_in_the_middle
from gz_course.grader.lessons.step import COMMANDS, Tried, expect, step


@step("turn_right", objective=1, form=COMMANDS)
def turn_right(tried: Tried) -> str:
    """The robot turns on the spot, to the right, at 0.5 rad/s."""
    moves = motion_in_the_middle(tried)
    expect_turn(moves, -0.5)
    return f"The robot {moves}: to the right, on the spot."


@step("stop", objective=3, form=COMMANDS)
def stop(tried: Tried) -> str:
    """The robot stands still."""
    moves = motion_in_the_middle(tried)
    expect(moves.stands, f"The robot still {moves}; it obeys the last command it got.")
    return "The robot stands still."


@step("circle", objective=2)
def circle(tried: Tried) -> str:
    """The robot drives a circle with a radius of 0.5 m, to the left."""
    moves = motion_in_the_middle(tried)
    speed, rate = moves.speed, moves.rate
    expect(abs(speed) > 0.05, f"The robot drives at {speed:z.2f} m/s: too slowly to see a circle.")
    expect(abs(rate) > 0.02, f"The robot drives at {speed:z.2f} m/s straight on; a circle needs a turn.")
    radius = speed / rate
    expect(rate > 0, f"The robot turns to the right, at {rate:z.2f} rad/s; the circle should go to the left.")
    expect(
        abs(radius - 0.5) < 0.05,
        f"At {speed:z.2f} m/s and {rate:z.2f} rad/s the radius is {radius:z.2f} m; 0.5 m is wanted.",
    )
    return f"The robot drives a circle to the left with a radius of {radius:z.2f} m."


@step("seconds_since", objective=4)
def seconds_since(tried: Tried) -> str:
    """seconds_since(start, now) is the time between two readings of a clock, in seconds."""
    function = tried.function("seconds_since")
    stamps: list[Any] = [each.clock for each in tried.heard("/clock", "rosgraph_msgs/msg/Clock", 20)]
    start, now = tried.time(stamps[0]), tried.time(stamps[-1])
    wanted = (now.nanoseconds - start.nanoseconds) / 1e9
    said = function(start, now)
    expect(isinstance(said, float | int), f"seconds_since returns a {type(said).__name__}; a number is wanted.")
    expect(
        abs(said - wanted) < 1e-6,
        f"Two readings of /clock are {wanted:z.3f} s apart; seconds_since says {said:g}.",
    )
    return f"Two readings of /clock are {wanted:z.3f} s apart, and seconds_since says so."
