"""What a heading was made of that was a full turn at the wrong time, or never; `misconceptions.py` hands it on."""

from __future__ import annotations

import math

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording

from . import hall

STAND = 0.9  # [s] of the first second
FULL_TURN = 2 * math.pi  # [rad]
TURNED_EARLY = 0.1  # [rad] in the first second
SOON = 0.15  # [s] between a time and the one that a misconception explains


def turned_early(recording: Recording) -> str:
    """Return how far the robot turned in the second in which it should stand; empty if it stood, or no bias counts."""
    ends = recording.facts().get("endpoints", [])
    if ends and not any(end["kind"] == "subscription" and end["topic"] == "/imu" for end in ends):
        return ""
    end = min(round(STAND * 1e9), recording.end_ns)
    turned = abs(float(np.diff(hall.truth(recording, "yaw", np.array([0, end])))[0]))
    if turned < TURNED_EARLY:
        return ""
    return (
        f"the robot has turned by {math.degrees(turned):.0f} degrees in the first {STAND:g} s already, and what the "
        "gyroscope says then is taken for its bias: the robot must stand still for the first second (self.heading "
        "stays None, and drive() does nothing)"
    )


def since_the_first(times: np.ndarray, rates: np.ndarray, when: float) -> str:
    """Return whether each rate was multiplied by a time that grows [s], given when the sum was a full turn [ns]."""
    start = times[0] if len(times) else 0.0
    for begin in (0.0, STAND):
        heading = np.cumsum(np.where(times >= start + STAND, rates * (times - start - begin), 0.0))
        full = np.flatnonzero(heading >= FULL_TURN - 0.05)
        if len(full) and abs(times[full[0]] - when / 1e9) <= SOON:
            return (
                "each rate was multiplied with the time since one and the same message, which grows and grows: the "
                "time is that since the message before, so keep the last stamp in each call (self.last = now)"
            )
    return ""


def why_turned(recording: Recording, when: int, turned: float) -> str:
    """Return the misconception whose heading is 2 pi at that time [ns]; empty if there is none."""
    if abs(turned + FULL_TURN) <= 2 * hall.TURN_OFF:
        return "it turned to the right: a positive angular.z turns to the left"
    gyro = recording.signal("topics/imu/angular_velocity/z")
    before = gyro.times <= when
    times, rates = gyro.times[before] / 1e9, gyro.values[before]
    if said := since_the_first(times, rates, when):
        return said
    if abs(turned) < 0.3 and when < 2.5e9:
        return "the heading reached a full turn at once: a time in nanoseconds is 1e9 times that in seconds"
    for turns, words in ((0.5, "half a turn, pi; a full turn is 2 pi"), (2, "two turns, 4 pi; one is 2 pi")):
        if abs(turned - turns * FULL_TURN) <= hall.TURN_OFF:
            return suspect(recording, "gyroscope") or (
                f"it was {words}, or your heading grows {1 / turns:g} times as fast as the robot turns"
            )
    turning = np.abs(hall.truth(recording, "angular_z", gyro.times[before])) > 0.1
    bias = (
        float((rates - hall.truth(recording, "angular_z", gyro.times[before]))[~turning].mean()) if len(rates) else 0.0
    )
    if said := suspect(recording, "gyroscope"):
        return said
    spans = np.diff(times, prepend=times[:1])
    z, w = (recording.signal(f"topics/odom/pose/pose/orientation/{part}") for part in "zw")
    by_odometry = np.unwrap(2 * np.arctan2(z.values, w.values))[z.times <= when] if len(z) else np.zeros(1)
    if len(by_odometry) and abs(by_odometry[-1] - by_odometry[0] - FULL_TURN) <= 0.1:
        return (
            "by odometry, or by commanded speed times time, this was 360 degrees: the robot does not turn exactly "
            "as its wheels say"
        )
    if said := turned_early(recording):
        return said
    angles = {
        "the bias of the gyroscope was added up, too: it says {bias:.3f} rad/s while the robot stands": (rates * spans),
        "the bias was added instead of subtracted: it is {bias:.3f} rad/s": (rates + bias) * spans,
        "each message was taken for 0.01 s, but they come every 0.04 s: use the stamps": (rates - bias) * 0.01,
        "the rates were added up without the time between two messages: add rate * time": rates - bias,
        "each message was taken for 0.1 s, but they come every 0.04 s: use the stamps": (rates - bias) * 0.1,
    }
    for words, steps in angles.items():
        for counts in (np.ones(len(steps), dtype=bool), turning):
            if abs(float(steps[counts].sum()) - FULL_TURN) <= max(0.1, 3 * np.abs(steps).max(initial=0.0)):
                return words.format(bias=bias)
    return other_bias(times, rates, turning, bias)


def other_bias(times: np.ndarray, rates: np.ndarray, turning: np.ndarray, bias: float) -> str:
    """Return what was subtracted as the bias [rad/s] if the sum of `rates` was then a full turn; empty if unknown.

    `turning` says at which of the `times` [s] the robot truly turned.
    """
    first = times <= times[0] + STAND
    if first.sum() < 5 or not turning.any():
        return ""
    spans = np.diff(times, prepend=times[:1])
    after = ~first
    seconds = float(spans[after].sum())
    subtracted = (float((rates * spans)[after].sum()) - FULL_TURN) / seconds
    standing = rates[first]
    near = 0.03 / seconds + 0.1 * float(np.abs(rates).max()) / seconds  # what a late number, and the last 0.1 s, change
    mean = float(standing.mean())
    if abs(subtracted - mean) <= near:
        return ""
    fitting = [
        words
        for words, value in (
            ("the standard deviation of the rates, their noise", float(standing.std())),
            ("the largest of the rates", float(standing.max())),
            ("the smallest of the rates", float(standing.min())),
            ("half of the mean", mean / 2),
            ("twice the mean", 2 * mean),
        )
        if abs(subtracted - value) <= near
    ]
    is_it = f", which is {fitting[0]} while the robot stands" if len(fitting) == 1 else ""
    if abs(subtracted) > 3 * abs(bias) + 0.05:
        return ""
    return (
        f"the bias that you subtract is wrong: by your heading it is about {subtracted:.3f} rad/s{is_it}; the mean of "
        f"the rates while the robot stands is {mean:.3f} rad/s"
    )
