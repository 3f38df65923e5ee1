"""What a wall follower's commands depend on is found out from the run, in scans drawn at random."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.grader.record.reading import Signal

STEERING = import_module("gz_course.exercises.09_closed_loop.grading.steering")
LAW = import_module("gz_course.exercises.09_closed_loop.grading.law")
DRIVING = import_module("gz_course.exercises.09_closed_loop.grading.driving")
SEARCHING = import_module("gz_course.exercises.09_closed_loop.grading.searching")
WALL = import_module("gz_course.exercises.09_closed_loop.grading.wall")

BEARINGS = np.linspace(-np.pi, np.pi, 180, endpoint=False)
SCANS = 300


def walls(draw, side):
    """Ranges to a straight wall on a side, at distances and headings drawn at random."""
    distance, turned = draw.uniform(0.4, 1.0, SCANS), draw.uniform(-0.8, 0.8, SCANS)
    with np.errstate(divide="ignore"):
        along = distance[:, None] / np.cos(BEARINGS - side * np.pi / 2 - turned[:, None])
    return np.where(along > 0, np.minimum(along, 5.0), 5.0)


@pytest.fixture(scope="module")
def seen():
    """A run along two walls that move independently, and the scans of it."""
    draw = np.random.default_rng(9)
    ranges = np.minimum(walls(draw, 1), walls(draw, -1))
    ranges[:, np.abs(BEARINGS) < 0.35] = draw.uniform(0.7, 3.0, (SCANS, 1))
    ranges += draw.normal(0, 0.005, ranges.shape)
    return 1.0 + 0.1 * np.arange(SCANS), BEARINGS, ranges


def run(times, rates, side="left"):
    signal = Signal(np.round((times + 0.01) * 1e9).astype(np.int64), rates)
    recording = SimpleNamespace(signal=lambda name: signal)
    return SimpleNamespace(recording=recording, sign=1.0, side=side, times=times, wanted=np.full(len(times), 0.6))


CONTROLLERS = {
    "": lambda has: 2 * (has["right"][:, 1] - np.pi / 2 + 2 * (has["right"][:, 0] - 0.6)),
    "the nearest point on the right": lambda has: (
        2 * (has["other side"][:, 1] + 2 * (0.6 - has["other side"][:, 0]) + 1.6)
    ),
    "depends on the distance alone": lambda has: 2 * (has["right"][:, 0] - 0.6),
    "straight to the left alone": lambda has: 2 * (has["beside"][:, 0] - 0.6),
    "the range ahead alone": lambda has: -1 / has["ahead"][:, 0],
    "the ray on the right": lambda has: 2 * (has["beside, other"][:, 0] - 0.6),
}


def test_commands_that_answer_earlier_scans_are_late(seen):
    point, asked = law(seen)
    error, away = errors(point, asked)
    rates = np.roll(np.clip(2 * error + away, -1.5, 1.5), 8)
    assert "saw 8 scans before" in LAW.late(point, rates, asked)


@pytest.mark.parametrize("words", CONTROLLERS)
def test_what_the_commands_follow_is_named(seen, words):
    times, bearings, ranges = seen
    rates = CONTROLLERS[words](STEERING.measured(bearings, ranges))
    said = STEERING.measures(run(times, rates), times, bearings, ranges)
    assert words in said if words else said == ""


@pytest.mark.parametrize(
    ("distance", "heading", "words"),
    [(2, 2, ""), (-2, 2, "the distance is fed back with"), (2, -2, "the heading is fed back with")],
)
def test_a_wrong_sign_is_named(seen, distance, heading, words):
    point = STEERING.measured(seen[1], seen[2])["right"]
    rates = np.clip(distance * (point[:, 0] - 0.6) + heading * (point[:, 1] - np.pi / 2), -1.5, 1.5)
    said = STEERING.signs(run(seen[0], rates), *seen)
    assert words in said if words else said == ""


def test_commands_by_chance_follow_nothing(seen):
    rates = np.random.default_rng(1).normal(0, 1, SCANS)
    assert STEERING.measures(run(seen[0], rates), *seen) == ""


def test_few_scans_say_nothing(seen):
    times, bearings, ranges = (seen[0][:20], seen[1], seen[2][:20])
    assert STEERING.measures(run(times, np.ones(20)), times, bearings, ranges) == ""


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ([2.0] * 9, "is always 2.00"),
        ([0.2, 0.3, -0.1], "becomes negative"),
        ([0.2, 0.8, 0.8, 0.8], "is limited to 0.80, but 0.5 is the limit"),
        ([0.9, 1.4, 0.7], "is never within 0 and 0.5"),
        ([0.1] * 30 + [0.9, 1.4], "is not limited"),
    ],
)
def test_commands_beyond_their_limits_are_described(values, words):
    assert words in WALL.limits_missed("linear.x", np.array(values), 0.0, 0.5)


def test_a_limit_on_one_side_is_described():
    values = np.array([*np.linspace(-3, 1, 90), 1.5, 1.5, 1.5])
    assert "limited at 1.5, but not at -1.5" in WALL.limits_missed("angular.z", values, -1.5, 1.5)


def law(seen):
    """The nearest points of a run drawn at random, in which they change slowly, and the distance asked for."""
    draw = np.random.default_rng(4)
    steps = draw.normal(0, 1, (SCANS, 2))
    for i in range(1, SCANS):
        steps[i] = 0.9 * steps[i - 1] + 0.4 * steps[i]
    return np.array([0.6, np.pi / 2]) + 0.25 * steps, np.full(SCANS, 0.6)


def errors(point, asked):
    return np.clip(point[:, 0] - asked, -0.35, 0.35), point[:, 1] - np.pi / 2


def test_the_law_of_a_right_follower_has_nothing_wrong(seen):
    point, asked = law(seen)
    error, away = errors(point, asked)
    rates = np.clip(4 * error + 2 * away, -1.5, 1.5)
    assert LAW.late(point, rates, asked) == LAW.deaf(point, rates, asked) == ""
    assert LAW.without_sign(point, rates, asked) == LAW.opposite(run(seen[0], rates), point, rates, asked) == ""
    assert LAW.unchanging(run(seen[0], rates), rates) == "" and LAW.agrees(point, rates, asked) > 0.9


def test_wrong_laws_are_named(seen):
    point, asked = law(seen)
    error, away = errors(point, asked)
    right = 4 * error + 2 * away
    smooth = np.array([right[max(0, i - 19) : i + 1].mean() for i in range(SCANS)])
    assert "answers an average of the last scans" in LAW.late(point, smooth, asked)
    assert "hardly answers the distance" in LAW.deaf(point, 0.2 * error + 2 * away, asked)
    assert "not its sign" in LAW.without_sign(point, np.clip(4 * np.abs(error) + 2 * away, -1.5, 1.5), asked)
    opposite = LAW.opposite(run(seen[0], -right, "right"), point, np.clip(-right, -1.5, 1.5), asked)
    assert "angular.z has the wrong sign" in opposite and "'right'" in opposite
    beside = run(seen[0], right)
    assert LAW.unchanging(beside, right) == ""
    assert "is at its limit, 1.50 rad/s" in LAW.unchanging(beside, 0 * right + 1.5)
    assert "in nearly every command" in LAW.unchanging(beside, 0 * right + 0.4)
    assert LAW.offset(point, right, asked) == LAW.one_way(beside, point, right, asked) == ""
    assert "still about 0.8 rad/s towards the wall" in LAW.offset(point, right + 0.8, asked)
    assert LAW.strong(point, right, asked) == ""
    assert "by 9 rad/s for each metre" in LAW.strong(point, np.clip(9 * error + 1 * away, -1.5, 1.5), asked)
    assert LAW.left_alone(point, right, asked) == "" and LAW.heeds_heading(point, right, asked)
    band = np.where(np.abs(point[:, 0] - asked) < 0.1, 0.0, right)
    assert "right within 0.1" in LAW.left_alone(point, band, asked)
    assert not LAW.heeds_heading(point, 4 * error, asked)
    assert LAW.answers_old(point, 4 * error + 2 * away, 0.6, 0.9)
    assert not LAW.answers_old(point, 4 * error + 2 * away, 0.9, 0.6)
    assert "to the left only" in LAW.one_way(beside, point, np.abs(right), asked)
    assert LAW.late(point, smooth, asked, np.zeros(SCANS, bool)) == ""


@pytest.mark.parametrize(
    ("kept", "words"),
    [
        (lambda wanted: wanted, ""),
        (lambda wanted: wanted + 0.17, "keeps 0.17 m more"),
        (lambda wanted: 0.6 * wanted, "0.60 times"),
    ],
)
def test_another_distance_that_is_kept_is_named(kept, words):
    times = np.arange(0.0, 30.0, 0.05)
    wanted = np.where(times < 15.0, 0.6, 0.9)
    run = SimpleNamespace(times=times, changed=15.0, wanted=wanted, error=kept(wanted) - wanted, along=0 * times + 0.02)
    said = LAW.kept_beside(run, 7.0)
    assert words in said and bool(words) == bool(said)


def test_a_speed_limit_that_changes_is_the_limit_of_what_comes_then():
    limits = Signal(np.array([0, 10_000_000_000]), np.array([0.5, 0.3]))
    allowed = WALL.Run.allowed(SimpleNamespace(limits=limits, limit=0.5), np.array([5.0, 10.2, 11.0]))
    assert allowed.tolist() == [0.5, 0.5, 0.3]


def test_commands_that_answer_the_scan_before_are_compared_with_it(seen):
    times, bearings, ranges = seen
    right = CONTROLLERS[""](STEERING.measured(bearings, ranges))
    assert STEERING.lag(run(times, right), times, bearings, ranges) == 0
    assert STEERING.lag(run(times, np.concatenate([[0.0], right[:-1]])), times, bearings, ranges) == 1


def driven(turning, ahead, distance, side="left", limit=0.5):
    """A run of 30 s whose commands come ten times a second; distance is set from 0.6 to 0.9 m at 15 s."""
    times = np.arange(0.0, 30.0, 0.1)
    stamps = np.round(times * 1e9).astype(np.int64)
    signals = {
        "topics/cmd_vel/angular/z": Signal(stamps, np.broadcast_to(turning, times.shape)),
        "topics/cmd_vel/linear/x": Signal(stamps, np.broadcast_to(ahead, times.shape)),
    }
    asked = np.array([0.6, 0.9])
    wanted = np.where(times < 15.0, *asked)
    return SimpleNamespace(
        recording=SimpleNamespace(signal=signals.__getitem__, facts=lambda: {}),
        times=times,
        side=side,
        limit=limit,
        asked=asked,
        changed=15.0,
        distance=np.broadcast_to(distance, times.shape),
        error=distance - wanted,
    )


def test_a_slow_robot_is_told_so():
    assert "too slow: linear.x is 0.20 m/s at most" in DRIVING.slow(driven(0.1, 0.2, 0.6))
    assert DRIVING.slow(driven(0.1, 0.45, 0.6)) == ""


def test_driving_straight_on_far_from_the_wall_is_named():
    times = np.arange(0.0, 30.0, 0.1)
    gone = np.where((times > 8) & (times < 10), 2.0, 0.6)
    said = DRIVING.straight_on(driven(np.where(gone > 1, 0.0, 0.3), 0.4, gone, "right"))
    assert said.startswith("from 8.1 s on angular.z was 0 for 1.8 s") and "to the right" in said
    once = np.where(np.abs(times - 9.0) < 0.05, 0.2, np.where(gone > 1, 0.0, 0.3))
    assert DRIVING.straight_on(driven(once, 0.4, gone, "right")) == said
    assert DRIVING.straight_on(driven(0.3, 0.4, gone)) == ""
    assert DRIVING.straight_on(driven(0.0, 0.4, 2.0 - 0.03 * times)) == ""  # at an angle towards the wall


def test_a_speed_that_is_made_of_the_distance_is_named():
    times = np.arange(0.0, 30.0, 0.1)
    assert "made of the parameter distance" in DRIVING.speed_by_distance(
        driven(0.1, np.where(times < 15, 0.58, 0.87), 0.6)
    )
    assert DRIVING.speed_by_distance(driven(0.1, 0.45, 0.6)) == ""


def test_a_node_that_is_silent_while_all_is_right_is_named():
    run = driven(0.1, 0.4, 0.0)
    run.error = np.where(np.arange(300) % 20 < 10, 0.02, 0.3)
    kept = run.error > 0.1
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    run.recording.signal = lambda name: Signal(signal.times[kept], signal.values[kept])
    assert "no command came for" in DRIVING.silent(run, run.times)
    run.recording.signal = lambda name: signal
    assert DRIVING.silent(run, run.times) == ""


def test_a_rate_about_another_axis_is_named():
    run = driven(0.0, 0.4, 0.6)
    signal = run.recording.signal("topics/cmd_vel/linear/x")
    run.recording.signal = lambda name: Signal(signal.times, signal.values * (name[-1] == "x"))
    assert "angular.x is up to 0.40" in DRIVING.other_axes(run)
    run.recording.signal = lambda name: Signal(signal.times, signal.values * (name.endswith(("linear/x", "z"))))
    assert DRIVING.other_axes(run) == ""


def test_circles_are_named():
    run = driven(1.2, 0.4, 1.3)
    run.turning = np.full(300, 1.2)
    assert "in circles, 5.7 of them: angular.z always turns it to the left" in DRIVING.circles(run)
    run.turning = np.where(np.arange(300) % 50 < 25, 1.2, -1.2)
    assert DRIVING.circles(run) == ""


def test_two_commands_for_each_scan_are_named():
    halves = np.arange(600) % 2
    stamps = (np.arange(600) // 2 * 50_000_000 + halves * 1_000_000).astype(np.int64)
    run = driven(0.0, 0.4, 0.6)
    run.recording.signal = lambda name: Signal(stamps, 0.4 * (halves if name.endswith("z") else 1 - halves))
    assert "answered by two commands" in SEARCHING.halves(run)
    run.recording.signal = lambda name: Signal(stamps, np.full(600, 0.4))
    assert SEARCHING.halves(run) == ""


def test_a_rate_that_changes_by_small_steps_is_named():
    wave = np.sin(np.arange(300) / 30)
    steps = np.cumsum(0.02 * np.sign(wave))
    assert "never changes by more than 0.02 rad/s" in SEARCHING.ramp(driven(steps, 0.4, 0.6))
    assert SEARCHING.ramp(driven(wave, 0.4, 0.6)) == ""


def test_a_turn_before_a_wall_that_does_not_change_with_the_side_is_named():
    ahead = 0.5 + np.abs(3 * np.sin(np.arange(300) / 10))
    for side, sign, words in (("right", -1.0, "a turn to the right, and side is 'right'"), ("left", 1.0, "")):
        run = driven(np.where(ahead < 1.0, -1.2, 0.1), 0.4, 0.6, side)
        run.sign, run.ahead = sign, ahead
        said = SEARCHING.turns_to_one_side(run)
        assert words in said and bool(words) == bool(said)


def test_linear_and_angular_that_are_exchanged_are_named(seen):
    point, asked = law(seen)
    error, away = errors(point, asked)
    right = np.clip(4 * error + 2 * away, -1.5, 1.5)
    run = SimpleNamespace(limit=0.5, sign=1.0)
    assert "linear.x and angular.z are exchanged" in SEARCHING.exchanged(run, point, 0 * right + 0.4, asked, right)
    assert SEARCHING.exchanged(run, point, right, asked, 0 * right + 0.4) == ""


def test_a_run_that_ends_before_the_parameter_is_set_has_no_time_of_it(monkeypatch):
    check = WALL.keeps_distance
    run = SimpleNamespace(changed=np.inf, times=np.arange(0.0, 10.0, 0.1), asked=np.array([0.6]))
    monkeypatch.setitem(check.__globals__, "Run", lambda recording: run)
    monkeypatch.setitem(check.__globals__, "_finding", lambda *given: given)
    found = check(None, {"tolerance": 0.2, "share": 0.8, "settle": 6.0, "way": 1.0, "changed": True})
    assert found == (run, False, "the parameter distance is set while the node runs", "it was not set in this run")


def test_a_rate_that_stays_the_same_to_the_end_is_named():
    turns = np.sin(np.arange(300) / 20)
    assert SEARCHING.stuck(driven(turns, 0.4, 0.6)) == ""
    said = SEARCHING.stuck(driven(np.where(np.arange(300) < 200, turns, -1.0), 0.4, 0.6))
    assert said.startswith("from 20.0 s to the end angular.z is -1.00 rad/s in every command")
