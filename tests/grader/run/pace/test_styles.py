"""A right node is right in every style, and comes out the same each time, also beside busy processes."""

import subprocess
import sys
from pathlib import Path

import pytest

STYLES = Path(__file__).parents[1] / "styles"
EXERCISES = {"teleop_node.py": "03_teleop", "lidar_subscriber.py": "04_lidar_listener"}
GRADINGS, LOAD = 10, 4  # the second half beside busy processes


def exercise_of(style):
    return next(EXERCISES[path.name] for path in (STYLES / style).glob("*.py") if path.name in EXERCISES)


@pytest.mark.proof
@pytest.mark.parametrize("style", sorted(path.name for path in STYLES.iterdir() if path.is_dir()))
def test_one_score_and_one_truth(style, tmp_path, grading):
    exercise, busy, seen = exercise_of(style), [], set()
    try:
        for number in range(GRADINGS):
            if number == GRADINGS // 2:
                busy = [subprocess.Popen([sys.executable, "-S", "-c", "while True: pass"]) for _ in range(LOAD)]
            outcome = grading(tmp_path / str(number), exercise, STYLES / style)
            report = outcome.report
            seen.add((report["score"], report["outcome"], report["pace"], report["truth_sha256"]))
    finally:
        for process in busy:
            process.kill()
            process.wait()
    assert len(seen) == 1, seen
    assert seen.pop()[:3] == (100, "graded", "lockstep")
