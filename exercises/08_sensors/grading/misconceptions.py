"""What a run looks like if its node has a common misconception; `checks.py` asks for the one that fits."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording

from . import directions, hall, turning

HALF_VIEW = 0.5  # [rad] to either side; a post within it is surely in the picture
SEES = 3.4  # [m] within which a post is surely large enough
FOCAL_LENGTH, MIDDLE, HALF_HEIGHT = 80 / math.tan(0.6), 80, 60  # [pixels] of the cameras of the hall


def too_few_points(recording: Recording, points: np.ndarray) -> str:
    """Return why hardly any point came; empty if that is not known."""
    number = len(recording.signal("topics/red_post/count"))
    if number - len(points) > 5:
        return (
            f"{number - len(points)} of your {number} points are not finite: the depth is inf, or NaN, where "
            "nothing is near enough; take the depth of the red pixels, and leave out what is not finite"
        )
    red = hall.posts(recording, "red")[0]
    if number == 0:
        return suspect(recording, "depth")
    if 0 < len(points) <= len(red) + 1:
        return "a point came for each post once: one is asked for each red post in each pair of pictures"
    return ""


def missing_posts(recording: Recording, points: np.ndarray, stamps: np.ndarray, missing: np.ndarray) -> str:
    """Return why there is no point at some of the red posts, shape (n, 2), if all points are right."""
    times = np.unique(np.round(recording.signal("topics/camera/image/header/stamp").values * 1e9).astype(np.int64))
    times = times[times <= (stamps.max() if len(stamps) else 0)]
    if not len(times):
        return ""
    red = hall.posts(recording, "red")[0]
    visible = np.array([[in_view(at, place) for place in red] for at in zip(*hall.pose(recording, times), strict=True)])
    lost = np.array([any(np.allclose(place, each) for each in missing) for place in red])
    alone = visible[:, lost].any(axis=1) & (visible.sum(axis=1) == 1)
    together = visible[:, lost].any(axis=1) & (visible.sum(axis=1) > 1)
    turned = float(np.ptp(hall.truth(recording, "yaw", times)))
    if not visible[:, lost].any() and turned < 0.9 * hall.FULL_TURN:
        return f"the robot has turned by {math.degrees(turned):.0f} degrees only, and they were never in a picture"
    if together.any() and not alone.any():
        return "they were in pictures with another red post only: there may be several red things in one picture"
    start = [float(each[0]) for each in hall.pose(recording, np.zeros(1))]
    away = [float(np.hypot(*(place - start[:2]))) for place in missing]
    others = [float(np.hypot(*(place - start[:2]))) for place, gone in zip(red, lost, strict=True) if not gone]
    if others and min(away) > max(others):
        return (
            f"they are the farthest, {min(away):.1f} m away, where a post has few pixels: your rule for red, or for "
            "how many pixels a thing has at least, is too strict"
        )
    return ""


def in_view(at: tuple[float, float, float], place: np.ndarray) -> bool:
    ahead, left = hall.before_camera(tuple(map(float, at)), place)
    return 0.3 < ahead < SEES and abs(math.atan2(left, ahead)) < HALF_VIEW


def misplaced(recording: Recording, points: np.ndarray, stamps: np.ndarray, right: np.ndarray) -> str:
    """Return what else is wrong with points, of which some are right; empty if nothing fits."""
    red = hall.posts(recording, "red")[0]
    at = hall.pose(recording, stamps)
    ahead, left = points[:, 0], points[:, 1]
    if np.abs(points[:, :2]).max(initial=0.0) < 1e-3:
        return "every point is at (0, 0): nothing is put into point.x and point.y"
    if np.ptp(ahead) < 0.01 and np.ptp(left) < 0.01:
        return "every point is the same: compute it from each pair of pictures"
    if said := directions.said_again(points, stamps):
        return said
    if np.abs(left).max() < 1e-3 and np.abs(ahead).max() > 0.5:
        return (
            "point.y is always 0: a post is beside the middle of the picture, -(column - cx) / fx * ahead to the left"
        )
    if np.ptp(at[2]) > 1.0 and (said := directions.always_the_same(ahead, left)):
        return said
    seen = np.array([[hall.before_camera(tuple(each[i] for each in at), p) for p in red] for i in range(len(ahead))])
    if said := middle_off(seen, ahead, left):
        return said
    return (
        one_thing(seen, ahead, left, right)
        or directions.other_line(seen, ahead, left)
        or directions.of_rays(seen, ahead, left)
        or suspect(recording, "angle")
    )


def middle_off(seen: np.ndarray, ahead: np.ndarray, left: np.ndarray) -> str:
    """Find out whether all points are off to one side by the same share of their distance."""
    near = np.abs(seen[:, :, 0] - hall.RADIUS - ahead[:, None]) <= 0.15
    which = np.where(near, np.abs(seen[:, :, 1] - left[:, None]), np.inf).argmin(axis=1)
    known = near.any(axis=1) & (ahead > 0.3)
    if known.sum() < hall.FEWEST or known.mean() < 0.7:
        return ""
    off = (left - seen[np.arange(len(ahead)), which, 1])[known] / ahead[known]
    usual = float(np.median(off))
    if abs(usual) < 0.1 or np.mean(np.abs(off - usual) <= 0.06) < 0.7:
        return ""
    side = "left" if usual > 0 else "right"
    return (
        f"every point is too far to the {side}, by {abs(usual):.2f} m for each metre ahead: the column is counted from "
        f"{counted_from(MIDDLE + usual * FOCAL_LENGTH)}, and not from the middle of the picture, cx = k[2]"
    )


def counted_from(column: float) -> str:
    """Return what a column is that was taken for the middle one."""
    for known, words in ((0, "the left edge, column 0"), (2 * MIDDLE, f"the right edge, column {2 * MIDDLE}")):
        if abs(column - known) <= 6:
            return words
    if abs(column - HALF_HEIGHT) <= 4:
        return f"column {HALF_HEIGHT}, half of the height (a picture's shape is (height, width, channels))"
    return f"about column {column:.0f}"


def one_thing(seen: np.ndarray, ahead: np.ndarray, left: np.ndarray, right: np.ndarray) -> str:
    """Find out whether points are wrong exactly where two posts are in the picture."""
    angles = np.arctan2(seen[:, :, 1], seen[:, :, 0])
    visible = (np.abs(angles) < HALF_VIEW) & (seen[:, :, 0] > 0.3) & (seen[:, :, 0] < SEES)
    several = visible.sum(axis=1) > 1
    low = np.where(visible, angles, np.inf).min(axis=1)
    high = np.where(visible, angles, -np.inf).max(axis=1)
    direction = np.arctan2(left, ahead)
    between = several & (direction > low + 0.03) & (direction < high - 0.03)
    if (~right).sum() >= 3 and between[~right].mean() > 0.7 and right[~several].mean() > 0.8:
        return (
            "points are wrong where two red posts are in one picture: they lie between the two, as if all red pixels "
            "were one thing; make one point for each group of red columns side by side"
        )
    return ""


def other_depth(recording: Recording, points: np.ndarray, stamps: np.ndarray, right: np.ndarray) -> str:
    """Find out what the distances are if the directions are right."""
    wrong, at = ~right, hall.pose(recording, stamps)
    red, ahead, left = hall.posts(recording, "red")[0], points[:, 0], points[:, 1]
    seen = np.array([[hall.before_camera(tuple(each[i] for each in at), p) for p in red] for i in range(len(ahead))])
    angles = np.arctan2(seen[:, :, 1], seen[:, :, 0])
    near = np.abs(angles - np.arctan2(left, ahead)[:, None]) <= 0.06
    known = near.any(axis=1) & wrong
    if known.sum() < 5 or known.sum() < 0.7 * wrong.sum():
        return ""
    which = np.where(near, seen[:, :, 0], np.inf).argmin(axis=1)
    true = seen[np.arange(len(ahead)), which]
    straight = true[known, 0]
    ratio = ahead[known] / (straight - hall.RADIUS)
    usual = float(np.median(ratio))
    if np.ptp(ahead[known]) < 0.02:
        return (
            f"the directions are right, but every distance is {ahead[known][0]:.2f} m: it must be read from the depth"
        )
    if abs(usual - 1) > 0.1 and np.mean(np.abs(ratio - usual) <= 0.08 * abs(usual)) > 0.8:
        return f"the directions are right, and the distances are {usual:.2f} times the right ones"
    if np.mean(np.abs(ahead - to_the_wall(at, np.arctan2(left, ahead)))[known] < 0.3) > 0.7:
        return (
            "the directions are right and the distances are those of the wall behind the posts: take the depth at the "
            "red pixels"
        )
    return ""


def to_the_wall(at: tuple[np.ndarray, np.ndarray, np.ndarray], direction: np.ndarray) -> np.ndarray:
    """Return how far ahead [m] of the camera the wall of the hall is in a direction [rad] from ahead."""
    x, y, yaw = at
    x, y = x + hall.CAMERA_AHEAD * np.cos(yaw), y + hall.CAMERA_AHEAD * np.sin(yaw)
    c, s = np.cos(yaw + direction), np.sin(yaw + direction)
    with np.errstate(divide="ignore", invalid="ignore"):
        across = np.where(c > 0, (hall.HALL[0] - x) / c, (-hall.HALL[0] - x) / c)
        along = np.where(s > 0, (hall.HALL[1] - y) / s, (-hall.HALL[1] - y) / s)
    return np.minimum(across, along) * np.cos(direction)


def never_turned(recording: Recording) -> str:
    """Return why the robot did not turn, and no number came."""
    if not len(recording.signal("topics/cmd_vel/angular/z")):
        return (
            "no command came on /cmd_vel, because drive() returns as long as self.heading is None: on_imu must set it "
            "to 0.0 when the first second is over, and then add what the robot has turned"
        )
    return ""


def on_and_on(recording: Recording) -> str:
    """Return why the robot never stopped turning, as far as the file tells."""
    return (
        suspect(recording, "gyroscope", "angle")
        or turning.turned_early(recording)
        or (
            "your heading never reached a full turn, 2 pi, so the robot kept turning: log it in on_imu, and see at "
            "which message it does not grow as the robot turns"
        )
    )


def too_fast(recording: Recording, turned: float) -> str:
    """Return what is wrong with a heading that was a full turn when the robot had turned by another angle [rad]."""
    if said := suspect(recording, "gyroscope", "angle"):
        return said
    if abs(turned) < 0.05:
        return "the number came before the robot had turned at all: the heading was a full turn from the start"
    factor = hall.FULL_TURN / turned
    return f"your heading grows {factor:.2f} times as fast as the robot turns" if turned > 0 else ""


def several_numbers(recording: Recording) -> str:
    """Return why several numbers came."""
    signal = recording.signal("topics/red_count/data")
    gaps = np.diff(signal.times) / 1e9
    if (np.diff(signal.values) > 0).any() and (np.diff(signal.values) >= 0).all():
        return "a number came for each post that was found: publish it once, when the turn is over"
    if len(gaps) > 3 and np.ptp(gaps) < 0.05:
        return (
            f"the number comes again every {np.median(gaps):.2g} s: what publishes it is done in every call after the "
            "turn; remember that it was said"
        )
    return ""


def other_count(recording: Recording, number: int, when: int, placed_right: bool) -> str:
    """Return what else a wrong number of red posts counts, given when it came [ns]; empty if that is not known.

    `placed_right` says whether the points on /red_post are right.
    """
    points, stamps, came = hall.said_points(recording)
    names = hall.posts(recording)[1]
    red = sum(name.startswith("red") for name in names)
    if number == 0:
        said = "no post was remembered: self.posts is empty when the turn is over"
        why = suspect(recording, "same")  # such as a new post that must be far from a known one, when none is known
        return (f"{why} ({said})" if why else said) if len(points) else ""
    if said := suspect(recording, "same", "unturned"):
        return said
    if (said := suspect(recording, "axes")) and number == hall.found_if(recording, when, -1.0):
        return said  # mirrored directions make as many places as headings of the other sign
    if number == len(names) and not placed_right:
        return "that is the number of all posts, of every colour"
    kinds = {kind: sum(name.startswith(kind) for name in names) for kind in ("blue", "orange", "green")}
    for kind, many in kinds.items():
        if many and number == red + many and hall.hits(*_there(recording, kind)).any():
            return f"that is the number of red and {kind} posts together"
    before = came <= when
    if not before.any():
        return ""
    together = max(Counter(stamps[before].tolist()).values())
    if number == together < red and (why := suspect(recording, "one picture")):
        return f"that is how many were in one picture: {why}"
    x, y, yaw = (each[before] for each in hall.pose(recording, stamps))
    here = hall.placed((x, y, yaw), points[before, 0], points[before, 1]) - (x[0], y[0])
    turned = [*turned_otherwise(recording, when)] if number > red + 2 else []  # so many are hardly a coincidence
    if said := the_only_one(number, turned):
        return said
    picture = "that is how many were in one picture: they must be remembered over the whole turn"
    ways = [(picture, together), *turned_otherwise(recording, when), *ways_to_count(here, points[before], yaw)]
    if said := the_only_one(number, ways):
        return said
    if number == len(names) and not after_another(here, number):
        return "that is the number of all posts, of every colour"
    if number > red and float(yaw[-1] - yaw[0]) > 0.9 * hall.FULL_TURN and number <= 2 * red:
        return (
            "posts were counted again: the places of the same post differ by more than your rule for 'the same' allows"
        )
    return ""


def turned_otherwise(recording: Recording, when: int) -> Iterator[tuple[str, int]]:
    """Yield wrong ways to turn the points until a time [ns], and how many places they give."""
    words = "that is the number of places if the points are "
    yield words + "not turned by the heading at which they were seen", hall.found_if(recording, when, 0.0)
    back = hall.found_if(recording, when, -1.0)
    yield words + "turned the wrong way: check the signs of sin(heading)", back


def the_only_one(number: int, ways: list[Any]) -> str:
    """Return the words of the wrong rule that gives this number; empty if none does, or rules of different kinds."""
    fitting = [words for words, found in ways if found == number]
    kinds = {re.sub(r"[\d.]+", "", words).partition(":")[0] for words in fitting}
    return fitting[0] if len(kinds) == 1 else ""


def _there(recording: Recording, kind: str) -> tuple[np.ndarray, np.ndarray]:
    points, stamps, _ = hall.said_points(recording)
    return hall.placed(hall.pose(recording, stamps), points[:, 0], points[:, 1]), hall.posts(recording, kind)[0]


def ways_to_count(here: np.ndarray, points: np.ndarray, yaw: np.ndarray) -> Iterator[tuple[str, int]]:
    """Yield wrong rules for which points are the same post, and how many posts they find among points (n, 2)."""
    for metres in (1.0, 1.5, 2.0, 3.0, 5.0):
        words = (
            f"that is the number if points up to {metres:g} m apart are one post: the posts stand nearer to each other"
        )
        yield words, _distinct(here, metres)
    for metres in (0.02, 0.05, 0.1):
        words = (
            f"that is the number if points more than {metres:g} m apart are two posts: depth and heading have errors"
        )
        yield words, _distinct(here, metres)
    c, s = math.cos(yaw[0]), math.sin(yaw[0])
    first = np.stack([here[:, 0] * c + here[:, 1] * s, here[:, 1] * c - here[:, 0] * s], axis=1)  # seen from the start
    words = "that is the number if posts are one as soon as they have about the same"
    yield f"{words} x, or the same y: compare the distance between them", _distinct(first, hall.SAME_PLACE, np.min)
    for axis, name in enumerate("xy"):
        yield f"{words} {name}: compare the distance between them", _distinct(first[:, [axis]], hall.SAME_PLACE)
    last = 1 + int((np.hypot(*np.diff(here, axis=0).T) > hall.SAME_PLACE).sum())
    yield "that is the number if each point is compared with the last one only, and not with all known posts", last
    degrees = np.degrees(yaw)
    c, s = np.cos(degrees), np.sin(degrees)
    ahead, left = points[:, 0] + hall.CAMERA_AHEAD, points[:, 1]
    turned = np.stack([ahead * c - left * s, ahead * s + left * c], axis=1)
    yield "that is the number if cos and sin get the heading in degrees", _distinct(turned, hall.SAME_PLACE)
    distances = np.hypot(*here.T)
    yield (
        "that is the number if posts at the same distance are one: the direction counts, too",
        _distinct(distances[:, None], hall.SAME_PLACE),
    )


def after_another(here: np.ndarray, number: int) -> bool:
    """Find out whether a number comes about, too, if points are compared with one known post alone."""
    found = []
    for which in (min, max):
        known = [here[0]]
        for place in here:
            if np.linalg.norm(place - which(known, key=np.linalg.norm)) > hall.SAME_PLACE:
                known.append(place)
        found.append(len(known))
    return number in found


def _distinct(places: np.ndarray, apart: float, size: Callable[..., Any] = np.linalg.norm) -> int:
    """Return how many places are more than `apart` [m] from all before them, by the `size` of the difference."""
    known: list[np.ndarray] = []
    for place in places:
        if all(size(np.abs(place - other)) > apart for other in known):
            known.append(place)
        if len(known) > hall.MOST_PLACES:
            break
    return len(known)
