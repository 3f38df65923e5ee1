"""What a follower sends that knows the right places, but late, in other fields, or with the limits of the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.record.reading import Recording

if TYPE_CHECKING:
    from .follower_fits import Heard

GAP = 1.2  # [m]
FITS = 0.98  # of the variance of the commands that a line must explain
BETTER = 0.5  # of what the places of now leave unexplained: so much older ones must explain
LATE = (0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0)  # [s] by which a place may be old
WEIGHTS = (0.02, 0.03, 0.04, 0.05, 0.07, 0.1, 0.14, 0.2)  # of the newest message in a moving average
NEAR = 0.25  # [m] of a gap from the right one
WITHIN = 1e-6  # [m/s] of two speeds that are the same
BEHIND = 0.15  # [m] farther than the gap
FEWEST = 8  # commands


def late(recording: Recording, name: str, front: str, heard: Callable[..., Any], line: Callable[..., Any]) -> str:
    """Return that a follower steers by where the robot in front was some time ago; empty if it does not."""
    base = f"topics/{front}/odom/pose/pose/position"
    x, y = recording.signal(f"{base}/x"), recording.signal(f"{base}/y")
    sent = heard(recording, name, front)
    if not sent or len(x) < FEWEST:
        return ""
    usual = max(_fit(h, h.front_x, h.front_y, line)[0] for h in sent)
    commands = recording.signal(f"topics/{name}/cmd_vel/linear/x").times[-len(sent[0].linear) :]
    found = []
    for seconds in LATE:
        at = np.searchsorted(x.times, commands - int(seconds * 1e9), side="right") - 1
        at = np.clip(at, 0, len(x) - 1)
        fit, zero = max(_fit(h, x.values[at], y.values[at], line) for h in sent)
        said = f"its speed fits the place that the robot in front had {seconds:g} s before, and not its newest one"
        found.append((fit, zero, f"{said}, so it falls behind; use the last message that has come"))
    now = np.clip(np.searchsorted(x.times, commands, side="right") - 1, 0, len(x) - 1)
    for weight in WEIGHTS:
        smooth_x, smooth_y = _averaged(x.values, weight)[now], _averaged(y.values, weight)[now]
        fit, zero = max(_fit(h, smooth_x, smooth_y, line) for h in sent)
        said = "its speed fits a moving average of the places of the robot in front, in which the newest counts little"
        found.append((fit, zero, f"{said}, so it falls behind; use the newest place itself"))
    best, zero, words = max(found)
    return words if best > max(FITS, usual + BETTER * (1 - usual)) and abs(zero - GAP) < NEAR else ""


def _fit(h: Heard, front_x: np.ndarray, front_y: np.ndarray, line: Callable[..., Any]) -> tuple[float, float]:
    """Return how well a line over the distance to a place explains the speeds, and where it is zero."""
    found = line(np.hypot(front_x + GAP - h.x, front_y - h.y), h.linear)
    return (found[2], -found[1] / found[0]) if found is not None and found[0] > 0 else (0.0, 0.0)


def _averaged(values: np.ndarray, weight: float) -> np.ndarray:
    found, last = [], values[0]
    for value in values:
        last = weight * value + (1 - weight) * last
        found.append(last)
    return np.array(found)


def exchanged(every: list[Heard], line: Callable[..., Any]) -> str:
    """Return that the speed is made of the angle and the turning of the distance; empty if it is not so."""
    for h in every:
        angle = np.arctan2(h.aside, h.ahead) - h.heading
        angle = np.arctan2(np.sin(angle), np.cos(angle))
        turning, speed = line(h.distance, h.angular), line(angle, h.linear)
        apart = [line(angle, h.angular), line(h.distance, h.linear)]
        if any(fit is not None and fit[2] > FITS for fit in apart):
            continue
        fits = [
            fit[0] > 0 and fit[2] > FITS and abs(-fit[1] / fit[0] - zero) < NEAR
            for fit, zero in ((turning, GAP), (speed, 0.0))
            if fit is not None
        ]
        if len(fits) == 2 and all(fits):
            return (
                "linear.x and angular.z are exchanged: it drives by the angle to the robot in front and turns by "
                "the distance"
            )
    return ""


def held_by_the_front(every: list[Heard]) -> str:
    """Return that a follower is never faster than the robot in front, so that it never catches up."""
    for h in every:
        far = h.distance > GAP + BEHIND
        driven = far & (h.front_linear > 0.1)
        if driven.sum() < FEWEST:
            continue
        share = h.linear[driven] / h.front_linear[driven]
        factor = float(np.median(share))
        same = np.mean(np.abs(share - factor) < 0.03)
        never = bool((h.linear <= factor * np.maximum(h.front_linear, 0.0) + 0.02).mean() > 0.9)
        stands = far & (np.abs(h.front_linear) < WITHIN)
        if 0.05 < factor < 1.05 and same > 0.6 and never and not (np.abs(h.linear[stands]) > 0.02).mean() > 0.2:
            times = "than" if factor > 0.97 else f"than {factor:.1f} times"
            return (
                f"it never drives faster {times} the speed of the robot in front, and stands still with it, so it does "
                "not catch up: its speed depends on the distance alone, up to a limit of its own"
            )
    return ""


def stopped(every: list[Heard]) -> bool:
    """Return whether a follower that drove, or was near enough, sends zeros only in the end although it is behind."""
    h = every[0]
    zero = np.abs(h.linear) < WITHIN
    last = int(np.argmax(~zero[::-1])) if not zero.all() else len(zero)
    return last >= FEWEST and bool((h.distance[len(zero) - last :][-FEWEST:] > GAP + BEHIND).all())
