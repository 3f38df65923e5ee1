"""What a run along the wall looks like if the node has a common misconception; `wall.py` names the first that fits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

from . import driving, fitted, law, searching, steering
from .answered_scans import SETTLED, ahead_of, moving, point_and_rates, scans
from .new_distance import old_distance, seldom
from .other_walls import gaps, mean_of_the_side, nearest_anywhere, other_side

if TYPE_CHECKING:
    from .wall import Run

MEANS = {"mean", "median", "fmean", "average", "nanmean", "nanmedian", "percentile", "sum", "sorted", "sort"}
# Wrong distances -> the functions one of which makes them.
NEEDED = {"cos": {"cos"}, "sin": {"sin"}, "mean": MEANS, "max": {"max", "nanmax", "sorted", "sort", "argmax"}}
BEHIND = "behind the robot"


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
