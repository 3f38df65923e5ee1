"""The checks of this exercise: what the node said and did, compared with the true places of robot and posts.

`misconceptions.py` says more about what a wrong run looks like.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.topic_faults import subscriptions

from . import directions, misconceptions, stopping
from .hall import (
    CAMERA_AHEAD,
    FEWEST,
    FULL_TURN,
    NEAR,
    RADIUS,
    STOP,
    TURN_OFF,
    before_camera,
    counted,
    hits,
    placed,
    pose,
    posts,
    said_points,
    truth,
)
from .turning import why_turned

FRAME = "camera_link"  # of the points
SHARE = 0.9  # of the points that must be right
STOP_OFF, FACING = 0.12, 0.12  # [m], [rad]
STILL = 1.0  # [s] at the end


def places_the_posts(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if nearly all points lie at red posts, and each red post got one."""
    expected = f"points within {NEAR:g} m of the red posts, at least one for each of them"
    points, stamps, came = said_points(recording)
    if len(points) < FEWEST:
        number = f"{len(points) or 'no'} points came on /red_post"
        deaf = subscriptions(recording, recording.facts()).rstrip(".")
        why = deaf or misconceptions.too_few_points(recording, points)
        nothing = not len(points) and not deaf
        return Finding(False, expected, f"{number}, at least {FEWEST} are needed", explanation=why, nothing=nothing)
    red, names = posts(recording, "red")
    at = pose(recording, stamps)
    there = placed(at, points[:, 0], points[:, 1])
    right = hits(there, red)
    measured = f"{right.sum()} of {len(right)} points lie at red posts"
    missing = [name for name, place in zip(names, red, strict=True) if not hits(there, place[None]).any()]
    pictures = np.round(recording.signal("topics/camera/image/header/stamp").values * 1e9).astype(np.int64)
    stamped = np.isin(np.round(stamps / 1e3), np.round(pictures / 1e3))  # to a microsecond
    passed = right.mean() >= SHARE and not missing
    frames = sorted({line.text for line in recording.lines("topics/red_post/header/frame_id")} - {FRAME})
    if frames or not recording.lines("topics/red_post/header/frame_id"):
        named = repr(shown(frames[0], 40)) if frames else "empty"
        return Finding(False, expected, f"header.frame_id was {named} and not {FRAME!r}")
    if passed and stamped.mean() < SHARE:
        seen = f"{(~stamped).sum()} of {len(stamps)} stamps are of no picture"
        why = "header.stamp must be that of the picture, image.header.stamp, and not the time now"
        return Finding(False, expected, seen, round(float(came[np.argmin(stamped)] / 1e9), 3), explanation=why)
    if passed and (why := directions.one_a_picture(recording, there, stamps)):
        return Finding(False, expected, measured, explanation=why)
    if passed:
        return Finding(True, expected, measured)
    if right.mean() >= SHARE:
        lost = red[[name in missing for name in names]]
        why = misconceptions.missing_posts(recording, points, stamps, lost)
        seen = f"{measured}, but none at {len(missing)} of the {len(red)} red posts"
        return Finding(False, expected, seen, gated=not turns_once(recording, parameters).passed, explanation=why)
    first = int(np.argmin(right))
    ahead, left = points[first, :2]
    nearest = red[np.argmin(np.linalg.norm(red - there[first], axis=1))]
    true = before_camera(tuple(each[first] for each in at), nearest)
    measured += (
        f"; the first wrong one, stamped {stamps[first] / 1e9:.2f} s, was {ahead:.2f} m ahead and {left:.2f} m left; "
        f"the nearest red post was {true[0] - RADIUS:.2f} m ahead and {true[1]:.2f} m left"
    )
    why = (
        why_misplaced(recording, points, stamps, right)
        or suspect(recording, "picture")
        or misconceptions.misplaced(recording, points, stamps, right)
        or why_somewhere(recording, points, stamps, right)
    )
    return Finding(False, expected, measured, round(float(came[first] / 1e9), 3), explanation=why)


