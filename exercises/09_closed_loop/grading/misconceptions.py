"""What a run along the wall looks like if the node has a common misconception; `wall.py` names the first that fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.suspects import suspect

from . import driving, fitted, law, searching, steering

if TYPE_CHECKING:
    from .wall import Run

SETTLED, KEPT = 7.0, 0.08  # [s] after the start; [m] within which a distance is kept
MEANS = {"mean", "median", "fmean", "average", "nanmean", "nanmedian", "percentile", "sum", "sorted", "sort"}
# Wrong distances -> the functions one of which makes them.
NEEDED = {"cos": {"cos"}, "sin": {"sin"}, "mean": MEANS, "max": {"max", "nanmax", "sorted", "sort", "argmax"}}
BEHIND = "behind the robot"
FIRST = 15  # scans in which the robot was too near


def explain(run: Run) -> str:
    """Return the misconception that fits the run; empty if none does."""
    looks = (
        open_loop,
        searching.searched,
        searching.left_out,
        searching.quarters,
        searching.halves,
        searching.ramp,
        searching.turns_to_one_side,
        exchanged,
        driving.backwards,
        steers_by,
        searching.stuck,
        never_drives,
        lambda run: driving.late_start(run, scans(run)[0]),
        lambda run: driving.rare_commands(run, scans(run)[0]),
        in_degrees,
        driving.on_off,
        counted_from_ray_zero,
        other_side,
        lambda run: driving.zero_rays(run, *scans(run)),
        driving.speed_by_distance,
        driving.speed_of_error,
        driving.other_axes,
        lambda run: driving.silent(run, scans(run)[0]),
        unchanging,
        one_way,
        late,
        opposite,
        without_sign,
        deaf,
        seldom,
        lambda run: law.left_alone(*point_and_rates(run)) if len(scans(run)[0]) else "",
        lambda run: law.kept_beside(run, SETTLED),
        offset,
        gaps,
        driving.straight_on,
        driving.added,
        mean_of_the_side,
        signs,
        nearest_anywhere,
        integrated,
        measures,
        driving.counted_turns,
        driving.stopped,
        old_distance,
        wrong_sign,
        wound_up,
        driving.circles,
        saturated,
        lambda run: law.strong(*point_and_rates(run)) if len(scans(run)[0]) else "",
        swings,
        driving.weak,
        driving.against_a_wall,
        lambda run: driving.elsewhere(run, SETTLED),
        lambda run: driving.slow(run) if np.median(np.abs(run.error[run.times > SETTLED])) < 0.3 else "",
    )
    if len(scans(run)[0]):
        run.lag = steering.lag(run, *scans(run))
    return next((said for look in looks if (said := look(run))), "")


def open_loop(run: Run) -> str:
    ends = run.recording.facts().get("endpoints", [])
    if any(end["kind"] == "subscription" and end["topic"] == "/lidar/scan" for end in ends):
        return ""
    return "your node does not subscribe to /lidar/scan, so it drives open loop, without feedback"


def never_drives(run: Run) -> str:
    """Find out whether the commands let the robot stand from the start."""
    if np.abs(run.along).sum() > 0.3:
        return ""
    ahead = np.abs(run.recording.signal("topics/cmd_vel/linear/x").values)
    turns = np.abs(run.recording.signal("topics/cmd_vel/angular/z").values)
    if not len(ahead):
        return ""
    if (ahead > 0.01).mean() < 0.05:
        less = "and turns on the spot" if (turns > 0.1).mean() > 0.5 else "and no command turns it"
        hits = scans(run)[2]
        none = "" if np.isfinite(hits).any() else "; no ray hits anything"
        said = f"the robot never drives, {less}: linear.x is 0 in {(ahead < 0.01).mean():.0%} of the commands{none}"
        far = ", also where the distance is wrong: it changes only while the robot drives"
        return said + (far if "on the spot" in less and not none else "")
    if (turns > 1.0).mean() > 0.8:
        return (
            f"the robot turns on the spot all the time: angular.z is beyond 1 rad/s in {(turns > 1.0).mean():.0%} of "
            "the commands, so the angle that it is made of never becomes small"
        )
    return ""


def measures(run: Run) -> str:
    times, bearings, ranges = scans(run)
    return steering.measures(run, times, bearings, ranges) if len(times) else ""


def signs(run: Run) -> str:
    times, bearings, ranges = scans(run)
    return steering.signs(run, times, bearings, ranges) if len(times) else ""


def point_and_rates(run: Run, standing: bool = False) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the nearest points of the side in all scans that were answered, the turning rates and the distances.

    Those in which the robot stands, such as against a wall, are left out: they are one scan many times over.
    """
    times, bearings, ranges = scans(run)
    heard, rates, asked = steering.answered(run, times)
    point, chosen = steering.measured(bearings, ranges[heard])["right"], moving(run) | standing
    return point[chosen], rates[chosen], asked[chosen]


