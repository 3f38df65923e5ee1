"""Suspects in where a robot aims, in what is widened before a way is planned, and in rays by their number."""

import ast

import pytest

from gz_course.grader.feedback.suspects.planning import aims, kept_ways, maps
from gz_course.grader.feedback.suspects.sensing import rays
from gz_course.grader.feedback.suspects.steering import headings


def said(look, text):
    return [words for _, _, words in look(ast.parse(text))]


@pytest.mark.parametrize(
    ("error", "more", "number"),
    [
        ("wrap(atan2(gy - self.y, gx - self.x))", "", 1),
        ("wrap(atan2(gy - self.y, gx - self.x) - self.yaw)", "", 0),
        ("atan2(gy - self.y, gx - self.x)", "error = wrap(error - self.yaw)", 0),
        ("atan2(gy - self.y, gx - self.x)", "error -= self.yaw", 0),
        ("atan2(dy, dx)", "", 0),
    ],
)
def test_a_direction_of_which_no_heading_is_taken_off(error, more, number):
    text = f"def drive(self):\n    error = {error}\n    {more or 'pass'}\n    command.angular.z = 2.0 * error\n"
    assert len(said(aims.without_heading, text)) == number


@pytest.mark.parametrize(
    ("test", "first", "other", "number"),
    [
        ("abs(error) < 0.5", "c.angular.z = 1.0", "c.linear.x = 0.4", 1),
        ("abs(error) > 0.5", "c.linear.x = 0.4", "c.angular.z = 1.0", 1),
        ("abs(error) > 0.5", "c.angular.z = 1.0", "c.linear.x = 0.4", 0),
        ("abs(error) < 0.5", "c.linear.x = 0.4", "c.angular.z = 1.0", 0),
        ("abs(distance) < 0.5", "c.angular.z = 1.0", "c.linear.x = 0.4", 0),
    ],
)
def test_a_robot_that_drives_while_the_error_is_large(test, first, other, number):
    assert len(said(aims.other_branch, f"if {test}:\n    {first}\nelse:\n    {other}\n")) == number


@pytest.mark.parametrize(
    ("call", "number"),
    [("hypot(x - pose.y, y - pose.x)", 1), ("hypot(x - pose.x, y - pose.y)", 0), ("hypot(goal_y - y, goal_x - x)", 0)],
)
def test_y_that_is_subtracted_from_x(call, number):
    assert len(said(aims.crossed, f"d = {call}")) == number


@pytest.mark.parametrize(("place", "number"), [("(col + 0.5) * RES", 1), ("LEFT + (col + 0.5) * RES", 0)])
def test_a_place_without_the_corner(place, number):
    text = f"def cell(x):\n    return (x - LEFT) / RES\ndef place(col):\n    return {place}\n"
    assert len(said(aims.without_corner, text)) == number


@pytest.mark.parametrize(("test", "number"), [("grid[c] != 0", 1), ("grid[c] == 100", 0)])
def test_what_is_unknown_is_widened(test, number):
    text = f"""
kind = OccupancyGrid
def widened(grid):
    if {test}:
        for dy in range(-R, R + 1):
            for dx in range(-R, R + 1):
                out.add((dy, dx))
"""
    assert len(said(kept_ways.widened_unknown, text)) == number


@pytest.mark.parametrize(("given", "number"), [("100, 80", 1), ("", 0)])
def test_a_map_of_an_own_class_that_is_made_anew(given, number):
    text = f"""
class GridMap:
    pass
class Mapper:
    def __init__(self):
        self.grid = GridMap({given})
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
    def on_scan(self, scan):
        self.grid = GridMap({given})
        self.grid.insert(scan)
"""
    assert len(said(maps.forgets, text)) == number


def test_rays_of_a_list_with_another_name():
    assert len(said(rays.by_number, "r = list(scan.ranges)\nfront = min(r[:10])\n")) == 1
    assert not said(rays.by_number, "r = list(scan.ranges)\nfront = r[i]\n")


def test_an_angle_of_a_scan_with_a_name_is_no_number_of_degrees():
    text = "angle = scan.angle_min\nbeam = heading + math.radians(angle)\n"
    assert len(said(headings.degrees_for_radians, text)) == 1
    text = "angle = math.degrees(scan.angle_min)\nbeam = heading + math.radians(angle)\n"
    assert not said(headings.degrees_for_radians, text)


@pytest.mark.parametrize(
    ("test", "number"),
    [("self.passes > 60", 1), ("60 <= self.n_hit[c]", 1), ("self.passes > 2", 0), ("len(self.hits) > 60", 0)],
)
def test_a_cell_that_must_be_seen_many_times(test, number):
    assert len(said(maps.many_observations, f"kind = OccupancyGrid\nshown = {test}\n")) == number
