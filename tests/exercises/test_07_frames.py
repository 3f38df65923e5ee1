"""The checks of `07_frames`: every misconception they know is named, and a right answer in any style passes."""

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from gz_course.grader.record.reading import Line, Poses, Signal

CHECKS = import_module("gz_course.exercises.07_frames.grading.checks")
ANSWERED = import_module("gz_course.exercises.07_frames.grading.answered")
EXPLAINED = import_module("gz_course.exercises.07_frames.grading.explained")
RAYS, FIRST, STEP = 61, -2.0, 0.06
UPSIDE_DOWN = (0.94, 0.34, 0.0, 0.0)  # x, y, z, w


class Run:
    """A recording as the checks see it: a robot that stands, drives ahead and turns, and what a node answered."""

    def __init__(self):
        draw = np.random.default_rng(7)
        self.end = 6.0
        now = np.arange(0.0, self.end + 0.5, 0.05)
        rate = np.where(now < 3.0, 0.0, 1.5)
        yaw = 0.3 + np.cumsum(rate) * 0.05
        x, y = (np.cumsum(f(yaw)) * 0.02 for f in (np.cos, np.sin))
        self.signals = {"truth/robot/z": (now, 0 * now), "truth/robot/angular_z": (now, rate)}
        self.signals |= {f"truth/robot/{name}": (now, each) for name, each in (("x", x), ("y", y), ("yaw", yaw))}
        self.signals["topics/tf/count"] = (now[1:], np.ones(len(now) - 1))
        self.at = np.arange(0.1, self.end, 0.1)
        self.rows = draw.uniform(0.8, 4.0, (len(self.at), RAYS))
        self.rows[:, 0] = np.inf
        for name, value in (("angle_min", FIRST), ("angle_increment", STEP), ("range_min", 0.1), ("range_max", 8.0)):
            self.signals[f"topics/scan/{name}"] = (self.at, np.full(len(self.at), value))
        self.signals["topics/scan/header/stamp"] = (self.at, self.at)
        norm = np.linalg.norm(UPSIDE_DOWN)
        self.mount = (0.2, -0.1, 0.3), tuple(v / norm for v in UPSIDE_DOWN)
        self.frame = "odom"
        self.lookups = []

    def answer(self, points, late=0.0, stamps=None, frame="odom"):
        at = self.at + late
        self.signals |= {f"topics/nearest_hit/point/{axis}": (at, points[:, i]) for i, axis in enumerate("xyz")}
        self.signals["topics/nearest_hit/header/stamp"] = (at, self.at if stamps is None else stamps)
        self.signals["topics/nearest_hit/count"] = (at, np.ones(len(at)))
        self.frame = frame
        return self

    def signal(self, name):
        times, values = self.signals.get(name, (np.empty(0), np.empty(0)))
        return Signal(np.round(np.asarray(times) * 1e9).astype(np.int64), np.asarray(values, dtype=float))

    def has(self, name):
        return name in self.signals

    def arrays(self, name):
        return np.round(self.at * 1e9).astype(np.int64), list(self.rows)

    def poses(self, entity):
        return Poses(np.zeros(1), np.array([self.mount[0]]), np.array([self.mount[1]]))

    def lines(self, entity):
        return [Line(0, self.frame, "INFO")] if self.has("topics/nearest_hit/count") else []

    def facts(self):
        return {"lookups": self.lookups}

    def places(self, turning=True):
        return CHECKS.places(self, {"turning": turning})

    @property
    def truth(self):
        return ANSWERED.right(self, ANSWERED.scans(self))


@pytest.mark.parametrize("late", [0.0, 0.02, 0.1])
def test_a_right_answer_passes_whenever_it_comes(late):
    run = Run()
    run.answer(run.truth, late)
    found = [run.places(True), run.places(False), CHECKS.stamps(run, {}), CHECKS.frames(run, {})]
    assert [each.passed for each in found] == [True] * 4, found


def test_silence_earns_nothing():
    run = Run()
    found = [run.places(True), run.places(False), CHECKS.stamps(run, {}), CHECKS.frames(run, {})]
    assert [each.passed for each in found] == [False] * 4


def test_every_misconception_is_named(monkeypatch):
    run = Run()
    scans = ANSWERED.scans(run)
    answered = SimpleNamespace(**vars(scans) | {"answered": scans.arrived + 0.02, "points": scans.hits})
    told = list(EXPLAINED.predictions(run, answered, run.truth))
    assert len(told) > 30
    # They are the same for each answer, but for a few that depend on it and are given as they are here.
    monkeypatch.setitem(EXPLAINED.explanation.__globals__, "predictions", lambda *given: told)
    for words, points in told:
        if words == "always the same":
            continue  # depends on the answer
        off = np.linalg.norm(points - run.truth, axis=1)[-20:]
        if np.nanmean(off > 0.05) < 0.3:
            continue  # nearly the same as right in this run
        known = np.where(np.isnan(points), 9.0, points)
        finding = run.answer(known, late=0.02).places()
        assert not finding.passed and finding.explanation.startswith("your points are "), (words, finding)
        alike = [near for near, other in told if np.allclose(other, points, atol=0.05, equal_nan=True)]
        assert any(near in finding.explanation for near in (words, *alike)), (words, finding.explanation)


