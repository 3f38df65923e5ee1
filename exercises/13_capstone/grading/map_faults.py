"""What is wrong with what a map shows of what was seen; `checks.py` asks for it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.floor import Grid, grown

from .driving import FITS


def other_origin(x: float, y: float, grid: Grid) -> str:
    """Return what an origin [m] is instead of the corner of the first cell of a grid."""
    left, bottom, half = grid.left, grid.bottom, grid.resolution / 2
    right = f"the corner of the first cell is at ({left:g}, {bottom:g})"
    for (other_x, other_y), words in (
        ((left / grid.resolution, bottom / grid.resolution), "which is in cells; in metres "),
        ((0.0, 0.0), "so it is not set, or the corner is taken for the middle; "),
        ((-left, -bottom), "which is the opposite corner; "),
        ((bottom, left), "x and y are exchanged; "),
        ((left + half, bottom + half), "which is the middle of the first cell; "),
    ):
        if np.hypot(x - other_x, y - other_y) < 1e-3:
            return words + right
    return right


def unchanged(times: np.ndarray, maps: list[np.ndarray]) -> str:
    """Return since when all maps that came [ns] are the same; empty if one of the second half differs."""
    same = next((n for n in range(len(maps) - 1, 0, -1) if not np.array_equal(maps[n], maps[n - 1])), 0)
    if len(maps) < 6 or same > 0.5 * len(maps):
        return ""
    return (
        f"no cell of the map has changed since {times[same] / 1e9:.1f} s: scans that came later are not drawn, so the "
        "line that draws a scan stands behind a condition that no longer holds, or its result is not what is published"
    )


def hardly_any(recording: Recording, said: np.ndarray, maps: list[np.ndarray], hit: np.ndarray | None = None) -> str:
    """Return what is odd about a map with hardly any walls, given all maps that came, and the cells that were hit."""
    if forgotten := suspect(recording, "forgets"):
        return forgotten
    if len(maps) > 3 and all(np.array_equal(maps[0], each) for each in maps):
        kind = "all cells are unknown" if (said < 0).all() else f"{(said >= 65).sum()} cells are occupied"
        return (
            f"all {len(maps)} maps are the same, {kind}: data is made once and published again and again, so nothing "
            "that is scanned gets into it; make new data for each publish()"
        )
    shown = said[hit] if hit is not None else np.empty(0)
    if len(shown) >= 30 and ((shown >= 0) & (shown <= 25)).mean() > 0.5:
        return (
            "hardly any cell is occupied, and most walls that were hit are free: rays make the cells in which they end "
            "free again; leave the last cell of a ray out of its way, or let a hit count for more than many passes"
        )
    return "hardly any cell is occupied"


def by_own_origin(marked: np.ndarray, columns: Any, rows: Any) -> Iterator[Any]:
    """Yield the map as it is if it was drawn for its own info.origin, which is off by so many cells."""
    if 0 < abs(columns) + abs(rows) < 60:
        words = "info.origin is not the corner that is asked for, and the cells are drawn for it: it is (-5, -4)"
        yield words, np.roll(marked, (round(rows), round(columns)), (0, 1))


def unclear(said: np.ndarray, wanted: np.ndarray) -> str:
    """Return what the walls are if they are neither occupied nor free: values in between; empty if they are not."""
    values = said[grown(wanted)]
    between = (values > 25) & (values < 65)
    if between.sum() < 30 or (grown(between_map(said))[wanted]).mean() < 0.3:
        return ""
    return (
        f"many walls have values between 26 and 64, such as {np.median(values[between]):.0f}, which are neither free "
        "nor occupied: decide for 0 or 100 where a hit was seen"
    )


def between_map(said: np.ndarray) -> np.ndarray:
    return (said > 25) & (said < 65)


def walls_missing(said: np.ndarray, wanted: np.ndarray, before: np.ndarray | None, said_of: str = "") -> str:
    """Return why walls that were hit are not in the map `said`, given where any earlier map had walls, or None."""
    values = said[wanted]
    if before is not None:
        lost = before & ~grown(said >= 65)
        if lost.sum() >= 20 and lost.sum() > 0.2 * before.sum():
            if not said_of and ((said[lost] >= 0) & (said[lost] <= 25)).mean() > 0.6:
                return (
                    "walls that were in earlier maps are free in the last one: rays that pass a cell, or end in it, "
                    "make it free again; a hit must count for more than they do"
                )
            words = said_of or "what was seen once must stay in the map, so add each scan to what is known"
            return f"walls that were in earlier maps are gone: {words}"
    if ((values >= 0) & (values <= 25)).mean() > 0.4:
        return (
            "many walls that were hit are free in the map: a ray that ends in a cell, or grazes it, makes it free "
            "again; the hit counts more than the rays that pass"
        )
    if (values < 0).mean() > 0.4:
        return "many walls that were hit are unknown in the map: hits of most rays, or of most scans, are left out"
    return ""


def not_free(said: np.ndarray, by_hits: np.ndarray, by_others: np.ndarray) -> str:
    """Return why cells that rays passed are not free: those of rays with a hit, and those of rays without one only."""
    unknown = said < 0
    others = by_others & ~by_hits
    if others.sum() >= 50 and unknown[others].mean() > FITS and unknown[by_hits].mean() < 0.3:
        return (
            "only rays with a hit make cells free: a ray of inf has hit nothing within range_max, so all cells on its "
            "way are free, too"
        )
    share = unknown[by_hits].mean() if by_hits.any() else 0.0
    if share > 0.3:
        beside = grown(~unknown & (said <= 25))
        if beside[by_hits].mean() > share and (beside & by_hits & unknown).sum() > 0.6 * (by_hits & unknown).sum():
            return (
                f"{share:.0%} of the cells on the rays are unknown between cells that are free: the steps along a ray "
                "are larger than a cell; half a cell is a good step"
            )
        return f"{share:.0%} of the cells that rays passed are still unknown: most rays, or most scans, are left out"
    return ""


def thick(recording: Recording, said: np.ndarray, hit: np.ndarray) -> str:
    """Return by how many cells the walls of a map are widened around what was hit; empty if they are not."""
    marked = said >= 65
    if hit.sum() < 30 or marked.sum() < 2 * hit.sum():
        return ""
    for cells in range(6, 1, -1):
        inside, outside = widened(hit, cells), widened(hit, cells + 1.6)
        if marked[inside].mean() > 0.9 and outside[marked].mean() > 0.9:
            where = suspect(recording, "alias")
            where = f" ({where})" if where else ""
            return (
                f"the walls of your map are about {cells} cells thicker on every side than what was hit, as they are "
                f"for planning a way: widen a copy, and publish the map as it was seen{where}"
            )
    return ""


def widened(cells: np.ndarray, by: float) -> np.ndarray:
    """Return the cells at most `by` cells away from those that are set."""
    out, most = cells.copy(), int(by)
    for row in range(-most, most + 1):
        for column in range(-most, most + 1):
            if row * row + column * column <= by * by:
                out |= np.roll(cells, (row, column), axis=(0, 1))
    return out
