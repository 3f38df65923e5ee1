"""Is the last map on /map a map of the rooms, and has the robot seen them without touching anything?

The truth is computed from the shapes of the world in the recording, from the simulator's poses of the robot, and from
the scans as they were sent. Wrong maps are compared with those of common misconceptions; `driving.py` knows more.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import hypot
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check import Finding
from gz_course.grader.score.floor import Grid, Scans, grown, hits, misplaced, scans, shapes

from . import arrangements, lags, map_faults, rivals

RESOLUTION, WIDTH, HEIGHT, LEFT, BOTTOM = 0.1, 100, 80, -5.0, -4.0  # [m], [cells], [cells], [m], [m]
GRID = Grid(RESOLUTION, WIDTH, HEIGHT, LEFT, BOTTOM)
cells, middles, along = GRID.cells, GRID.middles, GRID.along
# From Nav2's map server, as shares: https://docs.nav2.org/configuration/packages/configuring-map-server.html
OCCUPIED, FREE = 65, 25  # at least, at most
OFF = 0.15  # [m] from the middle of an occupied cell to an obstacle: one cell, and half a cell for its middle
HITS = 3  # of the scanner, in one cell, that make it a wall which the map must show
WALLS, TRUE, SEEN, NEVER_SEEN = 0.9, 0.92, 0.9, 0.05  # shares of cells
FEWEST = 30  # cells; fewer say nothing about a map
FITS = 0.8  # of the occupied cells, to fit a misconception
EARLY = 0.5  # of the occupied cells of the first map that the scanner had not hit yet: the map was known before
LATE = 0.5  # [s] before the last map; what was scanned later need not be in it
MAP = "topics/map"


def info(recording: Recording, name: str) -> float:
    """Return the last value of a field of `info`; NaN if there is none."""
    values = recording.signal(f"{MAP}/info/{name}").values
    return float(values[-1]) if len(values) else float("nan")


def grid(recording: Recording, number: int = -1) -> tuple[np.ndarray | None, float]:
    """Return a map as the cells of the task (80, 100), and when it came [s]; no map if there is none that can be read.

    A map with as many cells as asked for is read as the task says. Another one is read by its own layout.
    """
    times, rows = recording.arrays(f"{MAP}/data")
    if not len(rows):
        return None, 0.0
    data, at = np.asarray(rows[number]), float(times[number] / 1e9)
    width, height, size = info(recording, "width"), info(recording, "height"), info(recording, "resolution")
    if len(data) == WIDTH * HEIGHT and (width == WIDTH or width * height != len(data)):
        return data.reshape(HEIGHT, WIDTH), at
    if not (width * height == len(data) and size > 0):
        return None, at
    origin = [info(recording, f"origin/position/{axis}") for axis in "xy"]
    place = np.clip(np.floor((middles() - origin) / size), -1, 1e6).astype(int)
    inside = (place[:, 0] >= 0) & (place[:, 0] < width) & (place[:, 1] >= 0) & (place[:, 1] < height)
    out = np.full(WIDTH * HEIGHT, -1.0)
    out[inside] = data[place[inside, 1] * int(width) + place[inside, 0]]
    return out.reshape(HEIGHT, WIDTH), at


def no_map(recording: Recording) -> str:
    """Return why there is no map that can be read."""
    if not recording.has(f"{MAP}/count"):
        return "no map was published"
    number = len((recording.arrays(f"{MAP}/data")[1] or [np.zeros(0)])[-1])
    size = f"{info(recording, 'width'):g} x {info(recording, 'height'):g}"
    if not number and info(recording, "width") * info(recording, "height") > WIDTH * HEIGHT:
        return f"info of the last map says {size} cells; so long a list is not recorded"
    return f"data of the last map had {number} numbers, and info says {size} cells"


def layout(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if frame, resolution, size, origin and the number of cells are those of the task."""
    expected = "frame odom, 100 x 80 cells of 0.1 m, origin (-5, -4) with orientation.w 1, 8000 numbers"
    if not recording.has(f"{MAP}/info/width"):
        return Finding(False, expected, "no map was published")
    width, height, size = info(recording, "width"), info(recording, "height"), info(recording, "resolution")
    x, y, w = (info(recording, f"origin/{n}") for n in ("position/x", "position/y", "orientation/w"))
    number = len((recording.arrays(f"{MAP}/data")[1] or [np.zeros(0)])[-1])
    frames = [line.text for line in recording.lines(f"{MAP}/header/frame_id")]
    frame = frames[-1] if frames else ""
    seen = f"frame {shown(frame, 40)!r}, {width:g} x {height:g} cells of {size:.3g} m, origin ({x:g}, {y:g})"
    seen += f" with orientation.w {w:g}, {number} numbers"
    right = {
        f"frame_id is {shown(frame, 40)!r}": frame == "odom",
        "width and height are exchanged": (width, height) != (HEIGHT, WIDTH),
        f"info says {width:g} x {height:g} cells": (width, height) in ((WIDTH, HEIGHT), (HEIGHT, WIDTH)),
        f"info.resolution is {size:g}, but a cell is 0.1 m wide": abs(size - RESOLUTION) < 1e-4,
        f"info.origin is ({x:g}, {y:g}), {map_faults.other_origin(x, y, GRID)}": hypot(x - LEFT, y - BOTTOM) < 1e-3,
        "the orientation of info.origin is not (0, 0, 0, 1)": abs(w - 1) < 1e-3,
        f"data has {number} numbers": number == WIDTH * HEIGHT,
    }
    wrong = [words for words, holds in right.items() if not holds]
    return Finding(not wrong, expected, seen, explanation="; ".join(wrong))