def unchanging(run: Run) -> str:
    values = run.recording.signal("topics/cmd_vel/angular/z").values
    share = (np.abs(values) > 1.45).mean() if len(values) else 0.0
    if share > 0.3 and (why := suspect(run.recording, "unit")):
        return f"angular.z was at its limit in {share:.0%} of the commands: {why}"
    said = law.unchanging(run, values)
    circling = law.circling(run, values)
    why = suspect(run.recording, "integral", "added", "first_kept", "farthest", "bearing") if said else ""
    return f"{said.partition(':')[0]}: {why}" if why else circling or said


def one_way(run: Run) -> str:
    if not len(scans(run)[0]) or not (said := law.one_way(run, *point_and_rates(run))):
        return ""
    return law.offset(*point_and_rates(run, standing=True)) or said


def late(run: Run) -> str:
    """Find out whether the commands answer an average of many scans, or by the file another range than the nearest."""
    why = suspect(run.recording, "delay", "farthest")
    return why or (law.late(*point_and_rates(run, standing=True), moving(run)) if len(scans(run)[0]) else "")


def exchanged(run: Run) -> str:
    times = scans(run)[0]
    if not len(times):
        return ""
    point, rates, asked = point_and_rates(run, standing=True)
    ahead = ahead_of(run, times[steering.answered(run, times)[0]])
    return searching.exchanged(run, point, rates, asked, ahead)


def ahead_of(run: Run, times: np.ndarray) -> np.ndarray:
    """Return linear.x [m/s] of the commands that answer the scans of these times [s]."""
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    index = np.searchsorted(signal.times / 1e9, times) + run.lag
    return signal.values[np.minimum(index, len(signal.values) - 1)]


def steers_by(run: Run) -> str:
    """Find out which distance or bearing explains the commands, where those of the nearest point do not."""
    times, bearings, ranges = scans(run)
    if not len(times) or suspect(run.recording, "integral", "added", "delay"):
        return ""
    heard, rates, asked = steering.answered(run, times)
    chosen = moving(run)
    called = {each["name"] for each in run.recording.facts().get("called", [])}
    kinds = [kind for kind, names in NEEDED.items() if names & called]
    seen = bearings, ranges[heard][chosen], rates[chosen], asked[chosen]
    said = fitted.steers_by(*seen, kinds)
    if "counts for nothing" in said and (why := suspect(run.recording, "whole metres")):
        return f"{said}: {why}"
    said = said or fitted.signs(*seen, run.side)
    return said or fitted.times_speed(*seen, ahead_of(run, times[heard])[chosen])


def moving(run: Run) -> np.ndarray:
    """Return at which of the answered scans the robot moves."""
    times = scans(run)[0]
    speed = np.interp(times, run.times, np.abs(run.speed)) + 0.2 * np.interp(times, run.times, np.abs(run.turning))
    return speed[steering.answered(run, times)[0]] > 0.03


def offset(run: Run) -> str:
    return law.offset(*point_and_rates(run)) if len(scans(run)[0]) else ""


def opposite(run: Run) -> str:
    return law.opposite(run, *point_and_rates(run)) if len(scans(run)[0]) else ""


def without_sign(run: Run) -> str:
    return law.without_sign(*point_and_rates(run)) if len(scans(run)[0]) else ""


def deaf(run: Run) -> str:
    said = law.deaf(*point_and_rates(run)) if len(scans(run)[0]) else ""
    why = suspect(run.recording, "whole metres") if said else ""
    return f"{said.partition(':')[0]}: {why}" if why else said


def in_degrees(run: Run) -> str:
    if said := suspect(run.recording, "angle"):
        return said
    values = np.abs(run.recording.signal("topics/cmd_vel/angular/z").values)
    if len(values) and (values > 1.45).mean() > 0.3 and (why := suspect(run.recording, "degrees")):
        return f"angular.z was at its limit, or beyond it, in {(values > 1.45).mean():.0%} of the commands: {why}"
    if len(values) < 50 or np.mean(values > 5.0) < 0.1:
        return ""
    return (
        f"angular.z was up to {values.max():.0f} rad/s, as if it were in degrees per second, or an angle or a bearing "
        "in degrees: all of them are in radians"
    )