def why_misplaced(recording: Recording, points: np.ndarray, stamps: np.ndarray, right: np.ndarray) -> str:
    """Return the misconception that explains most of the wrong points; empty if none does."""
    red, _ = posts(recording, "red")
    at = pose(recording, stamps)
    x, y, z = points.T
    wrong = ~right

    if not stamps.any():
        return "header.stamp was left at zero: copy it from the picture"

    def fits(
        ahead: np.ndarray,
        left: np.ndarray,
        at: Sequence[np.ndarray] = at,
        places: np.ndarray = red,
    ) -> bool:
        return hits(placed(at, ahead, left), places)[wrong].mean() >= 0.75

    for scale, how in ((1e-3, "1000 times too large"), (1e3, "1000 times too small"), (1e-2, "100 times too large")):
        if fits(x * scale, y * scale):
            return f"the points are {how}: a depth picture of the encoding 32FC1 has metres, and points need metres"
    if said := why_beside(at, x, y, red, right):
        return said
    for colour in ("blue", "orange", "green"):
        if fits(x, y, places=posts(recording, colour)[0]):
            if colour == "blue":
                return "the points lie at the blue posts: red and blue are swapped (rgb8 and bgr8)"
            return f"the points lie at the {colour} posts, too: your rule for red holds for {colour}"
    start = [np.full(len(x), each[0]) for each in pose(recording, np.zeros(1))]
    here, camera = (at[0], at[1], start[2]), placed(at, np.zeros(len(x)), np.zeros(len(x)))
    turned = (
        "the points are turned by the robot's heading; point.x is how far ahead of the camera a post is and point.y "
        "how far to its left, whatever the heading: only the list of posts needs it"
    )
    candidates = (
        ((x, -y, at), "left and right are swapped: columns grow to the right, y grows to the left"),
        ((z, -x, at), "the points are those of an optical frame (x right, y down, z ahead)"),
        ((y, x, at), "x and y are exchanged: x is ahead, y is to the left"),
        ((-y, x, at), "x and y are swapped: x is ahead, y is to the left"),
        ((x, y * math.pi / 180, at), "y comes from an angle in degrees, where radians are needed"),
        ((x - CAMERA_AHEAD, y, start), "the points are places in the hall, seen from the start, not from the camera"),
        ((x - CAMERA_AHEAD, y, here), turned),
        ((x - CAMERA_AHEAD, y, (camera[:, 0], camera[:, 1], start[2])), turned),
    )
    for (ahead, left, where), words in candidates:
        if fits(ahead, left, where):
            return words
    return ""


def why_somewhere(recording: Recording, points: np.ndarray, stamps: np.ndarray, right: np.ndarray) -> str:
    """Return what kind of wrong points these are if no misconception fits them; empty if that is not known."""
    red, at = posts(recording, "red")[0], pose(recording, stamps)
    x, y, _ = points.T
    wrong = ~right
    turning = np.abs(truth(recording, "angular_z", stamps)) > 0.3
    if (~turning).sum() >= 3 and right[~turning].mean() >= SHARE:
        words = "the points are right while the robot stands and wrong while it turns: "
        for lag in (0.2, 0.4, -0.2, -0.4):
            if hits(placed(pose(recording, stamps - round(lag * 1e9)), x, y), red)[wrong].mean() >= 0.75:
                return f"{words}the stamp is not that of the picture"
        return f"{words}colour and depth are of different times"
    if said := misconceptions.other_depth(recording, points, stamps, right):
        return said
    if directed(at, x, y, red)[wrong].mean() >= 0.75:
        return (
            "the directions are right and the distances are wrong: the depth picture (encoding 32FC1: float32, metres) "
            "was read as something else, or at other pixels"
        )
    if hits(placed(at, x, y), posts(recording)[0])[wrong].mean() > 0.25:
        return ""
    said = "most of the wrong points lie where no post stands"
    at_walls = np.abs(misconceptions.to_the_wall(at, np.arctan2(y, x)) - x) < 0.4
    overflow = suspect(recording, "overflow")
    if overflow or at_walls[wrong].mean() > 0.5:
        why = overflow or "red is where R is much larger than G and B"
        return f"{said}, so walls or floor count as red: {why}"
    return said


