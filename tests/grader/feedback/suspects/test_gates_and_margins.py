"""Suspects in planning that ends for ever, in margins, places of cells, and poses that are made."""

import ast

import pytest

from gz_course.grader.feedback.suspects import ROOM
from gz_course.grader.feedback.suspects.memory import flags
from gz_course.grader.feedback.suspects.planning import aims, cells, kept_ways, maps
from gz_course.grader.feedback.suspects.steering import followers, heading_formulas


def found(room, text):
    tree = ast.parse(text)
    return [(line, said) for look in ROOM.of(room) for line, _, said in look(tree)]


def test_a_flag_that_the_first_call_sets_for_ever():
    text = """
class Mapper:  # publishes an OccupancyGrid
    kind = OccupancyGrid
    def __init__(self):
        self.finished = False
    def drive(self):
        if not self.finished:
            self.plan()
            if not self.path:
                self.finished = True
"""
    ((line, said),) = found(flags, text)
    assert line == 10 and "as soon as `not self.path` holds" in said
    assert found(flags, text + "    def again(self):\n        self.finished = False\n") == []


@pytest.mark.parametrize(
    ("begin", "test", "sets", "right"),
    [
        ("self.planned = False", "self.planned", "self.planned = True", "        self.planned = False\n"),
        ("self.mode = 'LOOK'", "self.mode != 'LOOK'", "self.mode = 'GO'", "        self.mode = 'LOOK'\n"),
    ],
)
def test_a_way_that_is_planned_once(begin, test, sets, right):
    text = f"""
class Mapper:
    def __init__(self):
        {begin}
    def plan(self):
        if {test}:
            return
        while self.queue:
            self.look()
        {sets}
"""
    ((line, said),) = found(flags, text)
    assert line == 6 and "planned only once" in said and sets in said
    assert found(flags, text + "    def on_goal(self):\n" + right) == []


@pytest.mark.parametrize(
    ("reach", "words"),
    [
        ("int(0.18 / self.grid.resolution)", "keep 1 cell (0.1 m)"),
        ("math.ceil((0.18 + 0.5) / RES)", "keep 7 cells (0.7 m)"),
        ("3", ""),
    ],
)
def test_margins_of_ways(reach, words):
    text = f"""
RES = 0.1
kind = OccupancyGrid
def widened(walls):
    reach = {reach}
    for dy in range(-reach, reach + 1):
        for dx in range(-reach, reach + 1):
            walls[dy, dx] = 1
"""
    said = [each for _, each in found(kept_ways, text)]
    assert words in said[0] if words else said == []


def test_a_margin_that_is_given_to_a_function():
    text = """
AWAY = 1
kind = OccupancyGrid
def grown(cells, by):
    return [roll(cells, dy, dx) for dy in range(-by, by + 1) for dx in range(-by, by + 1)]
near = grown(grid == 100, AWAY)
frontier = grown(grid == UNKNOWN, 1)
"""
    ((line, said),) = found(kept_ways, text)
    assert line == 6 and "AWAY is 1" in said


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("self.index(self.pose[1], self.pose[0])", "takes (x, y)"),
        ("self.index(p.y, p.x)", "takes (x, y)"),
        ("(self.y0 - y) / self.resolution", "the point minus the corner"),
        ("int(y / self.resolution - self.y0)", "subtract first"),
        ("self.x0 + (row + 0.5) * self.resolution", "x grows with the column"),
        ("self.index(self.pose[0], self.pose[1])", ""),
        ("self.index(p.x, p.y)", ""),
        ("(y - self.y0) / self.resolution", ""),
        ("self.x0 + (column + 0.5) * self.resolution", ""),
    ],
)
def test_places_of_cells(line, words):
    said = [each for _, each in found(cells, f"def index(self, x, y):\n    pass\n{line}\n")]
    assert words in said[0] if words else said == []


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("self.yaw += m.twist.twist.angular.z * 0.02", "adds up turning rates"),
        ("self.x = 0.9 * self.x + 0.1 * m.pose.pose.position.x", "averages the pose"),
        ("error = (a + pi / 2) % pi", "half turns"),
        ("error = remainder(a, math.pi)", "half turns"),
        ("error = remainder(a, 2 * math.pi)", ""),
        ("self.x = m.pose.pose.position.x", ""),
    ],
)
def test_poses_that_are_made(line, words):
    said = [
        each
        for _, each in found(heading_formulas, f"def on_odom(self, m: Odometry):\n    p = m.pose.pose\n    {line}\n")
    ]
    assert words in said[0] if words else said == []


def test_a_stop_for_what_is_near_on_any_side():
    text = "if min(self.scan.ranges) < 0.5:\n    cmd.linear.x = 0.0\n"
    ((line, said),) = found(followers, text)
    assert line == 1 and "on any side" in said
    assert found(followers, text + "    cmd.angular.z = 1.0\n") == []
    assert found(followers, text.replace("self.scan.ranges", "ahead")) == []


@pytest.mark.parametrize(
    ("begin", "line", "words"),
    [
        ("np.zeros(9)", "self.odds *= 0.97", "by 0.97"),
        ("np.zeros(9)", "self.odds = np.clip(0.9 * self.odds + seen, -4, 4)", "by 0.9"),
        ("np.zeros(9)", "self.odds = np.clip(self.odds + 0.9 * seen, -4, 4)", ""),
        (
            "deque(maxlen=30)",
            "self.odds.append(scan)\n        for each in self.odds:\n            f(each)",
            "last scans",
        ),
    ],
)
def test_maps_that_fade(begin, line, words):
    text = f"""
class Mapper:
    def __init__(self):
        self.odds = {begin}
        self.create_subscription(LaserScan, "/scan", self.on_scan, 10)
    def on_scan(self, scan):
        {line}
"""
    said = [each for _, each in found(maps, text)]
    assert words in said[0] if words else said == []


