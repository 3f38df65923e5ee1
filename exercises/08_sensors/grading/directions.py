"""What wrong points are made of: another line through the columns, lengths of rays, points of earlier pictures.

`misconceptions.py` asks for it. The cameras of the hall are 160 pixels wide, and see 1.2 rad.
"""

from __future__ import annotations

import math

import numpy as np

from gz_course.grader.record.reading import Recording

from . import hall

WIDTH = 160
FOCAL_LENGTH, MIDDLE = WIDTH / 2 / math.tan(0.6), WIDTH / 2  # [pixels]: k[0] and k[2] of camera_info
RADIUS = 0.12  # [m] of a post
FEWEST = 10  # points
NUMBERS = {
    MIDDLE: "cx = k[2]", FOCAL_LENGTH: "fx = k[0]", WIDTH: "the width", 0.75 * WIDTH: "the height",
    0.375 * WIDTH: "half of the height",
}  # fmt: skip


def other_line(seen: np.ndarray, ahead: np.ndarray, left: np.ndarray) -> str:
    """Return from which column, and by which focal length, `left` was made if `ahead` is right; empty if neither fits.

    `seen` holds the posts (n, m, 2) as (ahead, left) [m] of the camera when each point (n,) was stamped.
    """
    wide = np.abs(np.arctan2(seen[:, :, 1], seen[:, :, 0])) < 0.7
    near = wide & (np.abs(seen[:, :, 0] - RADIUS - ahead[:, None]) <= 0.15)
    known = (near.sum(axis=1) == 1) & (ahead > 0.3)
    if known.sum() < FEWEST or known.mean() < 0.6:
        return ""
    there = seen[np.arange(len(ahead)), near.argmax(axis=1)][known]
    true, said = there[:, 1] / there[:, 0], (left / np.maximum(ahead, 0.3))[known]
    if np.ptp(true) < 0.3:
        return ""
    slope, offset = np.polyfit(true, said, 1)
    off = np.median(np.abs(said - slope * true - offset))
    if off < 0.03 and abs(slope) > 0.05 and (abs(slope - 1) > 0.1 or abs(offset) > 0.06):
        divisor = FOCAL_LENGTH / slope
        column = MIDDLE + offset * divisor
        return (
            f"ahead is right, left is not: it is about -(column - {_named(column)}) / {_named(divisor)} * ahead; it "
            f"must be -(column - cx) / fx * ahead, with cx = k[2] = {MIDDLE:.0f} and fx = k[0] = {FOCAL_LENGTH:.0f}"
        )
    times = np.median((np.arctan(said) / np.arctan(true))[np.abs(true) > 0.1])
    if abs(times - 1) > 0.1 and np.median(np.abs(np.arctan(said) - times * np.arctan(true))) < 0.04:
        return (
            f"ahead is right, left is not: the angle of each column is {times:.2f} times the right one; left is "
            f"-(column - cx) / fx * ahead, with cx = k[2] = {MIDDLE:.0f} and fx = k[0] = {FOCAL_LENGTH:.0f}"
        )
    return ""


def always_the_same(ahead: np.ndarray, left: np.ndarray) -> str:
    """Return whether all points lie in one direction, wherever the posts are; empty if they do not."""
    shares = left / np.maximum(ahead, 0.3)
    low, middle, high = np.percentile(shares, (10, 50, 90)) if len(shares) >= FEWEST else (-1.0, 0.0, 1.0)
    if high - low > 0.04 or abs(middle) < 0.01:
        return ""
    rows = abs(middle - (MIDDLE - 0.375 * WIDTH) / FOCAL_LENGTH) < 0.04
    return (
        f"point.y is {middle:.2f} times point.x in all points, wherever the post is: the column does not count in it"
        + (", and that is what the middle row gives: an array is [row, column]" if rows else "")
    )