def test_the_hit_of_the_scan_that_has_just_come_is_no_hit_of_one_that_waited():
    run = Run()
    scans = ANSWERED.scans(run)
    hits = np.concatenate([scans.hits[1:], scans.hits[-1:]])
    run.answer(ANSWERED.odom(run, scans.stamps).of(scans.mount.of(hits)), late=0.12)
    assert "the hits of the scan that has just come" in run.places().explanation


@pytest.mark.parametrize(
    ("stamps", "words"),
    [
        (lambda at: 0 * at, "are 0"),
        (np.floor, "whole seconds"),
        (lambda at: at + 0.02, "when they were published"),
        (lambda at: np.floor((at + 0.02) * 20) / 20, "latest transform"),
    ],
)
def test_wrong_stamps_are_told_from_wrong_points(stamps, words):
    run = Run()
    run.answer(run.truth, late=0.02, stamps=stamps(run.at))
    finding = CHECKS.stamps(run, {})
    if words != "latest transform":  # which has the time of the scan here
        assert not finding.passed and words in finding.explanation, finding
    assert run.places().passed


def test_points_that_come_with_the_next_scan_and_its_stamp():
    run = Run()
    run.answer(run.truth, late=0.1, stamps=run.at + 0.1)
    said = CHECKS.stamps(run, {}).explanation
    assert "when they were published" in said and "those of the scan that has just come" in said
    assert run.places(True).passed and run.places(False).passed
    run.answer(run.truth, late=0.12, stamps=run.at + 0.1)
    assert "those of the next scan" in CHECKS.stamps(run, {}).explanation


def test_another_frame_is_named():
    run = Run()
    finding = CHECKS.frames(run.answer(run.truth, frame="robot/scanner"), {})
    assert not finding.passed and "in which the point was measured" in finding.explanation


@pytest.mark.parametrize(
    ("lookup", "words"),
    [
        (
            {"line": 30, "frames": ["odom", "laser"], "gives_up": False},
            "line 30 asks for the frame 'laser', which does not",
        ),
        ({"line": 30, "frames": ["/odom"], "gives_up": False}, "do not begin with a slash"),
        ({"line": 28, "frames": ["odom"], "gives_up": True}, "line 28 asks for the transform of the scan's time"),
        ({"line": 28, "frames": ["odom"], "gives_up": False}, ""),
        ({"line": 28, "frames": [], "gives_up": False, "altered": "a.frame_id[1:]"}, "asks for a.frame_id[1:], which"),
    ],
)
def test_silence_is_explained_by_what_the_node_asks_for(lookup, words):
    run = Run()
    run.lookups = [lookup]
    explanation = run.places().explanation
    assert words in explanation and bool(words) == bool(explanation)


def test_points_with_the_stamp_of_another_scan_are_explained_by_when_they_came():
    run = Run()
    odom, found = ANSWERED.odom, ANSWERED.scans(run)
    first = odom(run, np.full(len(run.at), run.at[0])).of(found.mount.of(found.hits))
    run.answer(first, late=0.02, stamps=np.full(len(run.at), run.at[0]))
    assert "a transform that was looked up once" in run.places().explanation


def test_several_points_for_each_scan_and_hits_of_another_ray_are_named():
    run = Run()
    found = ANSWERED.scans(run)
    every = EXPLAINED.other_hits.hits_of(found)
    both = ANSWERED.both_frames(run, found)
    at = np.repeat(run.at, 2)
    points = np.repeat(both.of(np.array([hits[20] for hits in every])), 2, axis=0)
    run.answer(both.of(np.array([hits[20] for hits in every])), late=0.02)
    assert "rightly transformed, but not the nearest ones" in run.places().explanation
    run.signals |= {f"topics/nearest_hit/point/{axis}": (at + 0.02, points[:, i]) for i, axis in enumerate("xyz")}
    run.signals["topics/nearest_hit/header/stamp"] = (at + 0.02, at)
    assert "about 2 points for each scan" in run.places().explanation
    measure = EXPLAINED.other_hits.within(-50.0, 50.0)
    angles = FIRST + STEP * np.arange(RAYS)
    near = EXPLAINED.other_hits.chosen([(hits, angles) for hits in every], measure)
    said = run.answer(both.of(near), late=0.02).places().explanation
    assert "only rays from about -48 to 49 degrees" in said


def test_a_scan_that_is_answered_again_and_again_has_several_points():
    run = Run()
    truth = run.truth
    times = np.concatenate([run.at + late for late in (0.02, 0.07, 0.12)])
    for i, axis in enumerate("xyz"):
        run.signals[f"topics/nearest_hit/point/{axis}"] = (times, np.tile(truth[:, i], 3))
    run.signals["topics/nearest_hit/header/stamp"] = (times, np.tile(run.at, 3))
    run.signals["topics/nearest_hit/count"] = (times, np.ones(len(times)))
    finding = CHECKS.stamps(run, {})
    assert run.places().passed and not finding.passed
    assert "about 3 points for each scan, one after the other" in finding.explanation


