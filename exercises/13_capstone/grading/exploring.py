"""Has the robot seen the rooms, and touched nothing on its way?"""

from __future__ import annotations

from typing import Any

import numpy as np

from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.floor import Scans, grown, hits, scans, shapes
from gz_course.grader.score.true_pose import true_poses

from . import driving
from .checks import (
    FEWEST,
    FREE,
    HEIGHT,
    HITS,
    MAP,
    RESOLUTION,
    WIDTH,
    along,
    cells,
    grid,
    middles,
    no_map,
    walls_are_right,
    why,
)
from .shown import wrongly

MOVED = 0.3  # [m]
MARGIN = 0.003  # [m] between the robot and what it does not touch


def explored(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if so large a share of the rooms was seen and is free in the last map."""
    wanted = parameters["share"]
    expected = f"at least {wanted:.0%} of the free cells of the rooms are seen, and free in the map"
    said, at = grid(recording)
    if said is None:
        return Finding(False, expected, no_map(recording))
    every = scans(recording, at)
    rooms = reachable(recording)
    seen = along(every, 0, every.ends, np.ones_like(every.hit)) > 0
    shown_free = (said >= 0) & (said <= FREE)
    found, there = (seen & shown_free)[rooms].mean(), seen[rooms].mean()
    measured = f"{found:.0%} of {rooms.sum()} cells; the scanner saw {there:.0%}"
    if found >= wanted:
        return Finding(True, expected, measured)
    driven = recording.signal("truth/robot/distance").values.max(initial=0.0)
    turned = np.ptp(recording.signal("truth/robot/yaw").values) if len(recording.signal("truth/robot/yaw")) else 0.0
    words = not_as_it_was_seen(recording, said, every)  # it drives by its map
    if not words and not (said < 0).any():
        words = "no cell of the map is unknown, so nothing is left to explore: what no ray has passed yet is -1, not 0"
    if not words and driven < MOVED:
        words = "the robot never drove" if turned < 0.5 else "the robot turned on the spot and never drove"
        more = driving.stands(recording)
        words += f" ({more})" if more else ": it saw what can be seen from its start"
    elif not words and there < wanted:
        words = driving.slow_or_lost(recording) or driving.standing(recording)
        words = words or "the robot did not come to every corner in time"
    return Finding(False, expected, measured, explanation=words)


def not_as_it_was_seen(recording: Recording, said: np.ndarray, every: Scans) -> str:
    """Return what is wrong with a map by which a robot may drive; empty if it shows what was seen."""
    if not walls_are_right(recording, said):
        return why(recording, said, every)
    hit = cells(hits(every)) > 0
    passed = (along(every, 0, every.ends - 2 * RESOLUTION, every.hit) >= HITS) & ~hit
    if passed.sum() < FEWEST:
        return ""
    return wrongly(recording, said, passed, hit)


def reachable(recording: Recording) -> np.ndarray:
    """Return the cells (80, 100) that are free in truth and connected with the start of the robot."""
    open_cells = (shapes(recording).nearest(middles()) > RESOLUTION).reshape(HEIGHT, WIDTH)
    rooms = grown(grown(cells(true_poses(recording, np.zeros(1))[:, :2]) > 0)) & open_cells
    size = 0
    while rooms.sum() > size:
        size = int(rooms.sum())
        rooms = grown(rooms) & open_cells
    return rooms


def touches_nothing(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the robot, a disc, never came to an obstacle."""
    x, y = recording.signal("truth/robot/x"), recording.signal("truth/robot/y")
    expected = f"the robot's middle stays more than {parameters['radius']:g} m away from everything"
    if not len(x):
        return Finding(False, expected, "the run ended before it began", gated=True)
    distances, names = shapes(recording).distances(np.stack([x.values, y.values], 1))
    least = distances.min(axis=0)
    which, when = int(distances[:, least.argmin()].argmin()), int(least.argmin())
    touching = least < parameters["radius"] + MARGIN
    if not touching.any():
        measured = f"the nearest was {names[which]} at {x.times[when] / 1e9:.1f} s, {least[when]:.2f} m from its middle"
        return Finding(True, expected, measured)
    first = int(np.argmax(touching))
    name, at = names[int(distances[:, first].argmin())], float(x.times[first] / 1e9)
    words = f"the robot ran into {name} at {at:.1f} s, at ({x.values[first]:.1f}, {y.values[first]:.1f})"
    point = driving.nearest_point(shapes(recording), (x.values[first], y.values[first]))
    there = map_at(recording, point, int(x.times[first]))
    words += f"; {driving.touched(recording, parameters['radius'], x.times[first], point, there)}"
    measured = f"it touched something in {touching.sum()} of {len(touching)} moments"
    return Finding(False, expected, measured, round(at, 3), explanation=words)


def map_at(recording: Recording, point: np.ndarray, when: int) -> str:
    """Return what the last map before a time [ns] shows at a point [m]; empty if there is none."""
    number = int(np.sum(recording.arrays(f"{MAP}/data")[0] < when)) - 1
    said, at = grid(recording, number) if number >= 0 else (None, 0.0)
    return driving.in_the_map(said, point, at) if said is not None else ""
