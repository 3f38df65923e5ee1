"""More of `11_many_robots`: followers that are late or mix things up, and convoys that are not all there."""

from importlib import import_module
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.tests.exercises.convoys import (
    CHECKS,
    FITS,
    Run,
    bearing,
    distance,
    rule,
    speed_of,
    told,
    wrapped,
)

HERE = Path(__file__).parent
GAP = 1.2


def beside(h, east, north):
    """Return how far ahead a place beside the robot in front is, along the follower's own direction."""
    x, y = h.front_x + GAP + GAP * east - h.x, h.front_y + GAP * north - h.y
    return np.cos(h.heading) * x + np.sin(h.heading) * y


def late(speed):
    return FITS.follower_lags.late(Run(rule(speed)), "robot2", "robot1", FITS.heard, FITS.line)


def kept():
    """Return a function of what a follower hears that returns the distances to all places it has heard of so far."""
    places = []

    def distances(h):
        places.append((h.front_x, h.front_y))
        return [float(np.hypot(x + GAP - h.x, y - h.y)) for x, y in places]

    return distances


def test_an_old_place_of_the_robot_in_front():
    distances = kept()
    said = late(lambda h: speed_of(distances(h)[-40:][0] - GAP))
    assert "the place that the robot in front had 2 s before" in said


def test_a_moving_average_of_the_places_in_front():
    place = [0.0, 0.0]

    def smooth(h):
        for axis, value in enumerate((h.front_x, h.front_y)):
            place[axis] += 0.04 * (value - place[axis])
        return speed_of(np.hypot(place[0] + GAP - h.x, place[1] - h.y) - GAP)

    assert "in which the newest counts little" in late(smooth)


def test_a_follower_in_time_is_not_late():
    assert late(lambda h: speed_of(distance(h) - GAP)) == ""


@pytest.mark.parametrize(
    ("speed", "words"),
    [
        (lambda h: max(0.0, min(2.0 * (distance(h) - GAP), 0.8 * h.v)), "0.8 times the speed of the robot in front"),
        (lambda h: speed_of(np.hypot(h.front_x, h.front_y) - GAP), "its own place is not subtracted"),
        (lambda h: speed_of(distance(h) - 2 * GAP), "is zero at a distance of 2.40 m"),
        (lambda h: speed_of(beside(h, -np.sin(h.front_heading), -np.cos(h.front_heading)), most=3.0), "cos and sin in"),
        (lambda h: speed_of(beside(h, np.cos(h.front_heading), np.sin(h.front_heading)), most=6.0), "1.2 m ahead of"),
        (lambda h: speed_of(beside(h, -np.cos(h.front_heading), -np.sin(h.front_heading)), most=3.0), ""),
    ],
)
def test_more_wrong_speeds(speed, words):
    said = told(rule(speed), "speed")
    assert words in said and bool(words) == bool(said)


def test_linear_and_angular_exchanged():
    exchanged = told(lambda h: (2.5 * wrapped(bearing(h) - h.heading), speed_of(distance(h) - GAP)), "speed")
    assert "linear.x and angular.z are exchanged" in exchanged


def test_a_follower_that_stops_for_ever():
    stopped = FITS.follower_lags.stopped
    heard = [FITS.heard(Run(rule(speed)), "robot2", "robot1") for speed in (lambda h: 0.0, lambda h: h.v)]
    assert stopped(heard[0]) and not stopped(heard[1])


def test_gaps_that_are_added_up():
    added = CHECKS.convoy_rows.added_up
    said = "its speed is zero at a distance of 2.40 m, so that is the gap it keeps"
    assert "the gaps to all 2 robots before it, added up" in added(said, 2)
    assert added(said, 1) == added("", 2) == added(said, 3) == ""


def test_a_gap_between_front_and_back():
    said = told(lambda h: (speed_of(2.0 * (distance(h) - GAP - 0.4)), 1.5 * wrapped(bearing(h) - h.heading)), "speed")
    assert "from centre to centre, not from the front of one robot" in said


def test_a_list_with_too_few_robots():
    place = {"file": "convoy.launch.py", "line": 9, "count": 3, "said": "NAMES ends at 3"}
    recording = SimpleNamespace(facts=lambda: {"fixed_counts": [place]})
    said = CHECKS.convoy_rows.ends_there(recording, 3, "called with robots:=4")
    assert "convoy.launch.py, line 9: NAMES ends at 3, so no more than 3 robots come" in said
    assert CHECKS.convoy_rows.ends_there(recording, 2, "called with robots:=4") == ""


def test_which_followers_are_missing():
    ends, names = CHECKS.follower_ends, ["robot1", "robot2", "robot3"]
    assert "only the last robot, robot3, has no follower" in ends.missing("robot3", names, ["/robot2/follower"])
    assert "only the last robot, robot3, has a follower" in ends.missing("robot2", names, ["/robot3/follower"])
    assert ends.missing("robot2", names, []) == ""
    assert "2 programs were started, and all are called" in ends.one_name_for_several(2, ["/robot2/follower"])
    assert ends.one_name_for_several(1, ["/robot2/follower"]) == ""


def test_how_often_a_program_was_started():
    texts = ["[INFO] [gz-1]: process started", "[INFO] [python3-6]: process started with pid", "[INFO] [create-3]: x"]
    recording = SimpleNamespace(lines=lambda entity: [SimpleNamespace(text=text) for text in texts])
    assert CHECKS.follower_ends.started(recording) == 1


def test_a_follower_that_falls_silent():
    ends = import_module("gz_course.exercises.11_many_robots.grading.follower_ends")

    def said(until):
        times = {"cmd_vel": np.arange(0.1, until, 0.05), "distance": np.arange(0.0, 7.0, 0.05)}
        signals = {name: SimpleNamespace(times=each * 1e9) for name, each in times.items()}
        place = {"line": 7, "about": "silenced", "said": "so it is"}
        recording = SimpleNamespace(
            signal=lambda name: next(signals[each] for each in signals if each in name),
            facts=lambda: {"suspects": [place]},
        )
        return ends.few(recording, "robot2")

    assert said(0.95) == "its node publishes 17 commands only, and its last command comes at 0.9 s: line 7: so it is"
    assert said(7.0) == ""