@pytest.mark.parametrize(
    ("left_out", "words"),
    [
        (lambda away, angle: away > 1.0, "nearer than about 1.0 m"),
        (lambda away, angle: away < 1.0, "farther than about 1.0 m"),
        (lambda away, angle: np.abs(angle) > 45, "degrees: all rays"),
        (lambda away, angle: np.arange(len(away)) % 2 == 1, "one in 0.2 s, as from a timer"),
        (lambda away, angle: np.arange(len(away)) % 5 < 2, "keep a scan until its transform is there"),
    ],
)
def test_what_scans_without_a_point_have_in_common(left_out, words):
    run = Run()
    found = ANSWERED.scans(run)
    away = np.linalg.norm(found.hits, axis=1)
    away = away / np.median(away)  # some to either side of 1 m
    angle = np.degrees(np.arctan2(found.hits[:, 1], found.hits[:, 0]))
    points = np.where(left_out(away, angle)[:, None], np.nan, run.truth)
    hits = found.hits * (away / np.linalg.norm(found.hits, axis=1))[:, None]
    seen = SimpleNamespace(points=points, stamps=run.at, hits=hits)
    assert words in CHECKS.unanswered.left_out(seen, ~np.isnan(points[:, 0]), run.truth)


def test_rays_of_a_part_of_the_scan_and_transforms_in_the_wrong_order():
    run = Run()
    found, odom = ANSWERED.scans(run), ANSWERED.odom
    polar = ANSWERED.polar
    distance, angle = np.linalg.norm(found.hits, axis=1), np.arctan2(found.hits[:, 1], found.hits[:, 0])
    both = ANSWERED.both_frames(run, found)
    said = run.answer(both.of(polar(distance, angle - 7 * STEP)), late=0.02).places().explanation
    assert "-24 degrees off, 7 rays: the number of a ray is counted" in said
    both_of, shift = both.of(found.hits - (0.2, 0.0, 0.0)), "(-0.20, 0.00, 0.00) m: there a hit is at range * cos"
    assert shift in run.answer(both_of, late=0.02).places().explanation
    best = np.minimum.accumulate(distance)
    said = run.answer(both.of(polar(best, angle)), late=0.02).places().explanation
    assert "begin a new search in each scan" in said
    said = run.answer(found.mount.of(odom(run, run.at).of(found.hits)), late=0.02).places().explanation
    assert "both transforms in the wrong order" in said


def test_points_that_come_only_if_the_hit_has_moved():
    truth = np.zeros((60, 3))
    truth[:, 0] = np.arange(60) * 0.02
    there = np.arange(60) % 5 == 0
    assert "had moved by about 0.10 m" in CHECKS.unanswered._unmoved(there, truth)
    assert CHECKS.unanswered._unmoved(np.random.default_rng(1).random(60) < 0.5, truth) == ""


@pytest.mark.parametrize(
    ("words", "points"),
    [
        ("with x and y alike", lambda run, scans, both, far, angle: both.of(flat(far, angle, np.cos, np.cos))),
        ("opposite of the translation", lambda run, scans, both, far, angle: both.turned(scans.hits) - both.place),
        (
            "a wrong factor or sign",
            lambda run, scans, both, far, angle: half_turned(both.turn, scans.hits) + both.place,
        ),
        (
            "-1.00 + 0.0300 * i for the ray i",
            lambda run, scans, both, far, angle: both.of(flat(far, angle / 2, np.cos, np.sin)),
        ),
        ("divided by 57.3", lambda run, scans, both, far, angle: both.of(flat(far, angle / 57.3, np.cos, np.sin))),
    ],
)
def test_slips_of_formulas(words, points):
    run = Run()
    run.mount = (0.2, -0.1, 0.3), (0.0, 0.0, np.sin(1.0), np.cos(1.0))
    scans = ANSWERED.scans(run)
    both, far = ANSWERED.both_frames(run, scans), np.linalg.norm(scans.hits, axis=1)
    angle = FIRST + STEP * scans.rays
    run.answer(points(run, scans, both, far, angle))
    assert words in run.places().explanation, run.places()


def flat(far, angle, of_x, of_y):
    return np.stack([far * of_x(angle), far * of_y(angle), 0 * far], -1)


def half_turned(turn, hits):
    """Turn points (n, 3) by v + w (u x v) + u x (u x v), without the factors 2; all turns are about z."""
    half = np.arctan2(turn[:, 1, 0], turn[:, 0, 0]) / 2
    u = np.stack([0 * half, 0 * half, np.sin(half)], -1)
    once = np.cross(u, hits)
    return hits + np.cos(half)[:, None] * once + np.cross(u, once)