def counted_from_ray_zero(run: Run) -> str:
    """Find out whether bearings are counted from ray 0 in scans whose ray 0 looks elsewhere than ahead."""
    first = run.recording.signal("topics/lidar/scan/angle_min").values
    if not len(first) or abs(first[0]) < 0.1:
        return ""
    said = suspect(run.recording, "bearing")
    return f"{said}; here, angle_min is {first[0]:.2f}, {BEHIND if abs(first[0]) > 3.0 else 'not 0'}" if said else ""


def mean_of_the_side(run: Run) -> str:
    """Find out whether a mean of ranges is taken for the distance: it is larger, so the robot comes too near."""
    late = run.times > SETTLED
    if not late.any() or np.median(run.error[late]) > -0.1:
        return ""
    return suspect(run.recording, "mean")


def other_side(run: Run) -> str:
    late = run.times > SETTLED
    own = np.mean(np.abs(run.error[late]) < KEPT)
    other = np.mean(np.abs(run.other_side - run.wanted)[late] < KEPT)
    if own > 0.15 or other < 0.3:
        return ""
    wrong = "right" if run.side == "left" else "left"
    return f'side is "{run.side}", but the robot keeps its distance from the wall on its {wrong}'


def old_distance(run: Run) -> str:
    late = run.times > run.changed + 6.0
    if not late.any() or abs(run.asked[-1] - run.asked[0]) < 0.2 or np.abs(run.along[late]).sum() < 1.0:
        return ""
    usual = float(np.median(run.distance[late]))
    before = (run.times > SETTLED) & (run.times < run.changed)
    kept = float(np.median(run.distance[before])) if before.any() else run.asked[0]
    if abs(usual - run.asked[0]) > KEPT or abs(usual - kept) > 0.5 * abs(run.asked[-1] - run.asked[0]):
        return ""
    why = suspect(run.recording, "parameter distance", "parameter")
    if not why and len(scans(run)[0]):
        point, rates, asked = point_and_rates(run)
        new = asked == run.asked[-1]
        if not law.answers_old(point[new], rates[new], run.asked[0], run.asked[-1]):
            return ""
    why = why or "its new value does not reach what it steers by"
    return (
        f"the robot still keeps {usual:.2f} m, although distance was set from {run.asked[0]:g} to {run.asked[-1]:g} m "
        f"at {run.changed:g} s: {why}"
    )


def seldom(run: Run) -> str:
    """Find out whether the new distance is read too late, by the file, and was not answered at first."""
    if not len(scans(run)[0]) or not np.isfinite(run.changed) or not (why := suspect(run.recording, "seldom distance")):
        return ""
    heard, rates, _ = steering.answered(run, scans(run)[0])
    times = scans(run)[0][heard]
    first = (times > run.changed + 0.2) & (times < run.changed + 1.0)
    if not first.any() or abs(rates[first].mean()) > 0.5:
        return ""
    return f"{why}; distance was set from {run.asked[0]:g} to {run.asked[-1]:g} m at {run.changed:g} s"


def wrong_sign(run: Run) -> str:
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    error = np.interp(signal.times / 1e9, run.times, run.error)
    clear = (np.abs(error) > 0.2) & (np.abs(signal.values) > 0.05)
    agree = np.sign(error[clear]) == np.sign(run.sign * signal.values[clear])
    if len(agree) < 30 or agree.mean() > 0.45 or not len(scans(run)[0]):
        return ""
    if law.agrees(*point_and_rates(run)) > 0.3:
        return ""  # towards the wall by way of the heading, which counts more than the distance
    return "the robot turns away from the wall where it is too far, and towards it where it is too near: a wrong sign"


def wound_up(run: Run) -> str:
    near = (run.error < -0.12) & (run.sign * run.turning > 0.1)
    seconds = float(run.step[near & (run.ahead > run.wanted)].sum())
    if seconds < 1.0:
        return ""
    said = f"for {seconds:.1f} s the robot went on turning towards a wall that was already too near"
    if why := suspect(run.recording, "integral"):
        return f"{said}: {why}"
    if len(scans(run)[0]) and law.agrees(*point_and_rates(run)) > 0.9:
        return ""  # it answers the nearest point as it should
    return f"{said}: log what your node takes for the distance, and the distance that it keeps, and how old they are"


