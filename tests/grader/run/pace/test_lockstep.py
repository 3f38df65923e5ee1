"""Same submission, same seed: same score, same truth, same recording, whatever else the machine does."""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

SUBMISSIONS = {"03_teleop": "solutions/03_teleop/teleop_node.py", "04_lidar_listener": "solutions/04_lidar_listener"}
LOAD = 4  # busy processes beside

pytestmark = pytest.mark.proof  # five gradings an exercise, two of them beside busy processes


@pytest.fixture(scope="module", params=list(SUBMISSIONS))
def graded(request, tmp_path_factory, grading, root):
    """Four gradings of one submission, the last two while the machine is busy."""
    folder = tmp_path_factory.mktemp(request.param)

    def grade(number, *more):
        return grading(folder / str(number), request.param, root / SUBMISSIONS[request.param], *more)

    outcomes = [grade(0), grade(1)]
    busy = [subprocess.Popen([sys.executable, "-S", "-c", "while True: pass"]) for _ in range(LOAD)]
    try:
        with ThreadPoolExecutor(2) as pool:
            outcomes += pool.map(grade, (2, 3))
    finally:
        for process in busy:
            process.kill()
            process.wait()
    outcomes.append(grade("other seed", "--seed", "7"))
    return outcomes


@pytest.fixture(scope="module")
def same(graded):
    return graded[:4]


def test_full_marks_each_time_and_nothing_left(graded, clean):
    for outcome in graded:
        clean(outcome)
        assert (outcome.code, outcome.report["score"]) == (0, 100), outcome.output


def test_one_truth(same):
    hashes = {outcome.report["truth_sha256"] for outcome in same}
    assert len(hashes) == 1
    assert len(hashes.pop()) == 64


def test_every_check_found_the_same(same):
    first, *others = (outcome.report["checks"] for outcome in same)
    assert [checks == first for checks in others] == [True] * 3


def test_all_of_it_was_in_step(same):
    assert {outcome.report["pace"] for outcome in same} == {"lockstep"}


def test_another_seed_is_another_run_where_the_seed_matters(graded):
    exercise = graded[0].report["exercise"]
    differs = graded[4].report["truth_sha256"] != graded[0].report["truth_sha256"]
    assert differs == (exercise == "04_lidar_listener"), "the lidar exercise is driven by the grader, with the seed"


@pytest.fixture(scope="module")
def rerun_binary():
    import rerun_cli

    return str(Path(rerun_cli.__file__).parent / "rerun")


@pytest.mark.parametrize("other", [1, 2])
def test_recordings_are_equal(same, rerun_binary, tmp_path, other):
    environment = os.environ | {"CI": "1", "HOME": str(tmp_path)}

    def rerun(*arguments):
        return subprocess.run(
            [rerun_binary, *map(str, arguments)],
            env=environment, stdin=subprocess.DEVNULL, capture_output=True, timeout=600,
        )  # fmt: skip

    for name, outcome in (("one", same[0]), ("other", same[other])):
        assert rerun("rrd", "verify", outcome.recording).returncode == 0
        done = rerun("rrd", "optimize", outcome.recording, "-o", tmp_path / f"{name}.rrd")
        assert done.returncode == 0, done.stderr.decode()
    compared = rerun("rrd", "compare", tmp_path / "one.rrd", tmp_path / "other.rrd")
    assert compared.returncode == 0, compared.stderr.decode()[-2000:]


def test_scoring_the_recording_gives_the_identical_verdict(same, course, tmp_path):
    before = same[0].report
    outcome = course("score", same[0].recording, "--json", tmp_path / "report.json")
    assert outcome.code == 0, outcome.output
    again = json.loads((tmp_path / "report.json").read_text())
    host = {"sandbox", "pace", "run_wall_seconds", "wall_seconds", "real_time_factor", "submission"}
    assert {k: v for k, v in again.items() if k not in host} == {k: v for k, v in before.items() if k not in host}


def test_real_time_gives_the_same_score(same, grade, root):
    exercise = same[0].report["exercise"]
    outcome = grade(exercise, root / SUBMISSIONS[exercise], "--pace", "realtime")
    assert (outcome.report["score"], outcome.report["pace"]) == (same[0].report["score"], "realtime")
    assert outcome.report["real_time_factor"] <= 1.01
