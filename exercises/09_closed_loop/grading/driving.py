"""How the robot was driven: too slowly, straight on where the wall turns, with no command; `misconceptions.py` asks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect

if TYPE_CHECKING:
    from .wall import Run

LONG = 0.7  # [s] of driving straight on
FAR = 0.3  # [m] beyond the distance that is asked for


def slow(run: Run) -> str:
    """Find out whether the robot drives far below its limit although nothing is wrong with its way."""
    values = run.recording.signal("topics/cmd_vel/linear/x").values
    usual, most = (float(np.median(values)), float(values.max())) if len(values) else (0.0, 0.0)
    if not 0.01 < usual < 0.6 * run.limit:
        return ""
    if most < 0.8 * run.limit:
        return (
            f"the robot is too slow: linear.x is {most:.2f} m/s at most, and speed_limit is {run.limit:g} m/s; half of "
            "the way that it allows is asked for, so make the speed from the parameter speed_limit"
        )
    return (
        f"the robot is too slow: linear.x is {usual:.2f} m/s most of the time, and speed_limit is {run.limit:g} m/s; "
        "half of the way that it allows is asked for"
    )


def straight_on(run: Run) -> str:
    """Find out whether the robot drives straight on for long where its wall ends or lies far away."""
    signal = run.recording.signal("topics/cmd_vel/angular/z")
    ahead = run.recording.signal("topics/cmd_vel/linear/x").values
    times = signal.times / 1e9
    if len(times) < 20 or len(ahead) != len(times):
        return ""
    far = np.interp(times, run.times, np.minimum(run.error, 9.0)) > FAR
    straight = np.abs(signal.values) < 0.01
    straight[1:-1] |= straight[:-2] & straight[2:]  # a single command may turn
    straight &= (ahead > 0.01) & far & (times > 3.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], straight, [False]]).astype(int)))
    for start, end in zip(edges[::2], edges[1::2] - 1, strict=True):
        if times[end] - times[start] < LONG:
            continue
        there, then = (float(np.interp(times[each], run.times, run.distance)) for each in (start, end))
        if then < there - 0.1:
            continue  # it comes nearer at an angle
        return (
            f"from {times[start]:.1f} s on angular.z was 0 for {times[end] - times[start]:.1f} s, and the wall was "
            f"{min(there, then):.2f} m away or more: turn towards the wall there, to the {run.side}, as at a corner "
            "that turns outwards; only past gaps of up to 20 cm the robot drives straight on"
        )
    return ""


def circles(run: Run) -> str:
    """Find out whether the robot turns to one side all the time, for several full turns."""
    rates = run.recording.signal("topics/cmd_vel/angular/z").values
    turned = np.diff(run.times) @ run.turning[:-1] / (2 * np.pi)
    if len(rates) < 50 or abs(turned) < 2 or np.mean(np.sign(rates) == np.sign(turned)) < 0.98:
        return ""
    side, least = "left" if turned > 0 else "right", float(np.percentile(np.abs(rates), 5))
    said = f"the robot drives in circles, {abs(turned):.1f} of them: angular.z always turns it to the {side}"
    if least < 0.3:
        return said
    return f"{said}, by {least:.1f} rad/s or more, so the error that it is made of never becomes small"


def speed_by_distance(run: Run) -> str:
    """Find out whether linear.x follows the parameter distance: its largest value changes with it."""
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    times = signal.times / 1e9
    before, after = signal.values[(times > 1) & (times < run.changed)], signal.values[times > run.changed + 0.5]
    if min(len(before), len(after)) < 50 or abs(run.asked[-1] - run.asked[0]) < 0.1:
        return ""
    first, second = float(before.max()), float(after.max())
    ratio = run.asked[-1] / run.asked[0]
    if abs(second / max(first, 1e-9) - ratio) > 0.02 or not 0.6 * run.asked[0] < first < 1.05 * run.asked[0]:
        return ""
    return (
        f"linear.x is up to {first:.2f} m/s, and up to {second:.2f} m/s since distance was set from {run.asked[0]:g} "
        f"to {run.asked[-1]:g} m: it is made of the parameter distance, and the speed is limited by speed_limit"
    )


def other_axes(run: Run) -> str:
    """Find out whether the commands turn about an axis, or drive along one, that no robot on the ground has."""
    for name, right in (("angular/x", "angular/z"), ("angular/y", "angular/z"), ("linear/y", "linear/x")):
        values = np.abs(run.recording.signal(f"topics/cmd_vel/{name}").values)
        if len(values) and (values > 0.05).mean() > 0.2:
            wrong, instead = name.replace("/", "."), right.replace("/", ".")
            return (
                f"{wrong} is up to {values.max():.2f} in your commands, which a robot on two wheels cannot follow: it "
                f"{'turns by' if 'angular' in name else 'drives by'} {instead}"
            )
    return ""


def silent(run: Run, scans: np.ndarray) -> str:
    """Find out whether no command comes as long as the distance is about right: the robot goes on with the last one."""
    times = run.recording.signal("topics/cmd_vel/linear/x").times / 1e9
    if len(times) < 20 or len(scans) < 50:
        return ""
    index = np.searchsorted(times, scans)
    answered = (index < len(times)) & (times[np.minimum(index, len(times) - 1)] - scans < 0.12)
    clear = scans > 1.0
    error = np.abs(np.interp(scans, run.times, np.minimum(run.error, 9.0)))
    quiet = clear & ~answered
    if quiet.sum() < 15 or quiet.sum() < 0.05 * clear.sum():
        return ""
    near = float(np.percentile(error[quiet], 90))
    right = clear & (error < 0.7 * near)
    if near > 0.12 or (answered & right).sum() > 0.3 * right.sum() or not (error[clear & answered] > near).any():
        return ""
    return (
        f"no command came for {quiet.sum()} of {clear.sum()} scans, those in which the distance was right within "
        f"{near:.2f} m: without a new command the robot keeps the last one, and keeps turning; publish one "
        "for each scan"
    )


def zero_rays(run: Run, times: np.ndarray, bearings: np.ndarray, ranges: np.ndarray) -> str:
    """Find out whether rays that hit nothing count as 0 m, by the file, in scans that have such rays on the side."""
    if not len(times):
        return ""
    side = (bearings > -0.2) & (bearings < 2.5)
    if np.isinf(ranges[:, side]).any(axis=1).mean() < 0.02:
        return ""
    return suspect(run.recording, "zero")


def counted_turns(run: Run) -> str:
    """Find out whether the robot turns on the spot for longer than any corner needs."""
    command = run.recording.signal("topics/cmd_vel/angular/z")
    speed = run.recording.signal("topics/cmd_vel/linear/x").values
    if len(speed) != len(command.values) or not len(speed):
        return ""
    spinning = (np.abs(speed) < 0.01) & (np.abs(command.values) > 0.3)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], spinning, [False]]).astype(int)))
    times = command.times / 1e9
    for start, end in zip(edges[::2], edges[1::2] - 1, strict=True):
        turned = float(np.abs(command.values[start]) * (times[end] - times[start]))
        if turned > 2.4 and np.ptp(command.values[start : end + 1]) < 1e-6:
            return (
                f"from {times[start]:.1f} s on the robot turned on the spot for {times[end] - times[start]:.1f} s, by "
                f"{turned:.1f} rad: a turn that is counted in ticks lasts longer where ticks are missed; ask "
                "the clock, or the lidar"
            )
    return ""


def weak(run: Run) -> str:
    """Find out whether the robot never turns much, however wrong its distance is."""
    rates = np.abs(run.recording.signal("topics/cmd_vel/angular/z").values)
    late = run.times > 3.0
    worst = float(np.abs(run.error[late][np.isfinite(run.error[late])]).max(initial=0.0))
    if not len(rates) or not 0.01 < rates.max() < 0.6 or worst < 0.25:
        return ""
    if abs(rates.max() - np.radians(1.5)) < 1e-4:
        return (
            "angular.z was 0.026 rad/s at most, which is 1.5 degrees per second: 1.5 rad/s are allowed, so convert "
            "nothing"
        )
    if abs(rates.max() - run.limit) < 1e-3:
        return f"angular.z was {rates.max():.2f} rad/s at most, which is speed_limit: that limits linear.x alone"
    return (
        f"angular.z was {rates.max():.2f} rad/s at most, although the distance was wrong by up to {worst:.2f} m: the "
        "gain, or the limit of angular.z, is far too low to turn before a wall (1.5 rad/s are allowed)"
    )


def against_a_wall(run: Run) -> str:
    """Find out whether the robot was stopped by a wall."""
    if not run.touches.any():
        return ""
    first = int(np.argmax(run.touches))
    if run.times[first] > run.times[-1] - 3 or np.abs(run.along[first:]).sum() > 1.0:
        return ""
    before = (run.times > run.times[first] - 1.5) & (run.times < run.times[first])
    rate = float((run.sign * run.turning[before]).mean()) if before.any() else 0.0
    how = f"turned towards the wall on its {run.side}" if rate > 0.1 else "turned away too little or too late"
    return (
        f"the robot ran into a wall at {run.times[first]:.1f} s and got no further: in the 1.5 s before it {how}, by "
        f"{abs(rate):.1f} rad/s on average"
    )


def elsewhere(run: Run, settled: float) -> str:
    """Find out whether the robot is far from the distance asked for most of the time, once it has settled [s]."""
    late = (run.times > settled) & (run.times < run.changed)
    usual, asked = float(np.median(run.distance[late])), float(run.asked[0])
    if not np.isfinite(usual) or abs(usual - asked) < 0.2:
        return ""
    return (
        f"the robot is {usual:.2f} m from the nearest point of its wall most of the time, where {asked:g} m is asked "
        "for: print what your node takes for that distance, and angular.z beside it"
    )


def on_off(run: Run) -> str:
    values = run.recording.signal("topics/cmd_vel/angular/z").values
    found = np.unique(np.round(values[np.abs(values) > 0.01], 2))
    if len(values) < 50 or len(found) not in (2, 3) or found[0] >= 0 or found[-1] <= 0 or found[-1] < 0.1:
        return ""
    return (
        f"angular.z was only ever {', '.join(f'{value:g}' for value in found)} rad/s: on/off control overshoots at "
        "every scan; make it proportional to the error"
    )


def stopped(run: Run) -> str:
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    going = signal.times[np.abs(signal.values) > 0.01] / 1e9
    if not len(going) or going[-1] > run.times[-1] - 5 or run.ahead[-1] > 2.0:
        return ""
    return f"the robot stopped for good at {going[-1]:.1f} s, {run.ahead[-1]:.1f} m before the wall ahead of it"


def late_start(run: Run, scans: np.ndarray) -> str:
    """Find out whether the first command comes long after the first scan."""
    times = run.recording.signal("topics/cmd_vel/linear/x").times / 1e9
    if not len(times) or not len(scans) or times[0] - scans[0] < 3.0:
        return ""
    return (
        f"the first command comes at {times[0]:.1f} s, after {(scans < times[0]).sum()} scans: until then the robot "
        "stands; answer every scan from the first one on"
    )


def rare_commands(run: Run, times: np.ndarray) -> str:
    """Find out whether commands come much more rarely than scans."""
    commands = run.recording.signal("topics/cmd_vel/linear/x").times / 1e9
    if len(commands) < 5 or len(times) < 5:
        return ""
    between, apart = float(np.median(np.diff(commands))), float(np.median(np.diff(times)))
    if between < 2.5 * apart:
        return ""
    said = f"a command comes every {between:.2g} s only, and a scan every {apart:.2g} s"
    if why := suspect(run.recording, "sleep"):
        return f"{said}: {why}"
    return f"{said}: until the next command the robot obeys one from an old scan; publish in the callback of each scan"


def backwards(run: Run) -> str:
    """Find out whether many commands drive the robot backwards."""
    values = run.recording.signal("topics/cmd_vel/linear/x").values
    turns = np.abs(run.recording.signal("topics/cmd_vel/angular/z").values)
    share = float((values < -0.01).mean()) if len(values) else 0.0
    if share < 0.05 or (turns > 1.55).mean() > 0.05:  # what is beyond its limit comes first
        return ""
    return (
        f"linear.x is below 0 in {share:.0%} of the commands, {values.min():.2f} m/s at least: there the robot drives "
        "backwards; a factor of it becomes negative, so limit it, max(0.1, ...)"
    )


def added(run: Run) -> str:
    """Find out whether each command is added to the one before, and the commands are often at their limit for it."""
    values = run.recording.signal("topics/cmd_vel/angular/z").values
    if not len(values) or (np.abs(values) > 1.45).mean() < 0.1:
        return ""
    return suspect(run.recording, "added")


def speed_of_error(run: Run) -> str:
    """Find out whether linear.x follows the error of the distance, so that the robot stands where it is right."""
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    error = np.abs(np.interp(signal.times / 1e9, run.times, np.minimum(run.error, 9.0)))
    chosen = (signal.times > 1e9) & (signal.values < 0.95 * run.limit) & (error < 1.0)
    if chosen.sum() < 50 or error[chosen].std() < 0.03 or signal.values[chosen].std() < 0.01:
        return ""
    gain, least = np.polyfit(error[chosen], signal.values[chosen], 1)
    alike = np.corrcoef(error[chosen], signal.values[chosen])[0, 1]
    if alike < 0.95 or gain < 0.2 or abs(least) > 0.05:
        return ""
    return (
        f"linear.x is about {gain:.1f} times the error of the distance, so the robot stands where the distance is "
        "right: the error makes angular.z, and linear.x is made of speed_limit"
    )
