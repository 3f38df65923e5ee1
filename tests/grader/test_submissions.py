"""Golden submissions: each folder in `cases/` is graded by a real `course grade`, and must come out as it says.

A case is one file to submit and `expected.toml`: `outcome`, `exit` code, `points` and ids of the `fails` (both may be
left out), the `words` its diagnosis must hold; `duration` [s] shortens the exercise;
`proof = true` where `make verify` runs the case and `make test` one that is like it. After each, nothing may be left.
"""

import os
import shutil
import tomllib
from pathlib import Path

import pytest

CASES = Path(__file__).parent / "cases"
CASE_NAMES = sorted(path.parent.name for path in CASES.glob("*/expected.toml"))
TEXTBOOK = Path(__file__).parents[3] / "shared" / "seeds" / "code"


def expected(name):
    return tomllib.loads((CASES / name / "expected.toml").read_text())


def case_param(name):
    return pytest.param(name, marks=pytest.mark.proof if expected(name).get("proof") else ())


def shorter_course(root, folder, exercise, duration):
    """A course with one exercise that lasts `duration` seconds, with the usual ticks."""
    copy = folder / "exercises" / exercise
    shutil.copytree(root / "exercises" / exercise, copy)
    manifest = copy / "grading/exercise.toml"
    lines = manifest.read_text().splitlines()
    lines = [
        f"duration = {duration}" if line.startswith("duration = ") else line
        for line in lines
        if not line.startswith("tick = ")
    ]
    manifest.write_text("\n".join(lines))
    return folder


@pytest.mark.parametrize("case", [case_param(name) for name in CASE_NAMES])
def test_a_submission_comes_out_as_its_case_says(case, tmp_path, grade, root):
    want, options = expected(case), {}
    if "duration" in want:
        options["COURSE_ROOT"] = str(shorter_course(root, tmp_path / "course", want["exercise"], want["duration"]))
    outcome = grade(want["exercise"], CASES / case / want["file"], **options)
    assert outcome.code == want["exit"], outcome.output
    report = outcome.report
    assert report is not None, outcome.output
    assert report["outcome"] == want["outcome"], report["diagnosis"]
    if "points" in want:
        assert report["score"] == want["points"], outcome.output
    if "fails" in want:
        assert outcome.failed() == set(want["fails"])
    assert [word for word in want["words"] if word not in report["diagnosis"]] == [], report["diagnosis"]
    assert "\x1b" not in outcome.output and "\x07" not in outcome.output
    assert outcome.recording.is_file()


@pytest.mark.proof
@pytest.mark.skipif(not TEXTBOOK.is_dir(), reason="the textbook's files are not beside the repository")
def test_the_textbook_teleop_counts_ticks_and_is_told(grade):
    outcome = grade("03_teleop", TEXTBOOK / "teleop_node.py")
    assert (outcome.code, outcome.report["score"], outcome.failed()) == (1, 65, {"stops", "five_seconds"})
    assert "self.elapsed += 0.1: your node counts ticks" in outcome.report["diagnosis"]


@pytest.mark.proof
@pytest.mark.skipif(not TEXTBOOK.is_dir(), reason="the textbook's files are not beside the repository")
def test_the_textbook_lidar_listener_earns_the_log_part_and_is_told_what_it_lacks(grade):
    outcome = grade("04_lidar_listener", TEXTBOOK / "lidar_subscriber.py")
    assert (outcome.code, outcome.report["score"], outcome.report["outcome"]) == (1, 60, "graded")
    assert outcome.failed() == {"arrives", "publishes_nearest"}
    assert "no publisher on /nearest_obstacle" in outcome.report["diagnosis"]


@pytest.mark.proof
def test_a_file_name_that_is_not_utf8_is_no_internal_error(tmp_path, root, grade):
    name = os.fsdecode(b"tele\xffop.py")
    shutil.copy(root / "solutions/03_teleop/teleop_node.py", tmp_path / name)
    outcome = grade("03_teleop", tmp_path / name)
    assert outcome.code in (0, 2), outcome.output
