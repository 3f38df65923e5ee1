"""Places of boxes in columns, so that most arrows point to the right and few of them cross.

Four steps: cycles are opened, boxes get columns by the longest way to them, columns are sorted by the mean place of
their neighbours, and heights are chosen as near to the neighbours as the gaps allow.

Source: K. Sugiyama, S. Tagawa, M. Toda, Methods for visual understanding of hierarchical system structures, 1981
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

Arrow = tuple[str, str]
Point = tuple[float, float]
COLUMN_GAP = 70.0  # [px]
ROW_GAP = 16.0  # [px]
_SWEEPS = 8


@dataclass(frozen=True)
class Layout:
    """The upper left corner of each box, the points of each arrow, and the size of all, in [px]."""

    places: dict[str, Point]
    ways: dict[Arrow, list[Point]]
    width: float
    height: float


def layout(sizes: Mapping[str, Point], arrows: Iterable[Arrow]) -> Layout:
    """Return the places of boxes with these widths and heights."""
    wanted = sorted({arrow for arrow in arrows if arrow[0] != arrow[1]})
    forward = _without_cycles(sorted(sizes), wanted)
    column = _columns(sorted(sizes), forward)
    chains = {arrow: _chain(arrow, column) for arrow in sorted(forward)}
    heights: dict[str, float] = {key: size[1] for key, size in sizes.items()}
    neighbours: dict[str, list[str]] = defaultdict(list)
    for chain in chains.values():
        for one, next_one in itertools.pairwise(chain):
            neighbours[one].append(next_one)
            neighbours[next_one].append(one)
        for middle, inner in enumerate(chain[1:-1], 1):
            heights[inner] = 0.0
            column[inner] = column[chain[0]] + middle
    rows: list[list[str]] = [[] for _ in range(max(column.values(), default=-1) + 1)]
    for key in sorted(column):
        rows[column[key]].append(key)
    _sort(rows, neighbours, column)
    centre = _heights(rows, neighbours, heights)
    left = _left_edges(rows, sizes)
    places = {key: (left[column[key]][0], centre[key] - sizes[key][1] / 2) for key in sizes}
    ways = {}
    for arrow in wanted:
        chain = chains.get(arrow) or chains[arrow[1], arrow[0]][::-1]
        ways[arrow] = _way(chain, places, sizes, left, column, centre)
    width = max((x + sizes[key][0] for key, (x, _) in places.items()), default=0.0)
    height = max((y + sizes[key][1] for key, (_, y) in places.items()), default=0.0)
    return Layout(places, ways, width, height)


def _without_cycles(keys: Sequence[str], arrows: Sequence[Arrow]) -> set[Arrow]:
    """Return the arrows, those turned round that would close a cycle."""
    after: dict[str, list[str]] = defaultdict(list)
    for start, end in arrows:
        after[start].append(end)
    incoming = {end for _, end in arrows}
    state: dict[str, int] = {}
    turned: set[Arrow] = set()
    for root in sorted(keys, key=lambda key: (key in incoming, key)):
        stack = [(root, iter(after[root]))] if root not in state else []
        state.setdefault(root, 1)
        while stack:
            key, left = stack[-1]
            following = next(left, None)
            if following is None:
                state[key] = 2
                stack.pop()
            elif state.get(following) == 1:
                turned.add((key, following))
            elif following not in state:
                state[following] = 1
                stack.append((following, iter(after[following])))
    return {(end, start) if (start, end) in turned else (start, end) for start, end in arrows}


def _columns(keys: Sequence[str], forward: set[Arrow]) -> dict[str, int]:
    """Return the column of each box: the longest way to it; what nothing leads to stands right before its first end."""
    before: dict[str, list[str]] = defaultdict(list)
    after: dict[str, list[str]] = defaultdict(list)
    for start, end in sorted(forward):
        before[end].append(start)
        after[start].append(end)
    missing = {key: len(before[key]) for key in keys}
    ready = [key for key in keys if not missing[key]]
    column = dict.fromkeys(keys, 0)
    for key in ready:  # grows meanwhile
        for end in after[key]:
            column[end] = max(column[end], column[key] + 1)
            missing[end] -= 1
            if not missing[end]:
                ready.append(end)
    for key in keys:
        if not before[key] and after[key]:
            column[key] = min(column[end] for end in after[key]) - 1
    return column


def _chain(arrow: Arrow, column: Mapping[str, int]) -> list[str]:
    """Return the boxes of an arrow with a place in each column between them."""
    start, end = arrow
    between = range(column[start] + 1, column[end])
    return [start, *(f"\0{start}\0{end}\0{number}" for number in between), end]


def _sort(rows: list[list[str]], neighbours: Mapping[str, list[str]], column: Mapping[str, int]) -> None:
    """Sort each column by the mean place of the neighbours in the column before, then in the one after, and again."""
    for sweep in range(_SWEEPS):
        step = 1 if sweep % 2 == 0 else -1
        order = range(len(rows)) if step == 1 else reversed(range(len(rows)))
        for number in order:
            if not 0 <= number - step < len(rows):
                continue
            place = {key: index for index, key in enumerate(rows[number - step])}
            now = {key: index for index, key in enumerate(rows[number])}
            mean = {}
            for key in rows[number]:
                beside = [place[each] for each in neighbours.get(key, []) if column[each] == number - step]
                mean[key] = sum(beside) / len(beside) if beside else now[key]
            rows[number].sort(key=lambda key: (mean[key], now[key]))


def _heights(
    rows: Sequence[Sequence[str]], neighbours: Mapping[str, list[str]], heights: Mapping[str, float]
) -> dict[str, float]:
    """Return the height of each box's centre."""
    centre: dict[str, float] = {}
    for row in rows:
        y = 0.0
        for key in row:
            centre[key] = y + heights[key] / 2
            y += heights[key] + ROW_GAP
    for sweep in range(_SWEEPS):
        for row in rows if sweep % 2 == 0 else rows[::-1]:
            wish = []
            for key in row:
                beside = [centre[each] for each in neighbours.get(key, [])]
                wish.append(sum(beside) / len(beside) if beside else centre[key])
            for key, y in zip(row, _apart(wish, [heights[key] for key in row]), strict=True):
                centre[key] = y
    top = min((centre[key] - heights[key] / 2 for row in rows for key in row), default=0.0)
    return {key: y - top for key, y in centre.items()}


