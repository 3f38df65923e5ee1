"""What a robot does after the last command for a while: it goes on as it was told."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.recorded.places import ended_by_itself
from gz_course.grader.record.reading import Recording

LONG = 1.0  # [s] without a command, in which a robot goes on by the last one
SHARE = 0.2  # of the run without commands, that explain what was not explored
SLOW = 0.02  # [m/s], [rad/s]


def kept(recording: Recording, touched: float | None = None) -> str:
    """Return that a robot went on by an old command until it touched something [s], or for a good part of the run.

    Without a time it must have done so for longer than a fifth of the run.
    """
    ahead, turning = (recording.signal(f"topics/cmd_vel/{name}") for name in ("linear/x", "angular/z"))
    if not len(ahead.values) or len(ahead.values) != len(turning.values):
        return ""
    times = np.append(ahead.times / 1e9, recording.end_ns / 1e9)
    moves = np.hypot(ahead.values, turning.values) > SLOW
    gaps = np.where(moves, np.diff(times), 0.0)
    if touched is not None:
        before = int(np.searchsorted(times[:-1], touched - 1e-6)) - 1
        if before < 0 or not ahead.values[before] > SLOW or touched - times[before] < LONG:
            return ""
        number, seconds = before, touched - times[before]
    else:
        number = int(gaps.argmax())
        seconds = gaps[number]
        if gaps[gaps > LONG].sum() < SHARE * recording.end_ns / 1e9:
            return ""
    if ended := ended_by_itself(recording, before=times[number] + LONG):
        return f"the robot went on by the last command, because {ended}"
    return (
        f"no command came for {seconds:.1f} s after that of {times[number]:.1f} s, with linear.x "
        f"{ahead.values[number]:.2f} and angular.z {turning.values[number]:.2f}, and the robot went on by it: it keeps "
        "the last command until another comes, so publish Twist() where there is no way to follow"
    )