def why_beside(
    at: tuple[np.ndarray, np.ndarray, np.ndarray],
    ahead: np.ndarray,
    left: np.ndarray,
    places: np.ndarray,
    right: np.ndarray,
) -> str:
    """Return what is wrong with `left` if it is another multiple of the true one; empty if `ahead` is wrong, too.

    The multiple is the same for all points, or in proportion to 1 / ahead.
    """
    every = [before_camera(tuple(each[i] for each in at), place) for i in range(len(ahead)) for place in places]
    seen = np.array(every).reshape(len(ahead), len(places), 2)
    # of the posts at that distance the one whose side and direction fit best
    near = np.abs(seen[:, :, 0] - RADIUS - ahead[:, None]) <= 0.15
    same_side = np.sign(seen[:, :, 1]) == np.sign(left)[:, None]
    which = np.where(near & same_side, np.abs(seen[:, :, 1]), np.inf).argmin(axis=1)
    known = (near & same_side).any(axis=1) & (np.abs(left) > 0.05)
    true = seen[np.arange(len(ahead)), which, 1]
    if known.sum() < FEWEST or near.any(axis=1).mean() < 0.9:
        return ""
    share = left[known] / true[known]
    if abs(float(np.median(share)) - 1) <= 0.1 and np.mean(np.abs(share - 1) <= 0.15) >= 0.8:
        return ""
    factors = {
        "": share,
        "it does not grow with the distance, it lacks the factor ahead": share * ahead[known],
        "it is divided by ahead, and must be multiplied by it": share * ahead[known] ** 2,
        "it has the factor ahead twice": share / ahead[known],
    }
    spread = {words: np.abs(factor / np.median(factor) - 1) for words, factor in factors.items()}
    words = min(spread, key=lambda each: spread[each].mean())
    usual = float(np.median(factors[words]))
    if np.mean(spread[words] <= 0.1) < 0.8 or (not words and abs(usual - 1) <= 0.1):
        return ""
    if words:
        return f"ahead is right, left is not: {words}"
    return f"ahead is right, left is {usual:.2f} times the right value: fx, the focal length [pixels], is wrong"


def directed(
    at: tuple[np.ndarray, np.ndarray, np.ndarray], ahead: np.ndarray, left: np.ndarray, places: np.ndarray
) -> np.ndarray:
    """Return which points, shape (n,), lie in the direction of one of the places as seen by the camera."""
    x, y, yaw = at
    camera = np.stack((x + CAMERA_AHEAD * np.cos(yaw), y + CAMERA_AHEAD * np.sin(yaw)), axis=1)
    beside = places - camera[:, None]
    off = np.arctan2(beside[..., 1], beside[..., 0]) - (np.arctan2(left, ahead) + yaw)[:, None]
    return np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi).min(axis=1) <= 0.08