def _named(number: float) -> str:
    """Return a number of pixels, and what else is as large."""
    found = [words for known, words in NUMBERS.items() if abs(number - known) <= 0.03 * known]
    return f"{number:.0f}" + (f" ({found[0]})" if found else "")


def of_rays(seen: np.ndarray, ahead: np.ndarray, left: np.ndarray) -> str:
    """Return whether depths were taken for the lengths of rays, or lengths of rays made of them; empty if neither."""
    off = np.arctan2(seen[:, :, 1], seen[:, :, 0]) - np.arctan2(left, ahead)[:, None]
    which, rows = np.abs(off).argmin(axis=1), np.arange(len(ahead))
    there = seen[rows, which]
    angles = np.arctan2(there[:, 1], there[:, 0])
    known = (np.abs(off[rows, which]) < 0.06) & (there[:, 0] > 0.3) & (np.abs(angles) > 0.25)
    if known.sum() < FEWEST / 2:
        return ""
    share, cosines = ahead[known] / (there[known, 0] - 0.85 * RADIUS), np.cos(angles[known])
    as_it_should = np.abs(share - 1)
    for made, words in (
        (cosines, "multiplied by the cosine of the bearing, as if it were the length of the ray"),
        (1 / cosines, "divided by the cosine of the bearing, as if the length of the ray were asked for"),
    ):
        wrong = np.abs(share - made)
        if np.median(wrong) < 0.03 and np.median(wrong) < 0.5 * np.median(as_it_should):
            return (
                f"the directions are right, but posts at the edges of the picture are {share.mean():.2f} times as far "
                f"ahead as they should be: the depth was {words}; it is the distance ahead already, so "
                "point.x = depth and point.y = -(column - cx) / fx * depth"
            )
    return ""


def said_again(points: np.ndarray, stamps: np.ndarray) -> str:
    """Return whether points of earlier pictures came again with later stamps; empty if not."""
    first: dict[tuple[float, ...], int] = {}
    again = 0
    for point, stamp in zip(points[:, :2].tolist(), stamps.tolist(), strict=True):
        again += first.setdefault(tuple(point), stamp) != stamp
    if again < FEWEST or again < 0.3 * len(points):
        return ""
    return (
        f"{again} of the {len(points)} points were sent before, with the stamp of an earlier picture: what was found "
        "in a picture is still in the list when the next one comes; empty the list for each picture"
    )


def one_a_picture(recording: Recording, there: np.ndarray, stamps: np.ndarray) -> str:
    """Return whether points (n, 2) [m] of the hall are of one post only where a picture shows two or more.

    Posts count that are surely in the picture, in directions that are far enough apart, and pictures that have a point.
    """
    red, every, lost = hall.posts(recording, "red")[0], hall.posts(recording)[0], []
    for stamp in np.unique(stamps):
        at = tuple(float(each[0]) for each in hall.pose(recording, np.array([stamp])))
        seen, others = (np.array([hall.before_camera(at, each) for each in some]) for some in (red, every))
        angles, before = (np.arctan2(each[:, 1], each[:, 0]) for each in (seen, others))
        hidden = (np.abs(before - angles[:, None]) < 0.2) & (others[:, 0] < seen[:, :1] - 0.1) & (others[:, 0] > 0)
        shown = (np.abs(angles) < 0.45) & (seen[:, 0] > 0.3) & (seen[:, 0] < 3.2) & ~hidden.any(axis=1)
        if shown.sum() < 2 or np.diff(np.sort(angles[shown])).min() < 0.2:
            continue
        found = [hall.hits(there[stamps == stamp], place[None]).any() for place in red[shown]]
        lost.append(sum(found) < len(found))
    if len(lost) < 2 or np.mean(np.array(lost)) < 0.8:
        return ""
    return (
        f"in {sum(lost)} of the {len(lost)} pictures that show several red posts, not each of them got a point: a "
        "point is asked for each red post in each pair of pictures"
    )
