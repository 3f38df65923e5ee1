"""What a robot does when its patrol is over or cancelled, and should stand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .patrol_run import Run
from .misconceptions import MOVED, SLOW, STAYS

AT_ONE = 0.2  # [m] from a waypoint


def after_cancel(run: Run, since: float, until: float) -> tuple[float, float]:
    """Return the largest speed [m/s] and turning rate [rad/s] between two times [s], before another goal is sent."""
    until = min([until, *(each["at"] for each in run.events if each["event"] == "sent" and each["at"] > since)])
    window = (run.times >= since) & (run.times <= until)
    speed, rate = (float(np.max(np.abs(each[window]), initial=0.0)) for each in (run.linear.values, run.angular.values))
    return speed, rate


def ends_late(run: Run, found: dict[str, Any], asked: float) -> str:
    """Return why a robot drives on that was cancelled at a time `asked` [s]; `found` is the result, or None."""
    why = "Your server accepts the cancellation and drives on"
    last = run.way[np.searchsorted(run.times, found["at"] if found else run.end).clip(0, len(run.times) - 1)]
    begun = run.way[np.searchsorted(run.times, asked).clip(0, len(run.times) - 1)]
    to_each = [np.hypot(*(np.array(run.waypoints("cancelled")) - each).T) for each in (begun, last)]
    left = [float(each.min()) for each in to_each]
    if left[1] > left[0] + STAYS:
        return (
            f"{why}, away from its waypoints, to ({last[0]:.1f}, {last[1]:.1f}): it must stop at once, where it is, "
            "and end the goal there"
        )
    arrived = bool(((to_each[1] < AT_ONE) & (to_each[1] < to_each[0] - MOVED)).any())
    ended = found is not None and found["status"] == "CANCELED"
    meanwhile = _meanwhile(run, asked, found["at"], arrived) if ended else ""
    if not meanwhile and (said := suspect(run.recording, "cancel")):
        return f"{why}: {said}"
    if found is None or found["status"] != "CANCELED":
        return f"{why}: the loop never asks goal_handle.is_cancel_requested while it drives"
    later = f"the goal ended as CANCELED {found['at'] - asked:.1f} s after it was cancelled"
    if arrived and not meanwhile:
        later += ", when the robot had come to a waypoint: goal_handle.is_cancel_requested is asked once per waypoint"
        return f"{why}: {later}, and not in the loop that drives"
    return f"{why}: {later}{meanwhile}"


def _meanwhile(run: Run, asked: float, ended: float, arrived: bool) -> str:
    """Return what was commanded between a cancellation and the end of the goal [s]; empty if that tells nothing.

    Who has `arrived` at a waypoint then slows down there anyway.
    """
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    times = signal.times / 1e9
    usual = np.diff(times[(times > asked - 2.0) & (times <= asked)])
    between = (times > asked + 0.15) & (times < ended - 0.15)
    speeds = signal.values[between]
    if not arrived and len(usual) and np.median(usual) > SLOW:
        return ", because goal_handle.is_cancel_requested is asked too seldom"
    if len(usual) and not len(speeds):
        return (
            f": no command came for {ended - asked:.1f} s, so the robot obeyed the old one; publish the Twist of zeros "
            "first, before you wait for anything"
        )
    if not arrived and len(speeds) > 3 and (np.diff(speeds) <= 0).all() and speeds[-1] < 0.5 * speeds[0]:
        return ", and it brakes little by little: the robot must stand within half a second"
    return ""


def drives_on(run: Run, speeds: np.ndarray) -> float:
    """Return the largest of the robot's speeds when a patrol has been over for 0.3 s, until the next goal."""
    found, following = run.one("result", "patrol"), run.one("sent", "cancelled")
    if found is None or following is None:
        return 0.0
    after = (run.times >= found["at"] + 0.3) & (run.times <= following["at"])
    return float(np.abs(speeds[after]).max(initial=0.0))


def obeys(run: Run, since: float, until: float) -> str:
    """Return what a robot obeys that moves between two times [s] after the end of a goal."""
    later = [0]
    until = min([until, *(each["at"] for each in run.events if each["event"] == "sent" and each["at"] > since)])
    for name in ("linear/x", "angular/z"):
        signal = run.recording.signal(f"topics/cmd_vel/{name}")
        times = signal.times / 1e9
        later.append(int(np.sum((times > since + 0.05) & (times < until) & (np.abs(signal.values) > 0.02))))
    if max(later) > 1:
        return (
            f"{max(later)} commands other than zero came after the end, so a timer, a callback or another loop still "
            "drives: take the goal away from it, too, and publish a Twist of zeros after that"
        )
    return "it obeys the last command until it gets a Twist of zeros"
