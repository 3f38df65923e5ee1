"""What the speeds of a patrol are instead of that of its goal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import bearings

if TYPE_CHECKING:
    from .patrol_checks import Run

SAME = 0.1  # of a speed, to be called the same


def other_speed(run: Run, fastest: dict[str, float]) -> str:
    """Return what the speeds are instead of those of the goals: `fastest` [m/s] by goal."""
    if words := bearings.backwards(run):
        return words
    asked = {goal: run.one("sent", goal)["speed"] for goal in fastest}
    if words := of_the_one_before(run, asked):
        return words
    sent = {goal: commanded(run, goal) for goal in fastest}
    ratios = {goal: fastest[goal] / asked[goal] for goal in fastest}
    for factor, words in (
        (0.01, "a speed in metres per second is taken for centimetres per second"),
        (1 / 3.6, "the speed is divided by 3.6, as if it were in km/h; it is in metres per second"),
        (3.6, "the speed is multiplied by 3.6, as if km/h were asked for; it is in metres per second"),
        (0.5, "linear.x is half of it"),
        (2.0, "linear.x is twice as much"),
    ):
        fits = all(abs(sent[goal] - factor * asked[goal]) <= SAME * factor * asked[goal] for goal in fastest)
        if fits and all(abs(ratio - factor) <= SAME * factor for ratio in ratios.values()):
            return f"Your server drives at {factor:.2g} times the speed of the goal: {words}"
    if words := proportional(run, asked):
        return words
    values = list(fastest.values())
    if len(values) == 2 and abs(values[0] - values[1]) <= 0.05 * max(values) and max(values) > 0.05:
        return (
            f"Your server drives at {values[0]:.2f} m/s whatever the goal says: linear.x is goal_handle.request.speed"
        )
    goal = max(ratios, key=lambda each: abs(ratios[each] - 1))
    if ratios[goal] < 0.85:
        return (
            f"Your server drives slower than the goal says, {fastest[goal]:.2f} m/s at most where {asked[goal]:.2f} "
            "m/s are asked for: it may be slower only to turn and to arrive"
        )
    return f"Your server drives at {fastest[goal]:.2f} m/s where the goal says {asked[goal]:.2f}: linear.x has no limit"


def of_the_one_before(run: Run, asked: dict[str, float]) -> str:
    """Find out whether the second patrol drives as fast as the first one in its first commands only."""
    if len(asked) < 2:
        return ""
    start, end = run.period("cancelled")
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    times = signal.times / 1e9
    sent = signal.values[(times >= start) & (times <= end)]
    drives = sent[sent > 0.05]
    own, before = asked["cancelled"], asked["patrol"]
    if len(drives) < 10 or abs(own - before) < 2 * SAME * before:
        return ""
    if abs(np.median(drives) - own) < SAME * own and abs(drives[0] - before) < SAME * before:
        return (
            f"Your server begins a patrol with the speed of the one before, {before:.2f} m/s: what is kept of that "
            "one, such as a Twist that is made once, has to be set anew"
        )
    return ""


def commanded(run: Run, goal: str) -> float:
    """Return the largest linear.x that was sent during a patrol [m/s]."""
    start, end = run.period(goal)
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    times = signal.times / 1e9
    return float(signal.values[(times >= start) & (times <= end)].max(initial=0.0))


def proportional(run: Run, asked: dict[str, float]) -> str:
    """Find out whether linear.x goes with the distance that is left over the whole way."""
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    for goal in asked:
        said = run.all("feedback", goal)
        if len(said) < 10:
            continue
        at = np.array([each["at"] for each in said])
        left = np.array([each["distance"] for each in said])
        index = np.searchsorted(signal.times / 1e9, at, side="right") - 1
        speed = signal.values[np.maximum(index, 0)]
        driving = (speed > 0.02) & (left > 0.2)
        if driving.sum() >= 8 and np.ptp(left[driving]) > 0.4:
            gain = speed[driving] / left[driving]
            if np.mean(np.abs(gain - np.median(gain)) <= 0.1 * np.median(gain)) > 0.8:
                return (
                    f"linear.x is {np.median(gain):.2f} times the distance that is left, all the way: the speed of the "
                    "goal is no gain but how fast to drive, min(speed, 1.5 * distance)"
                )
    return ""
