"""Why the robot stood at a wrong place at the end, or still moved; `misconceptions.py` hands it on."""

from __future__ import annotations

import math

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording

from . import hall


def other_post(recording: Recording, name: str) -> str:
    """Return by which rule a red post was chosen that is not the nearest; empty if none fits."""
    red, names = hall.posts(recording, "red")
    start = [float(each[0]) for each in hall.pose(recording, np.zeros(1))]
    away = np.linalg.norm(red - np.array(start[:2]), axis=1)
    chosen = names.index(name)
    points, stamps, came = hall.said_points(recording)
    first = hall.counted(recording)
    there = hall.placed(hall.pose(recording, stamps), points[:, 0], points[:, 1])
    there = there[came <= (first[0] if first else recording.end_ns)]
    if said := suspect(recording, "nearest"):
        return said
    order = [int(np.linalg.norm(red - place, axis=1).argmin()) for place in there if len(red)]
    if chosen == int(away.argmax()):
        return "it is the farthest one: the nearest has the smallest distance"
    if order and chosen == order[0]:
        return "it is the one that was seen first: the nearest is asked for"
    if order and chosen == order[-1]:
        return "it is the one that was seen last: the nearest is asked for"
    return ""


def wrong_stop(recording: Recording, away: float) -> str:
    """Return why the robot stood at another distance [m] before the right post than it should."""
    command = recording.signal("topics/cmd_vel/linear/x")
    if len(command) and command.times[-1] < recording.end_ns - 2e9 and abs(command.values[-1]) > 0.02:
        return f"no command came after {command.times[-1] / 1e9:.1f} s, and the robot obeys the last one"
    if away < 0.2:
        return "it drove until it touched the post: nothing stopped it"
    if abs(away - (hall.STOP - hall.CAMERA_AHEAD - hall.RADIUS)) < 0.06:
        return (
            "the middle of the robot is 1 m before the middle of the post; what the depth camera measures "
            "counts, to the front of the post"
        )
    near = "too near" if away < hall.STOP else "too far away"
    return f"it is {near} by {abs(away - hall.STOP):.2f} m: the depth camera must measure 1 m to the post at the end"


def away_from_it(recording: Recording) -> str:
    """Return whether the robot drove backwards where the nearest red post was too far away."""
    late = np.array([recording.end_ns - 3_000_000_000, recording.end_ns])
    seen = [
        [hall.before_camera(tuple(float(each[i]) for each in hall.pose(recording, late)), place) for i in (0, 1)]
        for place in hall.posts(recording, "red")[0]
    ]
    before, after = min(seen, key=lambda post: abs(math.atan2(post[1][1], post[1][0])))
    speed = float(hall.truth(recording, "linear_x", late)[1])
    if speed > -0.02 or before[0] < hall.STOP + hall.RADIUS or after[0] < before[0] + 0.1:
        return ""
    return (
        "it drives backwards, away from the post, although that is more than 1 m away: linear.x has a wrong sign, it "
        "must be positive where depth is more than 1 m"
    )


def turned_far(recording: Recording) -> str:
    """Return whether the robot turned by clearly more than half a turn towards the post; empty if not."""
    first = hall.counted(recording)
    if first is None:
        return ""
    times = np.arange(first[0], recording.end_ns, 50_000_000)
    yaw = hall.truth(recording, "yaw", times)
    turned = float(np.ptp(yaw)) if len(yaw) else 0.0
    if turned < math.pi + 0.4:
        return ""
    why = suspect(recording, "wrap") or (
        "the way to a direction is never longer than half a turn, so the difference of two angles needs "
        "math.remainder(difference, 2 * math.pi)"
    )
    return f"after the number came it turned by {math.degrees(turned):.0f} degrees to face a post: {why}"


def faced_nothing(recording: Recording, here: tuple[float, ...], start: tuple[float, ...]) -> str:
    """Return in which wrong direction the robot looked at the end."""
    if said := turned_far(recording):
        return said
    red = hall.posts(recording, "red")[0]
    nearest = red[int(np.argmin(np.linalg.norm(red - np.array(start[:2]), axis=1)))]
    wanted = math.remainder(math.atan2(nearest[1] - start[1], nearest[0] - start[0]) - start[2], 2 * math.pi)
    looked = math.remainder(here[2] - start[2], 2 * math.pi)
    if abs(math.remainder(looked + wanted, 2 * math.pi)) < 0.2 < abs(wanted):
        return "it looked to the right where the nearest red post is to the left, or the other way round: a wrong sign"
    if abs(looked) < 0.15 < abs(wanted):
        return "it looked where it had looked at the start, and not to the nearest red post"
    off = math.degrees(math.remainder(looked - wanted, 2 * math.pi))
    return (
        f"at the end it looked {abs(off):.0f} degrees to the {'left' if off > 0 else 'right'} of the nearest red post"
    )


def still_moving(recording: Recording) -> str:
    """Return why the robot was moving at the end."""
    speed = recording.signal("topics/cmd_vel/linear/x")
    if said := turned_far(recording) or away_from_it(recording):
        return said
    late = speed.values[speed.times > recording.end_ns - 3e9]
    if len(speed) and speed.times[-1] < recording.end_ns - 1e9:
        return f"no command came after {speed.times[-1] / 1e9:.1f} s, and the robot obeys the last one"
    signs = np.sign(late[np.abs(late) > 0.02])
    if np.count_nonzero(np.diff(signs)) >= 3:
        return "it drives to and fro: the gain is too high, or nothing says when it is near enough"
    return ""
