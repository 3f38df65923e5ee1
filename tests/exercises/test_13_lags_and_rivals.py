"""Maps that are drawn by old poses, and mistakes between which more maps decide."""

from importlib import import_module

import numpy as np
import pytest

from gz_course.grader.score.floor import Scans, hits

LAGS = import_module("gz_course.exercises.13_capstone.grading.lags")
RIVALS = import_module("gz_course.exercises.13_capstone.grading.rivals")


def room(poses):
    """Return scans of 60 rays of a robot in the middle of a square room of 4 m, which turns on the spot."""
    angles = -np.pi + np.pi / 30 * np.arange(60)
    direction = poses[:, 2:] + angles
    ranges = 2.0 / np.maximum(np.abs(np.cos(direction)), np.abs(np.sin(direction)))
    return Scans(poses, ranges, angles, np.ones_like(ranges, dtype=bool), 5.0)


@pytest.mark.parametrize(("lag", "words"), [(0, ""), (2, "earlier than the scan"), (-2, "later than the scan")])
def test_scans_that_are_drawn_by_another_pose(lag, words):
    poses = np.stack([np.zeros(40), np.zeros(40), np.linspace(0, 1, 40) ** 2 * 5], 1)
    scan = room(poses)
    marked = LAGS.GRID.cells(hits(scan, pose=LAGS.earlier(poses, lag))) > 0
    solid = LAGS.GRID.cells(hits(scan)) > 0
    said = np.where(marked, 100, 0)
    found = LAGS.drawn_late(said, marked, solid, scan)
    assert words in found if words else found == ""


def test_more_maps_decide_between_two_mistakes():
    first, second = np.zeros((80, 100), dtype=bool), np.zeros((80, 100), dtype=bool)
    first[40, 10:60], second[40, 10:90] = True, True
    hit, half = np.zeros_like(first), second.copy()
    half[40, 60:] = False
    early = [("one", first), ("other", first), ("third", hit)]
    assert RIVALS.best([(first, hit, early)]) == "one of two mistakes: one; or other"
    assert RIVALS.best([(first, hit, early), (second, hit, [("one", half), ("other", second)])]) == "other"
    assert RIVALS.best([(first, first, early)]) == RIVALS.best([]) == ""
