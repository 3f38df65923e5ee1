"""Common mistakes with the place and the value of a cell, and the map as it is without each, for `checks.py`."""

import numpy as np

from gz_course.grader.score.floor import Grid

RESOLUTION, WIDTH, HEIGHT, LEFT, BOTTOM = 0.1, 100, 80, -5.0, -4.0  # [m], [cells], [cells], [m], [m]
OCCUPIED, FREE = 65, 25  # at least, at most
GRID = Grid(RESOLUTION, WIDTH, HEIGHT, LEFT, BOTTOM)


def rearranged(marked):
    """Yield common mistakes with rows and columns, and the map as it is without each."""
    data = marked.ravel()
    yield "rows and columns are exchanged: the place in data is row * width + column", data.reshape(WIDTH, HEIGHT).T
    yield "rows and columns are exchanged: the place in data is row * width + column", transposed(marked)
    yield "the y axis points down: the first row has the lowest y", marked[::-1]
    yield "the x axis points backwards: within a row x grows", marked[:, ::-1]
    yield "both axes are reversed: the first cell has the lowest x and y", marked[::-1, ::-1]
    yield "rows have the wrong length: the place in data is row * width + column, with width 100", strided(data)


def shifted(marked):
    """Yield mistakes with the origin, and what can be seen of the map without each."""
    shift = round(-BOTTOM / RESOLUTION), round(-LEFT / RESOLUTION)
    quadrant = np.zeros_like(marked)
    quadrant[shift[0] :, shift[1] :] = marked[: HEIGHT - shift[0], : WIDTH - shift[1]]
    words = "the origin is ignored: the cell of a point is (point - origin) / resolution"
    yield words, quadrant
    yield words, np.roll(marked, shift, (0, 1))


def transposed(marked):
    """Return a map as it is if x had been taken for the row: cells [x, y], as far as both are in the map."""
    out = np.zeros_like(marked)
    out[:, :HEIGHT] = marked[:, :HEIGHT].T
    return out


def strided(data):
    """Return a map as it is if the length of a row had been taken for 80."""
    row, column = np.divmod(np.arange(len(data)), WIDTH)
    place = np.minimum(row * HEIGHT + column, len(data) - 1)
    return data[place].reshape(HEIGHT, WIDTH)


def wrong_values(said, fits):
    """Return what is wrong with the numbers in a map whose walls are in the right places; empty if nothing is."""
    most = said.max()
    if 0 < most < OCCUPIED and fits(said == most):
        return f"the walls of your map have the value {most:g}: an occupied cell is 100"
    if fits((said >= 0) & (said <= FREE)):
        return "occupied and free are exchanged: 100 is occupied, 0 is free"
    if most <= 0 and fits(said < 0):
        return "the walls of your map have the value -1, which is unknown: an occupied cell is 100"
    return ""


def moved(marked, solid):
    """Yield by how many cells the walls of a map are beside those that stand there, and the map without it."""
    shifts = [(x, y) for x in range(-4, 5) for y in range(-4, 5) if x or y]
    x, y = max(
        shifts, key=lambda by: (solid[np.roll(marked, (-by[1], -by[0]), (0, 1))].mean(), -abs(by[0]) - abs(by[1]))
    )
    yield (
        (
            f"all walls of your map are about {x} cells too far along x and {y} along y: the column of a point is "
            "floor((x + 5) / 0.1), its row floor((y + 4) / 0.1)"
        ),
        np.roll(marked, (-y, -x), (0, 1)),
    )


def scaled(points):
    """Yield mistakes in which metres are turned into cells by another factor, and the cells (80, 100) they draw."""
    corner = np.array([LEFT, BOTTOM])
    for factor, words in (
        (RESOLUTION, "the distance from the origin is multiplied by the resolution: divide by it"),
        (1.0, "metres are taken for cells: divide the distance from the origin by the resolution"),
        (100.0, "metres are turned into centimetres, not into cells: divide by the resolution, 0.1 m"),
    ):
        yield words, GRID.cells(corner + (points - corner) * factor * RESOLUTION) > 0
