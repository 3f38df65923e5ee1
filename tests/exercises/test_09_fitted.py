"""Which distance and which bearing a wall follower steers by is found by a fit, in scans drawn at random."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.grader.record.reading import Signal

FITTED = import_module("gz_course.exercises.09_closed_loop.grading.fitted")
DRIVING = import_module("gz_course.exercises.09_closed_loop.grading.driving")
LAW = import_module("gz_course.exercises.09_closed_loop.grading.law")

BEARINGS = np.linspace(-np.pi, np.pi, 180, endpoint=False)
SCANS = 300
SIDE = (-0.2, 2.5)
KINDS = ("cos", "sin", "mean", "max")
ASKED = np.full(SCANS, 0.6)


@pytest.fixture(scope="module")
def ranges():
    """Ranges to a wall on the left and to one ahead, which move slowly and independently."""
    draw = np.random.default_rng(5)
    steps = draw.normal(0, 1, (SCANS, 3))
    for i in range(1, SCANS):
        steps[i] = 0.9 * steps[i - 1] + 0.4 * steps[i]
    with np.errstate(divide="ignore"):
        beside = (0.7 + 0.12 * steps[:, :1]) / np.cos(BEARINGS - np.pi / 2 - 0.3 * steps[:, 1:2])
        ahead = (1.6 + 0.5 * steps[:, 2:]) / np.cos(BEARINGS - 0.3 * steps[:, 1:2])
    found = np.where(beside > 0, beside, np.inf)
    found = np.minimum(found, np.where(ahead > 0, ahead, np.inf))
    return np.where(found < 8, found + draw.normal(0, 0.003, found.shape), np.inf)


def commanded(distance, heading):
    return np.clip(3 * np.clip(distance - 0.6, -0.35, 0.35) + 1.5 * heading, -1.5, 1.5)


def test_a_node_that_steers_by_the_nearest_point_has_no_mistake(ranges):
    least, known = FITTED.nearest(BEARINGS, ranges, SIDE)
    for bearing in known:
        rates = commanded(least, bearing - np.pi / 2)
        assert FITTED.steers_by(BEARINGS, ranges, rates, ASKED, KINDS) == ""


def sector(ranges, low, high):
    chosen = np.abs(np.degrees(BEARINGS) - (low + high) / 2) < (high - low) / 2
    return np.where(np.isfinite(ranges[:, chosen]), ranges[:, chosen], np.nan)


DISTANCES = {
    "times the cosine of its bearing": lambda least, bearing, ranges: least * np.cos(bearing),
    "a median of the ranges on that side": lambda least, bearing, ranges: np.nanmedian(sector(ranges, 44, 136), axis=1),
    "a mean of the ranges on that side": lambda least, bearing, ranges: np.nanmean(sector(ranges, 59, 121), axis=1),
    "a median of all scans since the start": lambda least, bearing, ranges: [
        np.median(least[: i + 1]) for i in range(SCANS)
    ],
    "angular.z follows the bearing of the nearest point alone": lambda least, bearing, ranges: ASKED,
}


@pytest.mark.parametrize("words", DISTANCES)
def test_another_distance_than_the_nearest_range_is_named(ranges, words):
    least, (_, bearing, _) = FITTED.nearest(BEARINGS, ranges, SIDE)
    rates = commanded(np.array(DISTANCES[words](least, bearing, ranges)), bearing - np.pi / 2)
    assert words in FITTED.steers_by(BEARINGS, ranges, rates, ASKED, KINDS)


def test_a_mistake_that_needs_a_function_is_not_named_where_the_file_does_not_call_it(ranges):
    least, (_, bearing, _) = FITTED.nearest(BEARINGS, ranges, SIDE)
    rates = commanded(least * np.cos(bearing), bearing - np.pi / 2)
    assert "cosine" not in FITTED.steers_by(BEARINGS, ranges, rates, ASKED, ("sin", "max"))


def test_another_bearing_than_that_of_the_nearest_point_is_named(ranges):
    least, (exact, *_) = FITTED.nearest(BEARINGS, ranges, SIDE)
    rates = commanded(least, -exact)
    assert "its angle from abeam" in FITTED.steers_by(BEARINGS, ranges, rates, ASKED, KINDS)
    rates = commanded(exact, least - np.pi / 2)
    assert "range and bearing of the nearest point are exchanged" in FITTED.steers_by(
        BEARINGS, ranges, rates, ASKED, KINDS
    )


def test_a_place_in_a_list_of_chosen_rays_is_named(ranges):
    chosen = np.abs(BEARINGS - sum(SIDE) / 2) < (SIDE[1] - SIDE[0]) / 2
    number = ranges[:, chosen].argmin(axis=1)
    rates = commanded(ranges[:, chosen].min(axis=1), BEARINGS[number] + np.pi / 2)
    turned = np.remainder(BEARINGS + np.pi / 2, 2 * np.pi)  # such a scan begins on the right
    assert "as if ray 0 looked ahead" not in FITTED.steers_by(turned, ranges, rates, ASKED, KINDS)
    slanted = commanded(ranges[:, chosen].min(axis=1), BEARINGS[0] + number * (BEARINGS[1] - BEARINGS[0]) - np.pi / 2)
    assert np.abs(slanted).min() == 1.5  # it is always at its limit, so that nothing can be said
    assert FITTED.steers_by(BEARINGS, ranges, slanted, ASKED, KINDS) == ""


@pytest.mark.parametrize(
    ("taken", "words"),
    [(np.pi / 2 - BEARINGS, "with x and y exchanged"), (BEARINGS + np.pi / 2, "as if ray 0 looked to the right")],
)
def test_directions_that_are_counted_another_way_are_named(ranges, taken, words):
    taken = np.remainder(taken + np.pi, 2 * np.pi) - np.pi
    least, (exact, *_) = FITTED.nearest(taken, ranges, SIDE)
    rates = commanded(least, exact - np.pi / 2)
    assert words in FITTED.steers_by(BEARINGS, ranges, rates, ASKED, KINDS)


def test_a_sector_that_misses_the_wall_ahead_is_named(ranges):
    least, (_, mean, _) = FITTED.nearest(BEARINGS, ranges, (1.22, 1.92))
    said = FITTED.steers_by(BEARINGS, ranges, commanded(least, mean - np.pi / 2), ASKED, KINDS)
    assert "the rays from about 70 to 110 degrees" in said


def test_rates_that_are_multiplied_by_the_speed_are_named(ranges):
    least, (exact, *_) = FITTED.nearest(BEARINGS, ranges, SIDE)
    rates = commanded(least, exact - np.pi / 2)
    ahead = 0.25 + 0.2 * np.sin(np.arange(SCANS) / 7)
    said = FITTED.times_speed(BEARINGS, ranges, rates * ahead, ASKED, ahead)
    assert "angular.z is multiplied by linear.x" in said
    assert FITTED.times_speed(BEARINGS, ranges, 0.5 * rates, ASKED, ahead) == ""


def driven(turns, ahead, start=0.0):
    times = np.round((start + 0.1 * np.arange(len(turns))) * 1e9).astype(np.int64)
    found = {"angular/z": Signal(times, turns), "linear/x": Signal(times, np.broadcast_to(ahead, len(turns)))}
    recording = SimpleNamespace(signal=lambda name: found[name.partition("cmd_vel/")[2]], facts=dict)
    seconds = 0.1 * np.arange(len(turns))
    return SimpleNamespace(recording=recording, times=seconds, sign=1.0, side="left", limit=0.5)


def test_commands_that_begin_late_are_named():
    scans = 0.1 * np.arange(SCANS)
    assert "the first command comes at 12.0 s" in DRIVING.late_start(driven(np.ones(50), 0.3, 12.0), scans)
    assert DRIVING.late_start(driven(np.ones(50), 0.3, 0.2), scans) == ""


def test_commands_that_drive_backwards_are_named():
    turns = np.sin(np.arange(SCANS) / 9)
    assert "linear.x is below 0 in" in DRIVING.backwards(driven(turns, 0.5 - np.abs(turns)))
    assert DRIVING.backwards(driven(turns, 0.3)) == ""


def test_a_robot_that_circles_far_from_its_wall_is_described():
    run = driven(np.full(SCANS, 1.5), 0.3)
    run.error, run.along = np.full(SCANS, 0.7), np.full(SCANS, 0.03)
    assert "in circles, because nothing turns it back" in LAW.circling(run, np.full(SCANS, 1.5))
    assert LAW.circling(run, np.full(SCANS, -1.5)) == ""
    run.side, run.sign = "right", -1.0
    assert "with side 'right'" in LAW.unchanging(run, np.full(SCANS, 1.5))


def test_a_speed_that_is_made_of_the_error_is_named():
    error = 0.3 + 0.2 * np.sin(np.arange(SCANS) / 9)
    for ahead, words in ((error, "linear.x is about 1.0 times the error of the distance"), (0.5 - 0.5 * error, "")):
        run = driven(np.zeros(SCANS), ahead)
        run.error = error
        said = DRIVING.speed_of_error(run)
        assert words in said and bool(words) == bool(said)


@pytest.mark.parametrize(
    ("distance", "heading", "words"),
    [(1, 1, ""), (-1, 1, "the distance is fed back with the wrong"), (1, -1, "the heading is fed back with the wrong")],
)
def test_a_term_with_the_wrong_sign_is_named(ranges, distance, heading, words):
    least, (exact, *_) = FITTED.nearest(BEARINGS, ranges, SIDE)
    rates = np.clip(distance * np.clip(3 * (least - 0.6), -1, 1) + heading * 1.6 * (exact - np.pi / 2), -1.5, 1.5)
    said = FITTED.signs(BEARINGS, ranges, rates, ASKED, "left")
    assert words in said and bool(words) == bool(said)
