"""Common mistakes with the place and the value of a cell, and the map as it is without each, for `checks.py`."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from gz_course.grader.score.floor import Grid, grown

RESOLUTION, WIDTH, HEIGHT, LEFT, BOTTOM = 0.1, 100, 80, -5.0, -4.0  # [m], [cells], [cells], [m], [m]
OCCUPIED, FREE = 65, 25  # at least, at most
GRID = Grid(RESOLUTION, WIDTH, HEIGHT, LEFT, BOTTOM)


def rearranged(marked: np.ndarray) -> Iterator[Any]:
    """Yield common mistakes with rows and columns, and the map as it is without each."""
    data = marked.ravel()
    yield "rows and columns are exchanged: the place in data is row * width + column", data.reshape(WIDTH, HEIGHT).T
    yield "rows and columns are exchanged: the place in data is row * width + column", transposed(marked)
    yield "the y axis points down: the first row has the lowest y", marked[::-1]
    yield "the x axis points backwards: within a row x grows", marked[:, ::-1]
    yield "both axes are reversed: the first cell has the lowest x and y", marked[::-1, ::-1]
    yield "rows have the wrong length: the place in data is row * width + column, with width 100", strided(data)


def shifted(marked: np.ndarray) -> Iterator[Any]:
    """Yield mistakes with the origin, and what can be seen of the map without each."""
    shift = round(-BOTTOM / RESOLUTION), round(-LEFT / RESOLUTION)
    quadrant = np.zeros_like(marked)
    quadrant[shift[0] :, shift[1] :] = marked[: HEIGHT - shift[0], : WIDTH - shift[1]]
    words = "the origin is ignored: the cell of a point is (point - origin) / resolution"
    yield words, quadrant
    yield words, np.roll(marked, shift, (0, 1))


def transposed(marked: np.ndarray) -> np.ndarray:
    """Return a map as it is if x had been taken for the row: cells [x, y], as far as both are in the map."""
    out = np.zeros_like(marked)
    out[:, :HEIGHT] = marked[:, :HEIGHT].T
    return out


def strided(data: np.ndarray) -> np.ndarray:
    """Return a map as it is if the length of a row had been taken for 80."""
    row, column = np.divmod(np.arange(len(data)), WIDTH)
    place = np.minimum(row * HEIGHT + column, len(data) - 1)
    return data[place].reshape(HEIGHT, WIDTH)


def wrong_values(said: np.ndarray, fits: Callable[[np.ndarray], bool]) -> str:
    """Return what is wrong with the numbers in a map whose walls are in the right places; empty if nothing is."""
    most = said.max()
    if 0 < most < OCCUPIED and fits(said == most):
        return f"the walls of your map have the value {most:g}: an occupied cell is 100"
    if fits((said >= 0) & (said <= FREE)):
        return "occupied and free are exchanged: 100 is occupied, 0 is free"
    if most <= 0 and fits(said < 0):
        return "the walls of your map have the value -1, which is unknown: an occupied cell is 100"
    return ""


def other_unknown(said: np.ndarray, seen: np.ndarray) -> str:
    """Return that most cells that no ray has touched hold a number that means nothing, such as 50; else nothing."""
    values = said[~seen]
    other = values[(values != -1) & ((values < 0) | (values > FREE) & (values < OCCUPIED))]
    if len(other) <= 0.5 * len(values):
        return ""
    return f"unknown cells hold {np.median(other):g}: in an OccupancyGrid the number for unknown is -1"


def moved(
    marked: np.ndarray, solid: np.ndarray, start: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Iterator[tuple[str, np.ndarray]]:
    """Yield by how many cells the walls of a map are beside those that stand there, and the map without it.

    `start` (x, y, heading) is the first pose of the robot: a map that is moved by it was drawn from the start.
    """
    x, y = best_shift(marked, solid)
    if not x and not y:
        return
    words = (
        f"all walls of your map are about {x} cells too far along x and {y} along y: the column of a point is "
        "floor((x + 5) / 0.1), its row floor((y + 4) / 0.1)"
    )
    if max(abs(x + start[0] / RESOLUTION), abs(y + start[1] / RESOLUTION)) < 1.6 and abs(x) + abs(y) > 4:
        words = (
            f"all walls of your map are about {x} cells too far along x and {y} along y, which is where they are seen "
            f"from the robot's start, ({start[0]:.1f}, {start[1]:.1f}): the first position is subtracted, or positions "
            "are counted from 0, but /odom is in the frame odom already"
        )
    out = np.zeros_like(marked)
    rows, columns = np.nonzero(marked)
    inside = (rows >= y) & (rows < HEIGHT + y) & (columns >= x) & (columns < WIDTH + x)
    out[rows[inside] - y, columns[inside] - x] = True
    yield words, out


def best_shift(marked: np.ndarray, solid: np.ndarray) -> tuple[int, int]:
    """Return by how many cells (x, y) a map must be moved back to have most of its walls where walls are."""
    size = (2 * HEIGHT, 2 * WIDTH)
    spectrum = np.fft.rfft2(marked, size) * np.conj(np.fft.rfft2(solid, size))
    counts = np.roll(np.fft.irfft2(spectrum, size), (HEIGHT, WIDTH), axis=(0, 1))
    rows, columns = np.mgrid[-HEIGHT:HEIGHT, -WIDTH:WIDTH]
    near = np.round(counts) - 1e-3 * (np.abs(rows) + np.abs(columns))
    row, column = np.unravel_index(int(near.argmax()), near.shape)
    return int(column) - WIDTH, int(row) - HEIGHT


def arcs(marked: np.ndarray, solid: np.ndarray, ends: np.ndarray, said: np.ndarray) -> str:
    """Return that the ends of rays without a hit are drawn as walls; empty if they are not.

    Such ends lie nearly everywhere after a while: they must explain the wrong cells, and not the free ones as well.
    """
    wrong, wide = marked & ~solid, grown(ends)
    free = (said >= 0) & (said <= FREE) & ~solid
    if wrong.sum() < 15 or wide[wrong].mean() < 0.8:
        return ""
    if (free.any() and wide[free].mean() > wide[wrong].mean() - 0.2) or marked[ends & ~solid].mean() < 0.2:
        return ""
    return "rays without a hit are drawn as walls at range_max: inf is no hit"


def scaled(points: np.ndarray) -> Iterator[tuple[str, np.ndarray]]:
    """Yield mistakes in which metres are turned into cells by another factor, and the cells (80, 100) they draw."""
    corner = np.array([LEFT, BOTTOM])
    for factor, words in (
        (RESOLUTION, "the distance from the origin is multiplied by the resolution: divide by it"),
        (1.0, "metres are taken for cells: divide the distance from the origin by the resolution"),
        (100.0, "metres are turned into centimetres, not into cells: divide by the resolution, 0.1 m"),
    ):
        yield words, GRID.cells(corner + (points - corner) * factor * RESOLUTION) > 0
