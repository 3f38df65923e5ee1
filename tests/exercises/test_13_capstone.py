"""What is wrong with how a robot explored, or with what its map leaves out."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.grader.record.reading import Signal
from gz_course.grader.score.floor import Grid, Shapes

DRIVING = import_module("gz_course.exercises.13_capstone.grading.driving")
MAP_FAULTS = import_module("gz_course.exercises.13_capstone.grading.map_faults")
ARRANGED = import_module("gz_course.exercises.13_capstone.grading.arrangements")
NOW = np.arange(0.0, 36.0, 0.2)


def recording(
    x=0 * NOW,
    y=0 * NOW,
    yaw=0 * NOW,
    ahead=0 * NOW,
    turning=0 * NOW,
    aside=0 * NOW,
    suspects=(),
    tests=(),
    rolling=0 * NOW,
):
    """A recording as these functions see it."""
    signals = {f"truth/robot/{name}": values for name, values in (("x", x), ("y", y), ("yaw", yaw))}
    signals["truth/robot/distance"] = np.cumsum(np.hypot(np.diff(x, prepend=x[:1]), np.diff(y, prepend=y[:1])))
    signals |= {"topics/cmd_vel/linear/y": aside, "topics/cmd_vel/linear/x": ahead, "topics/cmd_vel/angular/z": turning}
    signals |= {"topics/cmd_vel/angular/x": rolling, "topics/cmd_vel/angular/y": 0 * NOW}
    times = np.round(NOW * 1e9).astype(np.int64)
    return SimpleNamespace(
        signal=lambda name: Signal(times[: len(signals[name])], signals[name]),
        end_ns=36_000_000_000,
        facts=lambda: {"suspects": list(suspects), "before_speeds": list(tests)},
    )


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        ({"ahead": np.empty(0), "turning": np.empty(0)}, "no command came"),
        ({}, "all of its 180 commands were 0"),
        ({"turning": 1 + 0 * NOW}, "linear.x was 0 in every command"),
        ({"ahead": 0.3 + 0 * NOW}, ""),
    ],
)
def test_why_a_robot_never_drove(commands, words):
    said = DRIVING.stands(recording(**commands))
    assert words in said if words else said == ""


@pytest.mark.parametrize(
    ("run", "words"),
    [
        (recording(x=0.5 * NOW, ahead=0.5 + 0 * NOW), ""),
        (recording(x=0.1 * NOW, ahead=0.1 + 0 * NOW), "0.10 m/s at most, too slow"),
        (recording(yaw=NOW, ahead=0.3 + 0 * NOW), "turned around 6 times"),
        (recording(x=np.sin(NOW), y=np.cos(NOW), yaw=NOW, ahead=1 + 0 * NOW), "drove in circles"),
        (recording(x=np.sin(NOW), y=np.cos(NOW), ahead=1 + 0 * NOW), "within 2.0 by 2.0 m"),
        (recording(yaw=NOW, suspects=[{"line": 7, "about": "heading", "said": "half"}]), "line 7: half"),
    ],
)
def test_why_a_robot_did_not_see_all(run, words):
    said = DRIVING.slow_or_lost(run)
    assert words in said if words else said == ""


def test_how_a_robot_turned_is_what_was_seen():
    swings = recording(yaw=np.sin(NOW), turning=np.sin(NOW * 2))
    assert "turned to the left nearly all the time" in DRIVING.how_it_turned(recording(yaw=NOW % 6.28))
    assert "the sign of angular.z changed" in DRIVING.how_it_turned(swings)
    assert DRIVING.how_it_turned(recording(yaw=np.sin(NOW))) == "it turned to and fro"


def test_the_conditions_before_a_speed_that_is_never_set():
    tests = [{"line": line, "code": f"if {line}:"} for line in (3, 5, 7)]
    said = DRIVING.stands(recording(turning=1 + 0 * NOW, tests=tests))
    assert said.endswith("never held: line 5, `if 5:`; line 7, `if 7:`")
    assert "commands were 0; one of the conditions before it" in DRIVING.stands(recording(tests=tests))
    sign = {"line": 9, "about": "sign", "said": "the wrong sign"}
    assert DRIVING.stands(recording(turning=1 + 0 * NOW, suspects=[sign])) == "line 9: the wrong sign"


def test_a_robot_that_never_slows_down_to_turn():
    turning = np.where(NOW % 4 < 2, 1.2, 0.1)
    fast, slow = (recording(turning=turning, ahead=ahead) for ahead in (0.5 + 0 * NOW, np.where(turning > 1, 0.1, 0.5)))
    assert "as fast as ever, while it turns with 1.2 rad/s" in DRIVING.drives_while_turning(fast)
    assert "as fast as ever" in DRIVING.touched(fast, 0.18, 0, (0.0, 0.18))
    assert DRIVING.drives_while_turning(slow) == DRIVING.drives_while_turning(recording()) == ""


def test_a_robot_that_drove_far_and_did_not_see_all_is_looked_up_in_its_file():
    search = {"line": 9, "about": "search", "said": "runs deep"}
    assert DRIVING.slow_or_lost(recording(x=0.5 * NOW, ahead=0.5 + 0 * NOW, suspects=[search])) == "line 9: runs deep"


def test_maps_that_are_all_the_same():
    said, run = np.full((80, 100), -1.0), recording()
    assert "all 5 maps are the same, all cells are unknown" in MAP_FAULTS.hardly_any(run, said, [said.ravel()] * 5)
    assert MAP_FAULTS.hardly_any(run, said, [said.ravel()] * 4 + [0 * said.ravel()]) == "hardly any cell is occupied"


def test_what_was_touched_ahead_and_beside():
    shapes = Shapes([("crate", (1.0, 0.0, 0.0), np.array([0.5, 0.5]))], [])
    assert DRIVING.nearest_point(shapes, (0.3, 0.0)) == pytest.approx(np.array([0.5, 0.0]), abs=0.02)
    assert "straight at it" in DRIVING.touched(recording(), 0.18, 0, (0.2, 0.0))
    assert "its left side, 90 degrees from ahead" in DRIVING.touched(recording(), 0.18, 0, (0.0, 0.18))


def test_what_the_map_shows_where_something_was_touched():
    said = np.full((80, 100), -1.0)
    assert "does not show it: the cells there are unknown" in DRIVING.in_the_map(said, (1.0, 0.0), 6.0)
    said[35:45, 55:65] = 0
    free = DRIVING.in_the_map(said, (1.0, 0.0), 6.0)
    assert "does not show it: the cells there are free" in free
    assert "no way keeps away from it" in DRIVING.touched(recording(), 0.18, 0, (0.2, 0.0), free)
    said[40, 61] = 100
    shown = DRIVING.in_the_map(said, (1.0, 0.0), 6.0)
    assert shown == "your map of 6.0 s shows it there" and shown in DRIVING.touched(
        recording(), 0.18, 0, (0, 0.2), shown
    )


def test_a_robot_that_is_commanded_to_drive_sideways():
    aside = recording(aside=0.3 + 0 * NOW, ahead=0.1 + 0 * NOW)
    assert "cannot drive sideways" in DRIVING.slow_or_lost(aside) and "angular.z is 0" in DRIVING.stands(aside)
    assert DRIVING.sideways(recording()) == ""


def test_what_a_robot_that_drove_little_was_commanded():
    early, turning = np.where(NOW < 5, 0.3, 0.0), np.where(NOW % 2 < 1.5, 1.0, 0.0)
    assert "all commands from 5 s on are 0" in DRIVING.what_it_did(recording(ahead=early))
    turns = recording(turning=turning, yaw=np.cumsum(turning) / 5)
    assert "to the left nearly all the time" in DRIVING.what_it_did(turns)


def grids():
    """A map with a wall, what the scanner has hit, and cells that rays passed."""
    said, wanted, passed = np.full((80, 100), -1.0), np.zeros((80, 100), bool), np.zeros((80, 100), bool)
    wanted[20, 10:80] = True
    passed[21:40, 10:80] = True
    return said, wanted, passed


@pytest.mark.parametrize(
    ("value", "words"), [(0, "are free in the map"), (-1, "are unknown in the map"), (100, ""), (50, "")]
)
def test_walls_that_are_missing(value, words):
    said, wanted, _ = grids()
    said[wanted] = value
    found = MAP_FAULTS.walls_missing(said, wanted, None)
    assert words in found if words else found == ""
    assert ("between 26 and 64, such as 50" in MAP_FAULTS.unclear(said, wanted)) == (value == 50)


def test_walls_that_were_there_before():
    said, wanted, _ = grids()
    assert "what was seen once must stay" in MAP_FAULTS.walls_missing(said, wanted, wanted)


def test_walls_that_were_there_before_and_are_free_now():
    said, wanted, _ = grids()
    said[wanted] = 0
    assert "a hit must count for more" in MAP_FAULTS.walls_missing(said, wanted, wanted)


def test_a_map_that_is_moved():
    _, solid, _ = grids()
    solid[20:60, 10] = True
    ((words, changed),) = ARRANGED.moved(np.roll(solid, (1, 2), (0, 1)), solid)
    assert "2 cells too far along x and 1 along y" in words and (changed == solid).all()


def test_cells_that_are_not_free():
    said, _, passed = grids()
    assert "most rays, or most scans, are left out" in MAP_FAULTS.not_free(said, passed, 0 * passed)
    said[passed] = 0
    others = np.roll(passed, 30, axis=0)
    assert "only rays with a hit" in MAP_FAULTS.not_free(said, passed, others)
    assert MAP_FAULTS.not_free(said, passed, passed) == ""
    said[:, ::2] = -1
    assert "steps along a ray" in MAP_FAULTS.not_free(said, passed, 0 * passed)


def test_walls_that_are_widened():
    said, hit, _ = grids()
    said[MAP_FAULTS.widened(hit, 3.1)] = 100
    alias = {"line": 7, "about": "alias", "said": "makes no copy"}
    assert "about 3 cells thicker on every side" in MAP_FAULTS.thick(recording(), said, hit)
    assert "(line 7: makes no copy)" in MAP_FAULTS.thick(recording(suspects=[alias]), said, hit)
    half = np.where(np.arange(100) < 45, said, -1)
    assert MAP_FAULTS.thick(recording(), half, hit) == ""  # at half of the walls
    said[40:70] = 100
    assert MAP_FAULTS.thick(recording(), said, hit) == ""  # elsewhere, too
    said[:] = -1
    said[hit] = 100
    assert MAP_FAULTS.thick(recording(), said, hit) == ""


@pytest.mark.parametrize(
    ("x", "y", "words"),
    [
        (-50, -40, "which is in cells; in metres the corner"),
        (0, 0, "it is not set"),
        (5, 4, "the opposite corner"),
        (-4, -5, "x and y are exchanged"),
        (-4.95, -3.95, "the middle of the first cell"),
        (1, 1, "the corner of the first cell is at (-5, -4)"),
    ],
)
def test_an_origin_that_is_something_else(x, y, words):
    assert words in MAP_FAULTS.other_origin(x, y, Grid(0.1, 100, 80, -5.0, -4.0))


def test_scattered_hits_do_not_explain_the_walls_of_a_map(monkeypatch):
    checks = import_module("gz_course.exercises.13_capstone.grading.checks")
    said = np.full((80, 100), -1.0)
    said[40, 10:60] = 100
    wall = np.stack([np.arange(10, 60) / 10 - 4.95, np.full(50, 0.05)], 1)
    everywhere = np.concatenate([wall, *(wall + np.array([0, 0.4 * row]) for row in range(1, 8))])
    known = checks.drawn_elsewhere.__globals__
    monkeypatch.setitem(known, "grid", lambda *given: (said, 1.0))
    monkeypatch.setitem(known, "scans", lambda *given: None)
    monkeypatch.setitem(known, "hits", lambda *given: np.array([[4.0, 3.0]]))
    recording = SimpleNamespace(arrays=lambda name: (np.zeros(1), []), facts=lambda: {})
    for points, words in ((wall, "a mistake"), (everywhere, "")):
        monkeypatch.setitem(known, "misplaced", lambda scan, points=points: [("a mistake", points)])
        assert checks.drawn_elsewhere(recording) == words


def test_cells_by_another_factor():
    points = np.array([[-2.5, 1.5], [-2.4, 1.5]])
    drawn = {words.split(":")[0]: np.argwhere(cells).tolist() for words, cells in ARRANGED.scaled(points)}
    assert drawn["metres are taken for cells"] == [[5, 2]]
    assert drawn["the distance from the origin is multiplied by the resolution"] == [[0, 0]]


@pytest.mark.parametrize(
    ("value", "words"),
    [(100, "are occupied in the map: they are free"), (50, "values such as 50"), (-1, "all cells"), (0, "")],
)
def test_a_map_by_which_no_robot_can_drive(monkeypatch, value, words):
    exploring = import_module("gz_course.exercises.13_capstone.grading.exploring")
    known = exploring.not_as_it_was_seen.__globals__
    passed = np.zeros((80, 100), dtype=int)
    passed[20:60, 20:60] = 9
    monkeypatch.setitem(known, "walls_are_right", lambda *given: True)
    monkeypatch.setitem(known, "hits", lambda *given: np.empty((0, 2)))
    monkeypatch.setitem(known, "along", lambda *given: passed)
    said = exploring.not_as_it_was_seen(recording(), np.where(passed, value, -1.0), SimpleNamespace(ends=3.0, hit=None))
    assert words in said if words else said == ""


def test_walls_in_a_wrong_place_are_no_walls_known_by_heart(monkeypatch):
    checks = import_module("gz_course.exercises.13_capstone.grading.checks")
    known = checks.known_before.__globals__
    said = np.full((80, 100), -1.0)
    said[10, 10:90] = 100
    hit = np.stack([np.arange(10, 90) / 10 - 4.95, np.full(80, 2.05)], 1)
    monkeypatch.setitem(known, "grid", lambda *given: (said, 1.0))
    monkeypatch.setitem(known, "scans", lambda *given: None)
    monkeypatch.setitem(known, "shapes", lambda *given: Shapes([], []))
    run = SimpleNamespace(arrays=lambda name: (np.zeros(1), []))
    for points, by_heart in ((hit, False), (hit[:20], True)):
        monkeypatch.setitem(known, "hits", lambda *given, points=points: points)
        assert bool(checks.known_before(run)) == by_heart


def test_a_map_that_is_moved_by_the_start_of_the_robot():
    solid = np.zeros((80, 100), dtype=bool)
    solid[20:50, 15] = solid[20, 15:60] = solid[50, 30:40] = True
    ((words, changed),) = ARRANGED.moved(np.roll(solid, (-17, 25), (0, 1)), solid, (-2.5, 1.7, 0.4))
    assert "the first position is subtracted" in words and np.array_equal(changed, solid)
    ((words, _),) = ARRANGED.moved(np.roll(solid, (-17, 25), (0, 1)), solid, (1.0, 1.0, 0.4))
    assert "25 cells too far along x and -17 along y: the column" in words
    assert list(ARRANGED.moved(solid, solid)) == []


def test_ends_of_rays_without_a_hit_explain_walls_only_where_they_are():
    solid, ends, said = (np.zeros((80, 100), dtype=bool), np.zeros((80, 100), dtype=bool), np.full((80, 100), -1.0))
    solid[10], ends[40, 20:80], said[20:45, 20:80] = True, True, 0
    arcs = ARRANGED.arcs
    assert "inf is no hit" in arcs(solid | ends, solid, ends, said)
    ends[20:45, 20:80] = True  # they lie everywhere
    assert arcs(solid | (said == 0), solid, ends, said) == ""


def test_a_map_that_does_not_change():
    times, maps = np.arange(10) * 10**9, [np.full(8, number) for number in (0, 1, *[2] * 8)]
    assert "since 2.0 s" in MAP_FAULTS.unchanged(times, maps)
    assert MAP_FAULTS.unchanged(times, [np.full(8, number) for number in range(10)]) == ""


def test_hits_that_are_free_in_a_map_without_walls():
    said, hit = np.zeros((80, 100)), np.zeros((80, 100), dtype=bool)
    hit[5, :50] = True
    assert "make the cells in which they end free again" in MAP_FAULTS.hardly_any(recording(), said, [], hit)
    assert MAP_FAULTS.hardly_any(recording(), said, []) == "hardly any cell is occupied"


def test_a_robot_that_drives_backwards():
    assert "drives backwards" in DRIVING.slow_or_lost(recording(ahead=-0.4 + 0 * NOW))
    assert DRIVING.backwards(recording(ahead=0.4 + 0 * NOW)) == ""


def test_a_side_that_is_touched_by_a_narrow_margin_is_looked_up():
    narrow = {"line": 5, "about": "narrow", "said": "1 cell"}
    assert DRIVING.touched(recording(suspects=[narrow]), 0.18, 0, (0.0, 0.18)) == "line 5: 1 cell"
    assert "straight at it" in DRIVING.touched(recording(suspects=[narrow]), 0.18, 0, (0.2, 0.0))


@pytest.mark.parametrize(("value", "words"), [(50, "unknown cells hold 50"), (-1, ""), (0, ""), (100, "")])
def test_the_number_of_unknown_cells(value, words):
    said, _, seen = grids()
    said[~seen], said[seen] = value, 0
    found = ARRANGED.other_unknown(said, seen)
    assert words in found if words else found == ""


def test_a_robot_that_turns_to_one_side_only():
    run = {"x": 4 * np.sin(NOW / 6), "y": 4 * np.cos(NOW / 6), "yaw": np.minimum(NOW, 13.0), "ahead": 0.5 + 0 * NOW}
    assert "the robot turned to the left only" in DRIVING.slow_or_lost(recording(**run, turning=0.5 + 0 * NOW))
    assert DRIVING.slow_or_lost(recording(**run, turning=np.sin(NOW))) == ""


def test_a_robot_that_is_commanded_to_turn_about_another_axis():
    run = recording(x=0.05 * NOW, ahead=0.1 + 0 * NOW, rolling=0.9 + 0 * NOW)
    assert "angular.x is up to 0.90 rad/s" in DRIVING.slow_or_lost(run)


def test_commands_that_end_although_something_is_near():
    ahead = np.where(NOW < 5, 0.3, 0.0)
    near = {"line": 9, "about": "ray", "said": "the nearest in any direction"}
    said = DRIVING.what_it_did(recording(ahead=ahead, suspects=[near]))
    assert said == "all commands from 5 s on are 0; line 9: the nearest in any direction"
    assert "as if nothing were left" in DRIVING.what_it_did(recording(ahead=ahead))


@pytest.mark.parametrize(("shown", "words"), [(0, "make the cells in which they end free again"), (100, ""), (-1, "")])
def test_a_map_without_the_walls_that_were_hit(shown, words):
    module = import_module("gz_course.exercises.13_capstone.grading.shown")
    hit, passed = np.zeros((80, 100), dtype=bool), np.zeros((80, 100), dtype=bool)
    hit[20, 20:60], passed[21:60, 20:60] = True, True
    said = np.where(passed, 0.0, np.where(hit, shown, -1.0))
    found = module.wrongly(SimpleNamespace(facts=lambda: {}), said, passed, hit)
    assert words in found if words else found == ""


@pytest.mark.parametrize(("speed", "found"), [(0.3, True), (0.5, False)])
def test_a_robot_that_drives_without_a_way(speed, found):
    module = import_module("gz_course.exercises.13_capstone.grading.driving")
    place = {"line": 7, "about": "blind", "said": "linear.x is 0.3 where the robot has no way"}
    signal = SimpleNamespace(times=np.arange(5) * 10**9, values=np.full(5, speed))
    drive = SimpleNamespace(facts=lambda: {"suspects": [place]}, signal=lambda name: signal)
    assert bool(module.without_a_way(drive, 3.5e9)) == found