def walls(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the cells that the scanner has hit are occupied in the last map, or a cell beside them is."""
    expected = f"{WALLS:.0%} of the cells that the scanner hit are occupied, to one cell"
    said, at = grid(recording)
    if said is None:
        return Finding(False, expected, no_map(recording))
    scan = scans(recording, at - LATE)
    wanted = cells(hits(scan)) >= HITS
    if wanted.sum() < FEWEST:
        return Finding(False, expected, "the scanner hit nothing before the last map came")
    share = float(grown(said >= OCCUPIED)[wanted].mean())
    measured = f"{share:.0%} of {wanted.sum()} cells with hits are occupied"
    if share >= WALLS:
        return Finding(True, expected, measured)
    words = why(recording, said, scan) or behind_hits(recording, said, scans(recording, at))
    if not (words or layout(recording, parameters).explanation or known_before(recording)):
        maps = recording.arrays(f"{MAP}/data")
        words = (
            map_faults.unclear(said, wanted)
            or map_faults.unchanged(*maps)
            or suspect(recording, "threshold", "erased", "heading", "angle")
            or map_faults.walls_missing(said, wanted, earlier_walls(recording), suspect(recording, "forgets", "fades"))
        )
    return Finding(False, expected, measured, round(at, 3), explanation=words)


def earlier_walls(recording: Recording) -> np.ndarray | None:
    """Return which cells were occupied in one of the earlier maps; None if there are few."""
    numbers = range(2, len(recording.arrays(f"{MAP}/data")[0]) - 1, 3)
    maps = [said for number in numbers if (said := grid(recording, number)[0]) is not None]
    return np.any([said >= OCCUPIED for said in maps], axis=0) if len(maps) > 2 else None


def no_ghosts(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if the occupied cells of the last map are at obstacles."""
    expected = f"{TRUE:.0%} of the occupied cells are at an obstacle, to one cell"
    said, at = grid(recording)
    if said is None:
        return Finding(False, expected, no_map(recording))
    marked = said >= OCCUPIED
    if marked.sum() < FEWEST:
        words = why(recording, said, scans(recording, at))
        return Finding(False, expected, f"{marked.sum()} cells are occupied", round(at, 3), explanation=words)
    share = float((shapes(recording).nearest(middles()[marked.ravel()]) <= OFF).mean())
    measured = f"{share:.0%} of {marked.sum()} occupied cells are at an obstacle"
    words = why(recording, said, scans(recording, at)) if share < TRUE else ""
    if not words and (early := known_before(recording)):
        return Finding(False, expected, early[0], early[1], explanation=early[2])
    if share >= TRUE:
        return Finding(True, expected, measured)
    return Finding(False, expected, measured, round(at, 3), explanation=words)


def known_before(recording: Recording) -> tuple[str, float, str] | None:
    """Return what was measured, when [s], and why it is wrong, if the first map shows walls before they were hit.

    Walls that do stand there are forgiven: only other rooms show that they were known by heart.
    """
    for said, at in with_walls(recording):
        hit = cells(hits(scans(recording, at))) > 0
        marked = said >= OCCUPIED
        new = float((~grown(grown(hit)))[marked].mean())
        real = float((shapes(recording).nearest(middles()[marked.ravel()]) <= OFF).mean())
        # What is drawn in a wrong place has as many cells as were hit.
        if new <= EARLY or real > EARLY or marked.sum() < 2 * hit.sum():
            return None
        words = "the map shows walls that the scanner had not seen, and they do not stand here: draw it from the scans"
        return f"{new:.0%} of the {marked.sum()} occupied cells of the map at {at:.1f} s", round(at, 3), words
    return None


def free(recording: Recording, parameters: dict[str, Any]) -> Finding:
    """Pass if what rays have passed is free in the last map, hardly anything else is, and unknown is -1."""
    expected = (
        f"{SEEN:.0%} of the cells that rays passed are free, and at most {NEVER_SEEN:.0%} of the free ones are others, "
        "and unknown is -1"
    )
    said, at = grid(recording)
    if said is None:
        return Finding(False, expected, no_map(recording))
    marked = (said >= 0) & (said <= FREE)
    before, every = scans(recording, at - LATE), scans(recording, at)
    hit = cells(hits(every)) > 0
    passed = (along(before, 0, before.ends - 2 * RESOLUTION, before.hit) >= HITS) & ~hit
    seen = ever_seen(every)
    if passed.sum() < FEWEST:
        return Finding(False, expected, "the scanner saw nothing before the last map came")
    share, other = float(marked[passed].mean()), float((~seen)[marked].mean()) if marked.any() else 0.0
    measured = (
        f"{share:.0%} of {passed.sum()} cells that rays passed are free; {other:.0%} of your {marked.sum()} free "
    )
    measured += "cells were never seen"
    words = arrangements.other_unknown(said, seen)
    if share >= SEEN and other <= NEVER_SEEN and not words:
        return Finding(True, expected, measured)
    if words:
        return Finding(False, expected, measured, round(at, 3), explanation=words)
    if not marked.any():
        words = "no cell is free, only the hits are drawn: the cells between the robot and a hit are free"
    elif not (said < 0).any():
        words = "no cell is unknown: what no ray has passed yet is -1, not 0"
    elif other > NEVER_SEEN and walls_are_right(recording, said):
        words = behind_hits(recording, said, every)
    elif share < SEEN and said[passed & ~marked].max(initial=-1) > FREE:
        words = map_faults.thick(recording, said, hit) or f"cells that rays passed have values above {FREE}"
    if not words and share < SEEN:
        fitting = (
            each for each, changed in arrangements.rearranged(marked) if changed[passed].mean() >= FITS > share + 0.2
        )
        words = next((f"your walls are right, but of your free cells {each}" for each in fitting), "")
    if not words and share < SEEN:
        ways = (along(before, 0, before.ends - 2 * RESOLUTION, which) >= HITS for which in (before.hit, ~before.hit))
        words = suspect(recording, "threshold") or map_faults.not_free(said, *(way & ~hit for way in ways))
    return Finding(False, expected, measured, round(at, 3), explanation=words)


def ever_seen(every: Scans) -> np.ndarray:
    """Return the cells, to one cell, that any ray has passed or hit."""
    return grown(along(every, 0, every.ends, np.ones_like(every.hit)) > 0)


def behind_hits(recording: Recording, said: np.ndarray, every: Scans) -> str:
    """Return that cells behind the hits are free, if most of the free cells that were never seen are there."""
    unseen = (said >= 0) & (said <= FREE) & ~ever_seen(every)
    behind = grown(along(every, every.ends, every.ends + 2, every.hit) > 0)
    if unseen.sum() < FEWEST or not walls_are_right(recording, said) or behind[unseen].mean() < FITS:
        return ""
    return "cells behind the hits are free: a ray says nothing about what is behind its hit"


def walls_are_right(recording: Recording, said: np.ndarray) -> bool:
    """Return whether the occupied cells of a map, if there are any, are at obstacles."""
    marked = (said >= OCCUPIED).ravel()
    return not marked.any() or (shapes(recording).nearest(middles()[marked]) <= OFF).mean() >= FITS


def why(recording: Recording, said: np.ndarray, scan: Scans) -> str:
    """Return the misconception that fits the occupied cells of a wrong map; empty if none does."""
    marked = said >= OCCUPIED
    solid = (shapes(recording).nearest(middles()) <= OFF).reshape(HEIGHT, WIDTH)
    hit = cells(hits(scan)) >= HITS

    def fits(cells_of_walls: Any) -> Any:
        """Say whether a map is right: its walls stand there, and they are those that were hit."""
        number = cells_of_walls.sum()
        return number >= FEWEST and solid[cells_of_walls].mean() >= FITS and grown(cells_of_walls)[hit].mean() >= FITS

    if words := arrangements.wrong_values(said, fits):
        return words
    if marked.sum() < FEWEST:
        drawn = said != np.median(said)
        for words, changed in arrangements.scaled(np.concatenate([hits(scan), scan.pose[:, :2]])):
            if drawn.any() and grown(changed)[drawn].mean() > FITS and changed.sum() < 0.5 * hit.sum():
                return words
        return map_faults.hardly_any(
            recording, said, [np.asarray(row) for row in recording.arrays(f"{MAP}/data")[1]], hit
        )
    for words, changed in arrangements.rearranged(marked):
        if fits(changed):
            return words
    off_x, off_y = info(recording, "origin/position/x") - LEFT, info(recording, "origin/position/y") - BOTTOM
    for words, changed in (
        *arrangements.shifted(marked),
        *map_faults.by_own_origin(marked, off_x / RESOLUTION, off_y / RESOLUTION),
    ):
        if changed.sum() >= FEWEST and solid[changed].mean() >= FITS > solid[marked].mean():
            return words
    for words, changed in arrangements.moved(marked, solid, scan.pose[0]):
        if solid[changed].mean() >= TRUE > 0.85 > solid[marked].mean():
            return words
    words = map_faults.thick(recording, said, hit) or drawn_elsewhere(recording)
    if words := words or suspect(recording, "counter", "pose", "stride"):
        return words
    return first_arcs(recording, solid) or lags.drawn_late(said, marked, solid, scan)


def first_arcs(recording: Recording, solid: np.ndarray) -> str:
    """Return that the first map with walls has them where rays without a hit end; empty if it has not."""
    for said, at in with_walls(recording):
        scan = scans(recording, at)
        return arrangements.arcs(said >= OCCUPIED, solid, cells(hits(scan, which=~scan.hit)) > 0, said)
    return ""


def drawn_elsewhere(recording: Recording) -> str:
    """Return the mistake with pose or angles by which the first map with walls was drawn; empty if none fits."""

    def compared(said: np.ndarray, at: float) -> tuple[np.ndarray, np.ndarray, Iterator[Any]]:
        scan = scans(recording, at)
        return said >= OCCUPIED, cells(hits(scan)) > 0, ((each, cells(points) > 0) for each, points in misplaced(scan))

    words = rivals.best(compared(said, at) for said, at in with_walls(recording))
    return (("heading" in words or "pose is" in words) and suspect(recording, "heading")) or words


def with_walls(recording: Recording) -> Iterator[tuple[np.ndarray, float]]:
    """Yield each map that has walls, and when it came [s]."""
    for number in range(len(recording.arrays(f"{MAP}/data")[0])):
        said, at = grid(recording, number)
        if said is not None and (said >= OCCUPIED).sum() >= FEWEST:
            yield said, at
