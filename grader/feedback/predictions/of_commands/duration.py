"""Wrong durations: what a program takes for seconds."""

from __future__ import annotations

import numpy as np

from gz_course.grader.feedback.predictions.commands import Drive, explains
from gz_course.grader.feedback.predictions.of_commands.sequence import all_at_once, one_after_the_other

LATE = 0.6  # [s] after which the first command of a drive is late
# Ratio of the time driven to the time asked for -> its reason.
RATIOS = {
    0.5: "half of what is asked for; a clock that runs twice as fast as that on the wall, or a count of ticks of 0.5 s "
    "taken for seconds, gives that",
    2.0: "twice what is asked for (at half a metre per second that is the time for as many metres as seconds)",
    0.2: "a fifth of what is asked for",
    0.1: "a tenth of what is asked for",
}


def _only_push(drive: Drive) -> tuple[float, float, int]:
    """Return begin [s], duration [s] and number of commands of the only drive that was ended; zeros if none."""
    pushes = [push for push in drive.pushes if np.isfinite(push[1])]
    if len(pushes) != 1 or len(drive.pushes) != 1:
        return 0.0, 0.0, 0
    begin, end, number = pushes[0]
    return begin, end - begin, number


def _wrong(drive: Drive, duration: float) -> bool:
    return abs(duration - drive.seconds) > 0.06 * drive.seconds


@explains
def counts_commands(drive: Drive) -> str:
    """Find a count of ticks of a usual period that makes up the time, although the ticks came less often."""
    _, duration, number = _only_push(drive)
    if not number or number < 4 or not _wrong(drive, duration) or "by_place" in drive.suspects:
        return ""
    period = duration / number
    for off in (0, -1):
        if abs(number + off - drive.seconds) < 0.01 and abs(period - 1) > 0.05:
            return (
                f"after {number} commands, {period:.2f} s apart, the robot was stopped: ticks of the timer were "
                "counted as seconds"
            )
        for tick in (0.01, 0.02, 0.05, 0.1, 0.2, 0.25, 0.5):
            if abs((number + off) * tick - drive.seconds) < 1e-6 and period > 1.05 * tick:
                return (
                    f"{number} commands were sent before the stop, as many as a timer of {tick:g} s has ticks in "
                    f"{drive.seconds:g} s, but they came {period:.2f} s apart: your node counts ticks, "
                    "which are not time"
                )
    return ""


@explains
def whole_seconds(drive: Drive) -> str:
    begin, duration, number = _only_push(drive)
    if not number or not _wrong(drive, duration) or not 0.95 * drive.seconds <= duration <= drive.seconds + 1.3:
        return ""
    if np.ptp(drive.linear[drive.moving, 0]) > 0.01:
        return ""
    end = begin + duration
    tick = 0.3 if np.isnan(drive.period) else 1.1 * drive.period + 0.02
    if end - np.floor(end) > tick:
        return ""
    return (
        f"the drive began at {begin:.2f} s and ended at {end:.2f} s, where a new second begins: only the whole "
        "seconds of the time were compared"
    )


@explains
def stops_at_once(drive: Drive) -> str:
    _, duration, number = _only_push(drive)
    if not number or duration > 0.08 * drive.seconds or len(drive.times) < 4 or all_at_once(drive):
        return ""
    return (
        f"the drive ended after {duration:.2f} s, {'1 command' if number == 1 else f'{number} commands'}: the time "
        "that has passed is compared in too small a unit (milliseconds, microseconds or nanoseconds taken for seconds)"
    )


@explains
def coarse_timer(drive: Drive) -> str:
    """Find a stop that came with the first tick after the time, of a timer that ticks too seldom."""
    _, duration, number = _only_push(drive)
    if not number or not _wrong(drive, duration) or not drive.period > 0.1 * drive.seconds:
        return ""
    if not drive.seconds < duration <= drive.seconds + 1.05 * drive.period:
        return ""
    return (
        f"the commands come {drive.period:.2f} s apart, so the stop waits for the first one after {drive.seconds:g} s "
        f"and comes {duration:.2f} s after the start: a timer of 0.1 s looks often enough"
    )


@explains
def other_duration(drive: Drive) -> str:
    begin, duration, number = _only_push(drive)
    if all_at_once(drive) or one_after_the_other(drive):
        return ""
    if (
        not number
        or counts_commands(drive)
        or coarse_timer(drive)
        or whole_seconds(drive)
        or not _wrong(drive, duration)
        or stops_at_once(drive)
    ):
        return ""
    if why := drive.suspects.get("by_place"):
        return f"the robot was driven for {duration:.2f} s, where {drive.seconds:g} s are asked for: {why}"
    for ratio, reason in RATIOS.items():
        if abs(duration - ratio * drive.seconds) <= 0.06 * ratio * drive.seconds + (drive.period or 0.0):
            return f"the robot was driven for {duration:.2f} s, {reason}"
    return f"the robot was driven for {duration:.2f} s, from {begin:.2f} s on, where {drive.seconds:g} s are asked for"


@explains
def begins_late(drive: Drive) -> str:
    if one_after_the_other(drive):
        return ""
    if not drive.pushes or drive.pushes[0][0] <= max(LATE, 2.5 * (0.0 if np.isnan(drive.period) else drive.period)):
        return ""
    begin = drive.pushes[0][0]
    before = int(np.sum(drive.times < begin))
    said = f"{before} commands of zero came before" if before else "nothing was sent before"
    whole = ""
    if begin >= 0.9 * drive.seconds:
        whole = (
            " the drive and the stand are the wrong way round" if before else " a timer fires first after its period"
        )
    return f"the robot was first driven at {begin:.2f} s ({said}){':' + whole if whole else ''}"