def test_the_other_end_of_a_way():
    text = "while near(self.way[0]):\n    self.way.pop()\n"
    ((line, said),) = found(aims, text)
    assert line == 2 and "self.way.pop(0)" in said
    assert found(aims, text.replace("pop()", "pop(0)")) == []
    assert found(aims, text.replace("[0]", "[-1]")) == []


def test_parts_that_are_unpacked_in_another_order():
    text = "self.pose = (p.x, p.y, atan2(a, b))\nx, yaw, y = self.pose\n"
    ((line, said),) = found(cells, text)
    assert line == 2 and "x, y, ..." in said
    assert found(cells, text.replace("x, yaw, y", "x, y, yaw")) == []


@pytest.mark.parametrize(
    ("code", "number"),
    [
        ("row * self.height + col", 1),
        ("HEIGHT * iy + ix", 1),
        ("row * self.width + col", 0),
        ("col * self.height + row", 0),
        ("row * height + 5", 0),
    ],
)
def test_a_row_is_as_long_as_the_map_is_wide(code, number):
    assert len(list(cells.other_stride(ast.parse(f"place = {code}")))) == number


def test_a_margin_of_no_cell():
    text = """
kind = OccupancyGrid
class Planner:
    REACH = 0
    def widened(self, walls):
        for dy in range(-self.REACH, self.REACH + 1):
            for dx in range(-self.REACH, self.REACH + 1):
                walls[dy, dx] = 1
"""
    ((_, said),) = found(kept_ways, text)
    assert "self.REACH is 0, so ways keep 0 cells" in said


CELLS = """
def place(self):
    grid = np.zeros((HEIGHT, WIDTH))
    i, j = int((self.px - X0) / RES), int((self.py - Y0) / RES)
    {}
"""


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("x = X0 + (j + 0.5) * RES", "makes x of a number of cells that was made of y"),
        ("x, y = X0 + (i + 0.5) * RES, Y0 + (j + 0.5) * RES", ""),
        ("value = grid[i, j]", "the index is [row, column]"),
        ("value = grid[j, i]", ""),
    ],
)
def test_cells_that_are_made_of_the_other_coordinate(line, words):
    said = [each for _, each in found(cells, CELLS.format(line))]
    assert words in said[0] if words else said == []


WAY = """
class Mapper:
    def __init__(self):
        self.way = []
    def plan(self):
        if self.way:
            return
        self.way = self.search()
    def aim(self):
        for cell in self.way:
            {}
        return self.way[-1]
"""


@pytest.mark.parametrize(
    ("line", "more", "number"),
    [("return cell", "", 1), ("if far(cell): return cell", "", 0), ("continue", "", 0)],
)
def test_a_loop_over_a_way_that_returns_in_its_first_pass(line, more, number):
    assert len(list(aims.left_in_the_first_pass(ast.parse(WAY.format(line) + more)))) == number


@pytest.mark.parametrize(("more", "number"), [("", 1), ("    def go(self):\n        self.way.pop(0)\n", 0)])
def test_a_way_that_nothing_takes_away_again(more, number):
    assert len(list(flags.kept_way(ast.parse(WAY.format("pass") + more)))) == number


def test_rates_of_a_twist_with_a_name_are_added_up():
    text = "def on_odom(m):  # Odometry\n    t = m.twist.twist\n    pose.yaw += t.angular.z * 0.02\nkind = Odometry\n"
    assert len(list(heading_formulas.summed_rates(ast.parse(text)))) == 1
    assert not list(heading_formulas.summed_rates(ast.parse(text.replace("twist.twist", "pose.pose"))))


@pytest.mark.parametrize(("number", "words"), [("1", "keep 1 cell"), ("3", "")])
def test_a_margin_whose_parts_are_assigned_together(number, words):
    text = f"""
kind = OccupancyGrid
WIDTH, REACH = 100, {number}
for dy in range(-REACH, REACH + 1):
    for dx in range(-REACH, REACH + 1):
        walls[dy, dx] = 1
"""
    said = [
        each
        for _, each in found(kept_ways, f"def widened(walls):\n    {text.strip().replace(chr(10), chr(10) + '    ')}")
    ]
    assert words in said[0] if words else said == []


@pytest.mark.parametrize(("sign", "number"), [("+", 1), ("-", 0)])
def test_the_corner_is_subtracted(sign, number):
    text = f"info.origin.position.x = self.grid.left\ncolumn = int((x {sign} self.left) / self.size)\n"
    assert len(list(cells.corner_added(ast.parse(text)))) == number


@pytest.mark.parametrize(
    ("value", "number"), [("atan2(p.y, p.x)", 1), ("atan2(goal.y, goal.x)", 0), ("atan2(q.z, q.w)", 0)]
)
def test_the_direction_of_a_position_is_no_heading(value, number):
    text = f"p = message.pose.pose.position\nyaw = math.{value}\n"
    assert len(list(heading_formulas.heading_of_a_position(ast.parse(text)))) == number