def saturated(run: Run) -> str:
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    share = float((np.abs(signal.values) > 1.45).mean()) if len(signal) else 0.0
    if share < 0.3:
        return ""
    jumps = np.abs(np.diff(signal.values)) > 2.0
    if jumps.mean() > 0.15:
        return (
            f"angular.z was at its limit in {share:.0%} of the commands, and jumped from one limit to the other "
            f"{jumps.sum()} times: the gain is far too high for the time between two scans"
        )
    left = float((signal.values > 1.45).mean())
    why = suspect(run.recording, "integral") or (law.strong(*point_and_rates(run)) if len(scans(run)[0]) else "")
    often = f"to the left in {left:.0%} and to the right in {share - left:.0%} of them"
    return f"angular.z was at its limit in {share:.0%} of the commands: {why or often}"


def integrated(run: Run) -> str:
    """Find out whether commands are at their limit in a node that adds up errors without end."""
    return saturated(run) if suspect(run.recording, "integral") else ""


def swings(run: Run) -> str:
    late = (run.times > SETTLED) & (np.abs(run.error) > 0.08)
    signs = np.sign(run.error[late])
    changes = int(np.count_nonzero(np.diff(signs)))
    if changes < 4:
        return ""
    said = (
        f"the robot swings about the wanted distance, {changes} times, by up to {np.abs(run.error[late]).max():.2f} m"
    )
    if len(scans(run)[0]) and law.heeds_heading(*point_and_rates(run)):
        return f"{said}: angular.z answers the distance too strongly, or too late, beside the heading"
    return f"{said}: only the distance is fed back, or the gain is too high for the time between two scans"


def scans(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times [s] (n,), bearings from ahead towards the side [rad] (m,) and ranges [m] (n, m) of all scans."""
    times, ranges = run.recording.arrays("topics/lidar/scan/ranges")
    first = run.recording.signal("topics/lidar/scan/angle_min").values
    step = run.recording.signal("topics/lidar/scan/angle_increment").values
    if not len(times):
        return np.empty(0), np.empty(0), np.empty((0, 0))
    return times / 1e9, run.sign * (first[0] + step[0] * np.arange(len(ranges[0]))), np.array(ranges)


def gaps(run: Run) -> str:
    """Find out whether the robot is too near to its wall where rays beside it hit nothing, and there alone."""
    times, bearings, ranges = scans(run)
    if not len(times):
        return ""
    beside = np.any(np.isposinf(ranges[:, np.abs(bearings - np.pi / 2) < 0.4]), axis=1)
    near = np.flatnonzero((times > 3.0) & (np.interp(times, run.times, run.error) < -0.1))[:FIRST]
    if len(near) < FIRST or beside[near].mean() < 0.8 or beside[times > 3.0].mean() > 0.6:
        return ""
    return (
        f"the robot comes too near where its wall has gaps, first at {times[near[0]]:.1f} s: rays through "
        "them read inf, and inf in a mean is inf; use isfinite on each range"
    )


def nearest_anywhere(run: Run) -> str:
    """Find out whether the robot has left its wall when something on its other side was nearer."""
    times, bearings, ranges = scans(run)
    lost = run.times[(run.times > 3.0) & (run.error > 0.2)]
    if not len(times) or not len(lost):
        return ""
    on_side = np.where((bearings > -0.2) & (ranges > 0), ranges, np.inf).min(axis=1)
    on_other = np.where((bearings < -0.4) & (ranges > 0), ranges, np.inf).min(axis=1)
    nearer = np.flatnonzero((times > lost[0] - 3.0) & (times < lost[0]) & (on_other < on_side))
    if not len(nearer):
        return ""
    first = nearer[0]
    after = (run.times > times[first]) & (run.times < lost[0])
    share = steering.follows(run, times, bearings, ranges)
    if (run.sign * run.turning[after]).mean() > -0.5 or (share and share["all around"] < share["right"] - 0.02):
        return ""
    other = "left" if run.side == "right" else "right"
    return (
        f"at {times[first]:.1f} s something on the {other} of the robot was nearer than the wall it follows, "
        f"{on_other[first]:.2f} m, and it left its wall: take the nearest range on the {run.side}, not of all"
    )
