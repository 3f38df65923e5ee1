"""The cells that the reader of chapter 13 writes."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from gz_course.grader.lessons.step import Tried, expect, step

SCAN, MAP = "sensor_msgs/msg/LaserScan", "nav_msgs/msg/OccupancyGrid"
SIZE, LEFT, BOTTOM = 0.2, -4.0, -3.0  # [m] of the chapter's grid
OCCUPIED = 65  # at least
DRIVER_WALLS = (-2.0, 3.0, -2.0, 2.0)  # [m] west, east, south, north
FLOORS = (  # s start, g goal, # wall
    "#########|#s....#.#|#.####.g#|#......##|#...##..#|#..g....#|#########",
    "#########|#s#..g..#|#.......#|#.......#|#..g....#|#.......#|#########",
    "#########|#s..#..g#|#...#...#|#...#...#|#...#...#|#...#...#|#########",
)
STEPS = (6, 5, 0)  # to the nearest goal of each floor


@step("hit_points", objective=1)
def hit_points(tried: Tried) -> str:
    """hit_points(pose, scan) is where the hits of a scan are."""
    function = tried.function("hit_points")
    scan, pose = tried.heard("/scan", SCAN)[0], tried.poses("robot")[-1]
    ranges = np.array(scan.ranges)
    angles = pose.yaw + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    hit = (ranges > scan.range_min) & (ranges < scan.range_max)
    wanted = np.stack([pose.x + ranges[hit] * np.cos(angles[hit]), pose.y + ranges[hit] * np.sin(angles[hit])])
    said = function((pose.x, pose.y, pose.yaw), scan)
    two = isinstance(said, tuple | list | np.ndarray) and len(said) == 2
    expect(two, f"hit_points returns a {type(said).__name__}; two lists are wanted, x and y.")
    count = len(said[0])
    expect(count == hit.sum(), f"It returns {count} points; {hit.sum()} of {len(ranges)} rays hit something.")
    points = np.array(said, dtype=float)
    there = f"the first hit is at ({points[0, 0]:z.2f}, {points[1, 0]:z.2f}) m"
    right = f"({wanted[0, 0]:z.2f}, {wanted[1, 0]:z.2f})"
    expect(np.allclose(points, wanted, atol=0.01), f"For a scan of this world {there}; {right} is wanted.")
    return f"{count} rays of a scan of this world have hit something, and {there}."


def _cell(x: float, y: float) -> tuple[int, int]:
    return math.floor((y - BOTTOM) / SIZE), math.floor((x - LEFT) / SIZE)


@step("passed_cells", objective=1)
def passed_cells(tried: Tried) -> str:
    """passed_cells(x, y, angle, distance) are the cells on the way of a ray, without that of its hit."""
    function, total = tried.function("passed_cells"), 0
    for x, y, angle, distance in ((0.1, 0.1, 0.0, 1.5), (-2.53, 1.71, -1.1, 2.4), (0.45, -0.62, 2.5, 0.9)):
        ways = np.arange(0.0, distance, 0.002)
        points = zip(x + ways * math.cos(angle), y + ways * math.sin(angle), strict=True)
        lengths: dict[tuple[int, int], float] = {}
        for each in points:
            lengths[_cell(*each)] = lengths.get(_cell(*each), 0.0) + 0.002
        end = _cell(x + distance * math.cos(angle), y + distance * math.sin(angle))
        lengths.pop(end, None)
        said = {(int(row), int(column)) for row, column in function(x, y, angle, distance)}
        ray = f"For a ray of {distance:g} m from ({x}, {y}), at {angle:g} rad,"
        expect(end not in said, f"{ray} the cell of the hit is among them.")
        false = sorted(said - lengths.keys())
        expect(not false, f"{ray} it returns (row, column) {false and false[0]}, which that ray does not pass.")
        missing = sorted(cell for cell, length in lengths.items() if length > 0.6 * SIZE and cell not in said)
        expect(not missing, f"{ray} the cell (row, column) {missing and missing[0]} is missing.")
        total += len(said)
    return f"Three rays pass {total} cells, and each of them is right."


@step("index_of", objective=2)
def index_of(tried: Tried) -> str:
    """index_of(x, y, info) is the place of a point's cell in the data of a map."""
    MapMetaData = tried.message_type("nav_msgs/msg/MapMetaData")
    function = tried.function("index_of")
    for size, width, height, left, bottom in ((0.2, 40, 30, -4.0, -3.0), (0.1, 100, 80, -5.0, -4.0)):
        info: Any = MapMetaData(resolution=size, width=width, height=height)
        info.origin.position.x, info.origin.position.y = left, bottom
        for x, y in ((left + 0.03, bottom + 0.03), (1.27, -0.56), (-2.15, 1.98)):
            column, row = math.floor((x - left) / size), math.floor((y - bottom) / size)
            said, wanted = function(x, y, info), row * width + column
            where = f"({x:z.2f}, {y:z.2f}) m in a map of {width} x {height} cells of {size} m"
            expect(said == wanted, f"For {where} it says {said}; {wanted} is wanted, row {row} and column {column}.")
    return "In two maps with different sizes, each point has its place in `data`."