def turns_once(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the robot has truly turned by 360 degrees to the left when the first number comes."""
    expected = f"360 degrees, to {math.degrees(TURN_OFF):.0f}, when the number comes on /red_count"
    first = counted(recording)
    when = first[0] if first else recording.end_ns
    turned = float(np.diff(truth(recording, "yaw", np.array([0, when])))[0])
    if first is None:
        measured = f"no number came; at the end it had turned by {math.degrees(turned):.0f} degrees"
        why = ""
        if turned > 1.5 * FULL_TURN:
            why = misconceptions.on_and_on(recording)
        elif abs(turned) < 0.1:
            why = misconceptions.never_turned(recording)
        return Finding(False, expected, measured, explanation=why, nothing=abs(turned) < 0.1)
    measured = f"when the number came, at {when / 1e9:.2f} s, it had turned by {math.degrees(turned):.0f} degrees"
    passed = abs(turned - FULL_TURN) <= TURN_OFF
    why = "" if passed else why_turned(recording, when, turned) or misconceptions.too_fast(recording, turned)
    return Finding(passed, expected, measured, round(when / 1e9, 3), explanation=why)


def counts_the_posts(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the number of red posts was published, and no other number."""
    red = len(posts(recording, "red")[0])
    first = counted(recording)
    expected = "the number of red posts in the hall"
    if first is None:
        return Finding(False, expected, "no number came on /red_count", gated=True)
    values = recording.signal("topics/red_count/data").values
    number = first[1]
    at = round(first[0] / 1e9, 3)
    if (values == red).all() and len(values) == 1:
        return Finding(True, expected, f"{number}, as there are", at)
    if len(values) > 1:
        measured = f"{len(values)} numbers came, {min(values):g} to {max(values):g}; one is asked for"
        return Finding(False, expected, measured, at, explanation=misconceptions.several_numbers(recording))
    why = ""
    sent = recording.signal("topics/red_post/count")
    sightings = int((sent.times <= first[0]).sum())
    pictures = int((recording.signal("topics/camera/image/count").times <= first[0]).sum())
    turned = float(np.diff(truth(recording, "yaw", np.array([0, first[0]])))[0])
    if number < red and abs(turned) < 0.9 * FULL_TURN:
        why = f"it came when the robot had turned by {math.degrees(turned):.0f} degrees: the rest was not seen yet"
    elif number == len(posts(recording, "blue")[0]) != red and not places_the_posts(recording, parameters).passed:
        why = "that is the number of blue posts"
    elif number > 3 * max(pictures, 1):
        why = "so many are pixels, or columns, of red posts"
    elif abs(number - sightings) <= 2 and sightings > red:
        why = "that is how often a red post was in a picture"
    else:
        placed_right = places_the_posts(recording, parameters).passed
        why = misconceptions.other_count(recording, number, first[0], placed_right)
    if not why and number == red + 1:
        why = "one post was counted twice: perhaps at the start and at the end of the turn, by headings that differ"
    return Finding(False, expected, f"the number was {number}, but {red} red posts stand there", at, explanation=why)


def stops_before_the_post(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the robot stands 1 m before the nearest red post; wrong points, turns or counts explain another stop."""
    found = stopped(recording)
    earlier = (places_the_posts, turns_once, counts_the_posts)
    if found.passed or all(check(recording, parameters).passed for check in earlier):
        return found
    return replace(found, gated=True, explanation="")


def stopped(recording: Recording) -> Finding:
    """Return where and how the robot stands at the end."""
    expected = f"at the end it faces the nearest red post, {STOP:g} m before it (to {STOP_OFF:g} m), and stands still"
    end = np.array([recording.end_ns])
    here = tuple(float(each[0]) for each in pose(recording, end))
    start = tuple(float(each[0]) for each in pose(recording, np.zeros(1)))
    if float(truth(recording, "distance", end)[0]) < 0.1:
        return Finding(False, expected, "the robot did not drive")
    every, names = posts(recording)
    seen = [before_camera(here, place) for place in every]
    faced = [i for i, (ahead, left) in enumerate(seen) if ahead > 0 and abs(math.atan2(left, ahead)) <= FACING]
    faced.sort(key=lambda i: seen[i][0])
    red, red_names = posts(recording, "red")
    wanted = red_names[int(np.argmin(np.linalg.norm(red - np.array(start[:2]), axis=1)))]
    if recording.ended_s < recording.properties("run")["duration"]:
        return Finding(False, expected, f"the simulation ended at {recording.ended_s:.2f} s")
    last = np.array([end[0] - round(STILL * 1e9), end[0]])
    drifted, turning = (float(np.diff(truth(recording, name, last))[0]) for name in ("distance", "yaw"))
    if drifted > 0.03 or abs(turning) > 0.05:
        measured = f"it was still moving at the end: {drifted:.2f} m and {turning:.2f} rad in {STILL:g} s"
        return Finding(False, expected, measured, explanation=stopping.still_moving(recording))
    if not faced:
        why = stopping.faced_nothing(recording, here, start)
        return Finding(False, expected, "it stood and faced no post", explanation=why)
    name = names[faced[0]]
    away = math.hypot(*seen[faced[0]]) - RADIUS
    measured = f"it stood {away:.2f} m before a {name.partition('_')[0]} post"
    if name == wanted:
        passed = abs(away - STOP) <= STOP_OFF
        why = "" if passed else stopping.wrong_stop(recording, away)
        return Finding(passed, expected, measured, explanation=why)
    why = ""
    if name.startswith("blue"):
        why = "it is a blue post: red and blue are swapped (rgb8 and bgr8)"
    elif name.startswith("red"):
        measured += ", which is not the one nearest to the start"
        why = stopping.other_post(recording, name)
    return Finding(False, expected, measured, explanation=why)
