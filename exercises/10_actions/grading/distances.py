"""What the distances of the feedback are, if not those from the robot to the waypoint."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from .patrol_run import Run

FEWEST = 5  # messages
CLOSE = 0.05  # [m]


def other_distance(run: Run, said: list[Any], points: list[Any]) -> str:
    """Return what else the distances of the feedback are; empty if that is not known."""
    given = np.array([each["distance"] for each in said])
    for words, values in other_feedback(run, said, points):
        if np.mean(np.abs(values - given) <= 0.15 * max(1.0, np.abs(given).max() / 4)) >= 0.9:
            return f"Your distance is {words}; it should be how far it is to the waypoint of the feedback"
    if (given < 0).mean() > 0.5:
        return "Your distance is negative: it is how far it is to the waypoint of the feedback, hypot(dx, dy)"
    return ""


def _closely(run: Run, said: list[Any], points: list[Any]) -> str:
    """Return what else the distances are to a few centimetres; empty if nothing fits, or they hardly change."""
    given = np.array([each["distance"] for each in said])
    if np.ptp(given) < 0.3:
        return ""
    for words, values in other_feedback(run, said, points):
        if np.mean(np.abs(values - given) <= CLOSE * max(1.0, np.abs(given).max() / 4)) >= 0.9:
            return words
    return ""


def believed(run: Run, goal: str) -> str:
    """Return what a server that misses a waypoint takes for its distance; empty if nothing else fits closely."""
    points = np.array(run.waypoints(goal), dtype=float)
    said = [each for each in run.all("feedback", goal) if 0 <= each["waypoint"] < len(points)]
    if len(said) < FEWEST:
        return ""
    way = run.way[np.searchsorted(run.times, [each["at"] for each in said]).clip(0, len(run.times) - 1)]
    left = np.hypot(*(way - points[[each["waypoint"] for each in said]]).T)
    wrong = np.abs(left - [each["distance"] for each in said]) > 2 * CLOSE
    if wrong.mean() > 0.3 and (words := _closely(run, said, points.tolist())):
        return f"The robot misses a waypoint, and the distance that your server says is {words}"
    return ""


def by_reckoning(run: Run, goal: str) -> str:
    """Find out whether the distances of the feedback go to 0 without the robot, and what they are instead."""
    said, points = run.all("feedback", goal), np.array(run.waypoints(goal), dtype=float)
    said = [each for each in said if 0 <= each["waypoint"] < len(points)]
    if len(said) < FEWEST:
        return ""
    if words := _closely(run, said, points.tolist()):
        return f"A waypoint counts as reached where the robot is not: the distance of your server is {words}"
    way = run.way[np.searchsorted(run.times, [each["at"] for each in said]).clip(0, len(run.times) - 1)]
    index, given = np.array([each["waypoint"] for each in said]), np.array([each["distance"] for each in said])
    left = np.hypot(*(way - points[index]).T)
    lasts = [np.flatnonzero(index == each)[-1] for each in set(index.tolist())]
    if all(given[i] < 0.2 for i in lasts) and max(left[i] - given[i] for i in lasts) > 0.1:
        return (
            f"Your server takes a waypoint for reached that is still {max(left[i] for i in lasts):.2f} m away, where "
            f"its own distance says {min(given[i] for i in lasts):.2f} m: either its distance is computed wrongly, or "
            "it counts time or steps, and does not look where /odom says that the robot is"
        )
    return ""


def other_feedback(run: Run, said: list[Any], points: list[Any]) -> Iterator[tuple[str, np.ndarray]]:
    """Yield what else distances may be: words, and the values they would have."""
    places = np.searchsorted(run.times, [each["at"] for each in said]).clip(0, len(run.times) - 1)
    way, index = run.way[places], np.array([each["waypoint"] for each in said])
    steps = np.hypot(*np.diff(run.way, axis=0, prepend=run.way[:1]).T)
    targets = np.array(points)

    def to(numbers: np.ndarray) -> np.ndarray:
        return np.hypot(*(way - targets[np.clip(numbers, 0, len(targets) - 1)]).T)

    here = targets[np.clip(index, 0, len(targets) - 1)] - way
    following = np.hypot(*np.diff(targets, axis=0).T)
    first = np.array([np.argmax(index == each) for each in index])
    yield "how far the robot is from where it started", np.hypot(*way.T)
    yield "how far the robot has driven", np.cumsum(steps)[places] - np.cumsum(steps)[places[0]]
    yield "how far it is to the last waypoint", to(np.full(len(index), len(targets)))
    yield "how far it is to the next waypoint but one", to(index + 1)
    yield "how far it is to the waypoint before, or always to the first one", to(index - 1)
    yield "the whole way that is left, over all waypoints", to(index) + [following[i:].sum() for i in index.clip(0)]
    yield "the square of how far it is: the square root is missing", to(index) ** 2
    yield "the sum of the distances along x and y, and not hypot(dx, dy)", np.abs(here).sum(axis=1)
    yield "how far it is along x alone", np.abs(here[:, 0])
    yield "how far it is along y alone", np.abs(here[:, 1])
    yield "how far it is in centimetres", 100 * to(index)
    for words, whole in (("rounded to", np.round), ("cut to", np.trunc)):
        yield f"how far it is, {words} whole metres", whole(to(index))
        place = here + way
        yield f"how far it is to its coordinates {words} whole metres", np.hypot(*(whole(place) - way).T)
        yield f"how far it is from the place of the robot, {words} whole metres", np.hypot(*(place - whole(way)).T)
    yield (
        "how far it was when the robot set off to this waypoint: compute it again in every iteration",
        to(index)[first],
    )
    yield "how far the robot has come since the waypoint before", to(index)[first] - to(index)
    yield "the length of the whole leg less itself, or always 0", np.zeros(len(index))
