"""The hall: its posts, where the robot truly was, and where the points lie that a node has said."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gz_course.grader.record.reading import Recording

HALL = (4.0, 3.0)  # [m] the posts with |x| and |y| below these are in the hall
CAMERA_AHEAD = 0.12  # [m] of the camera before the robot's frame
RADIUS = 0.12  # [m] of a post
SAME_PLACE = 0.5  # [m] nearer points are of one post
MOST_PLACES = 30
NEAR = 0.25  # [m] a point this near to the middle of a post is right
FEWEST = 10  # points
FARTHEST = 1e6  # [m] points farther away count as this far
FULL_TURN, TURN_OFF = 2 * math.pi, 0.16  # [rad]
STOP = 1.0  # [m] from the depth camera to the post


def posts(recording: Recording, colour: str = "") -> tuple[np.ndarray, list[str]]:
    """Return the places (n, 2) [m] of the posts in the hall whose names begin with a colour, and their names."""
    found = []
    for entity in recording.entities("world", "Transform3D:translation"):
        name = entity.removeprefix("world/")
        if "/" in name or not name.startswith(colour) or name.startswith(("robot", "wall", "ground", "sun")):
            continue
        poses = recording.poses(entity)
        assert poses is not None, entity
        x, y = poses.positions[0][:2]
        if abs(x) < HALL[0] and abs(y) < HALL[1]:
            found.append((name, (x, y)))
    return np.array([place for _, place in found]).reshape(-1, 2), [name for name, _ in found]


def truth(recording: Recording, name: str, times: np.ndarray) -> np.ndarray:
    """Return values of the robot's true state at times [ns]; zeros if the run ended before its first tick."""
    signal = recording.signal(f"truth/robot/{name}")
    if not len(signal):
        return np.zeros(len(times))
    index = np.searchsorted(signal.times, times, side="right") - 1
    return signal.values[np.maximum(index, 0)]


def pose(recording: Recording, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return truth(recording, "x", times), truth(recording, "y", times), truth(recording, "yaw", times)


def placed(at: Sequence[np.ndarray], ahead: np.ndarray, left: np.ndarray) -> np.ndarray:
    """Return points (n, 2) [m] of the hall from those before the camera; `at` is the pose of the robot."""
    x, y, yaw = at
    ahead = ahead + CAMERA_AHEAD
    return np.stack(
        (x + ahead * np.cos(yaw) - left * np.sin(yaw), y + ahead * np.sin(yaw) + left * np.cos(yaw)), axis=1
    )


def hits(points: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return which points, shape (n,), lie at one of the places."""
    if not len(points) or not len(places):
        return np.zeros(len(points), dtype=bool)
    return np.linalg.norm(points[:, None] - places, axis=2).min(axis=1) <= NEAR


def said_points(recording: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the points on /red_post, shape (n, 3) [m], with their stamps [ns] and when they came [ns]."""
    parts = [recording.signal(f"topics/red_post/point/{axis}") for axis in "xyz"]
    stamps = np.round(recording.signal("topics/red_post/header/stamp").values * 1e9)
    came = parts[0].times
    # A point that was not finite has a stamp only.
    stamps = stamps[np.isin(recording.signal("topics/red_post/header/stamp").times, came)][: len(came)]
    points = np.clip(np.stack([part.values for part in parts], axis=1), -FARTHEST, FARTHEST)
    return points, stamps.astype(np.int64), came


def before_camera(at: Sequence[float], place: Sequence[float] | np.ndarray) -> tuple[float, float]:
    """Return a place of the hall as (ahead, left) [m] of the camera."""
    x, y, yaw = at
    dx, dy = place[0] - x, place[1] - y
    return dx * math.cos(yaw) + dy * math.sin(yaw) - CAMERA_AHEAD, dy * math.cos(yaw) - dx * math.sin(yaw)


def counted(recording: Recording) -> tuple[int, int] | None:
    """Return the first message on /red_count: its time [ns] and its number; None if there is none."""
    signal = recording.signal("topics/red_count/data")
    return (int(signal.times[0]), int(signal.values[0])) if len(signal) else None


def found_if(recording: Recording, when: int, factor: float) -> int:
    """Return how many places the points until a time [ns] make if they are turned by `factor` times the heading."""
    points, stamps, came = said_points(recording)
    x, y, yaw = pose(recording, stamps)
    before = came <= when
    places: list[np.ndarray] = []
    for place in placed((x, y, factor * yaw), points[:, 0], points[:, 1])[before]:
        if all(np.linalg.norm(place - other) > SAME_PLACE for other in places):
            places.append(place)
        if len(places) > MOST_PLACES:
            break
    return len(places)