@step("way_to", objective=3)
def way_to(tried: Tried) -> str:
    """way_to(open_cells, goals, start) is the shortest way to the nearest goal."""
    function = tried.function("way_to")
    for floor, steps in zip(FLOORS, STEPS, strict=True):
        marks = np.array([list(row) for row in floor.split("|")])
        open_cells, goals = marks != "#", marks == "g"
        row, column = np.argwhere(marks == "s")[0]
        start = (int(row), int(column))
        if not steps:
            goals = goals & False
        said = function(open_cells, goals, start)
        expect(said is not None, "It returns None; a list of cells is wanted, and an empty one if there is no way.")
        way = [(int(each[0]), int(each[1])) for each in said]
        if not steps:
            expect(not way, f"No goal can be reached, and it returns a way of {len(way)} cells.")
            continue
        expect(way, "It returns no way, and there is one.")
        expect(way[0] == start, f"The way begins at {way[0]}; {start} is the start.")
        closed = [cell for cell in way if not open_cells[cell]]
        expect(not closed, f"The way leads through {closed and closed[0]}, which is not open.")
        for one, two in itertools.pairwise(way):
            beside = abs(one[0] - two[0]) + abs(one[1] - two[1]) == 1
            expect(beside, f"From {one} to {two} is no step to a cell beside it.")
        expect(goals[way[-1]], f"The way ends at {way[-1]}, which is no goal.")
        expect(len(way) == steps + 1, f"The way has {len(way)} cells; the shortest has {steps + 1}.")
    return "On each floor the way is the shortest, and where there is none, it says so."


@step("with_driver", objective=4)
def with_driver(tried: Tried) -> str:
    """The driver and the node run without a simulator, and maps come."""
    try:
        there = tried.publishers("/scan")
        expect(there, "Nobody publishes /scan.")
        others = [name for name in there if name != "driver"]
        expect(not others, f"{others and others[0]} publishes /scan; without a simulator, driver.py does.")
        said = tried.heard("/map", MAP, count=2, deadline=12.0)[-1]
    finally:
        tried.stop("python3")
        tried.stop("ros2 run ros_gz_bridge")
    data = np.array(said.data).reshape(said.info.height, said.info.width)
    rows, columns = np.nonzero(data >= OCCUPIED)
    x, y = LEFT + SIZE * (columns + 0.5), BOTTOM + SIZE * (rows + 0.5)
    west, east, south, north = DRIVER_WALLS
    near = np.min([abs(x - west), abs(x - east), abs(y - south), abs(y - north)], axis=0) < 1.5 * SIZE
    expect(
        len(x) and near.mean() > 0.7, f"The map has {len(x)} occupied cells, and they are not at the driver's walls."
    )
    return f"Maps come, and their {len(x)} occupied cells are the walls of the driver's room."
