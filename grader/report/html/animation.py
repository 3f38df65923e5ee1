"""The run as an animation: what `animation.js` needs to move the robot in a drawing of `from_above.py`.

The data are numbers only. Each shape is sent once, as corners in the frame of its link; each link's motion is sent as
the two rows of its transformation that a view from above needs, and the script draws the outline of what they give.
"""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup

from gz_course.grader.record.bodies import placed, rotation
from gz_course.grader.record.reading import Poses
from gz_course.grader.report.html.from_above import FAR, Map

SCRIPT = Path(__file__).with_name("animation.js").read_text(encoding="ascii")
# The page's policy allows this script by its hash, and no other.
POLICY = f"'sha256-{base64.b64encode(hashlib.sha256(SCRIPT.encode()).digest()).decode()}'"

RATE = 25  # [1/s] frames of a second of simulated time
MOST_FRAMES = 750  # of a run; a longer one has fewer of them in a second
MOST_SCANS, MOST_DOTS, MOST_LIDARS = 150, 120, 4  # of a run, of a scan, of a world
MOST_LINKS = 100  # that move
MOST_ROWS = 15_000  # frames of all links together, which keeps a page below 2 MB
MOST_CORNERS = 64  # of a shape; more make no visible difference


def animation(drawn: Map, end: float, width: int) -> Markup:
    """Return the motion of a run of `end` [s] as JSON, for the drawing of `Map.draw` that is `width` pixels wide."""
    links = min(len({body.entity.rpartition("/")[0] for body in drawn.moving}), MOST_LINKS)
    count = min(max(round(end * RATE), 1), MOST_FRAMES, MOST_ROWS // max(links, 1)) + 1
    times = np.linspace(0, end * 1e9, count).astype(np.int64)
    view = drawn.view
    data = {
        "end": end,
        "count": count,
        "scale": width / (view.right - view.left),
        "left": view.left,
        "top": view.top,
        **_shapes(drawn, times),
        "robot": _robot(drawn, times),
        "scans": _scans(drawn, end, width / (view.right - view.left)),
    }
    return Markup(json.dumps(data, separators=(",", ":"), allow_nan=False))


def _shapes(drawn: Map, times: np.ndarray) -> dict[str, Any]:
    """Return each moving body as (number of its link, corners), in drawing order, and the motion of the links."""
    links: dict[str, list[float]] = {}
    shapes = []
    for body in drawn.moving:
        key = body.entity
        if drawn.recording.poses(key) is None:  # it has no pose of its own: it moves with its link
            key = key.rpartition("/")[0]
        if key not in links and len(links) < MOST_LINKS:
            links[key] = _motion(body.chain, times)
        if key in links:
            shapes.append([list(links).index(key), _numbers(_hull(body.corners), 3)])
    return {"links": list(links.values()), "shapes": shapes}


def _motion(chain: Sequence[Poses], times: np.ndarray) -> list[float]:
    """Return eight numbers for each time: two rows of the rotation, then x and y [m]; one set if nothing moves."""
    turn, shift = np.broadcast_to(np.eye(3), (len(times), 3, 3)), np.zeros((len(times), 3))
    for poses in chain:
        at = np.maximum(np.searchsorted(poses.times, times, side="right") - 1, 0)
        shift = shift + (turn @ poses.positions[at][:, :, None])[:, :, 0]
        kept, row = np.unique(at, return_inverse=True)
        turn = turn @ np.stack([rotation(quaternion) for quaternion in poses.quaternions[kept]])[row]
    rows = np.concatenate([turn[:, :2].reshape(-1, 6), shift[:, :2]], axis=1)
    return _numbers(rows[:1] if (rows == rows[0]).all() else rows, 3)


def _hull(corners: np.ndarray) -> np.ndarray:
    """Return the corners that are farthest out in one of many directions: an outline needs no others."""
    if len(corners) <= MOST_CORNERS:
        return corners
    step = np.arange(MOST_CORNERS) + 0.5
    tilt, turn = np.arccos(1 - 2 * step / MOST_CORNERS), np.pi * (1 + 5**0.5) * step  # evenly over the sphere
    directions = np.stack([np.cos(turn) * np.sin(tilt), np.sin(turn) * np.sin(tilt), np.cos(tilt)])
    return np.asarray(corners[np.unique(np.argmax(corners @ directions, axis=0))])


def _robot(drawn: Map, times: np.ndarray) -> list[float]:
    """Return x, y [m] and heading [rad] of the robot for each time; nothing if they were not recorded."""
    columns = []
    for name in ("x", "y", "yaw"):
        signal = drawn.recording.signal(f"truth/{drawn.robot}/{name}")
        if not len(signal):
            return []
        columns.append(signal.values[np.maximum(np.searchsorted(signal.times, times, side="right") - 1, 0)])
    return _numbers(np.stack(columns, axis=1), 3)


def _scans(drawn: Map, end: float, scale: float) -> list[dict[str, Any]]:
    """Return what each lidar saw: the time [s] of every other scan, and its dots [pixels]."""
    found = []
    for entity, chain in drawn.scans[:MOST_LIDARS]:
        at: list[float] = []
        dots: list[list[float]] = []
        for time in np.linspace(0, end, min(round(end * 10), MOST_SCANS) + 1):
            now = round(time * 1e9)
            cloud = drawn.recording.points_at(entity, now)
            cloud = placed(cloud[:: len(cloud) // MOST_DOTS + 1], chain, now)
            pixels = np.stack([cloud[:, 0] - drawn.view.left, drawn.view.top - cloud[:, 1]], axis=1) * scale
            at.append(round(float(time), 3))
            dots.append([int(v) for v in _numbers(pixels, 0)])
        found.append({"at": at, "dots": dots})
    return found


def _numbers(values: np.ndarray, places: int) -> list[float]:
    """Return numbers that JSON can hold, rounded to decimal places."""
    kept = np.nan_to_num(values, nan=FAR, posinf=FAR, neginf=-FAR)
    flat: list[float] = np.round(np.clip(kept, -FAR, FAR), places).ravel().tolist()
    return flat