def _apart(wish: Sequence[float], heights: Sequence[float]) -> list[float]:
    """Return the values nearest to `wish` (least squares) that keep the order and the gaps of boxes."""
    offset = [0.0]
    for above, below in itertools.pairwise(heights):
        offset.append(offset[-1] + (above + below) / 2 + ROW_GAP)
    blocks: list[tuple[float, int]] = []  # sum, number
    for value, start in zip(wish, offset, strict=False):
        total, number = value - start, 1
        while blocks and blocks[-1][0] / blocks[-1][1] >= total / number:
            total, number = total + blocks[-1][0], number + blocks[-1][1]
            blocks.pop()
        blocks.append((total, number))
    level = [total / number for total, number in blocks for _ in range(number)]
    return [value + start for value, start in zip(level, offset, strict=False)]


def _left_edges(rows: Sequence[Sequence[str]], sizes: Mapping[str, Point]) -> list[tuple[float, float]]:
    """Return the left edge and the width of each column."""
    edges = []
    x = 0.0
    for row in rows:
        width = max((sizes[key][0] for key in row if key in sizes), default=0.0)
        edges.append((x, width))
        x += width + COLUMN_GAP
    return edges


def _way(
    chain: Sequence[str],
    places: Mapping[str, Point],
    sizes: Mapping[str, Point],
    left: Sequence[tuple[float, float]],
    column: Mapping[str, int],
    centre: Mapping[str, float],
) -> list[Point]:
    """Return the points of an arrow, from the side of one box through the columns to the side of the other."""
    rightwards = column[chain[0]] < column[chain[-1]]
    points = []
    for key in (chain[0], *chain[1:-1], chain[-1]):
        if key in sizes:
            outer = (key == chain[0]) == rightwards
            points.append((places[key][0] + (sizes[key][0] if outer else 0.0), centre[key]))
        else:
            x, width = left[column[key]]
            points += [(x, centre[key]), (x + width, centre[key])][:: 1 if rightwards else -1]
    return points
