"""Exercises about the graphs, graded for real: in step, always the same, their own node is not the student's fault."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from gz_course.grader.record.reading import Recording

BRIDGES, TABLES = "05_yaml_bridge", "01_two_transports"


def rejected(root, exercise, fault):
    (folder,) = (root / "solutions" / exercise / "rejected").glob(fault)
    return folder


@pytest.mark.proof
@pytest.mark.parametrize("fault", ["both_ways_lidar", "best_effort_scan", "wrong_way_command"])
def test_a_wrong_bridge_does_not_bring_the_run_out_of_step(grade, root, fault):
    outcome = grade(BRIDGES, rejected(root, BRIDGES, fault))
    assert (outcome.code, outcome.report["outcome"], outcome.report["pace"]) == (1, "graded", "lockstep")


@pytest.mark.proof
def test_equal_runs_give_equal_recordings(grading, clean, root, tmp_path):
    import rerun_cli

    rerun = Path(rerun_cli.__file__).parent / "rerun"
    outcomes = [grading(tmp_path / name, TABLES, root / "solutions" / TABLES / "topics.yaml") for name in ("a", "b")]
    for outcome in outcomes:
        clean(outcome)
        assert outcome.code == 0, outcome.output
    one, other = (Recording(outcome.recording).facts() for outcome in outcomes)
    assert one == other
    compared = subprocess.run(
        [rerun, "rrd", "compare", "--unordered", *(outcome.recording for outcome in outcomes)],
        env=os.environ | {"CI": "1", "HOME": str(tmp_path)},
        capture_output=True,
        timeout=600,
    )
    assert compared.returncode == 0, compared.stderr.decode()[-1000:]


def test_a_table_is_told_its_first_wrong_row(grade, root, tmp_path):
    outcome = grade(
        TABLES, rejected(root, TABLES, "gazebo_names_first"),
        "--html", tmp_path / "report.html", "--gradescope", tmp_path / "results.json",
    )  # fmt: skip
    assert (outcome.code, outcome.failed()) == (1, {"rows"})
    assert "line 27: /lidar is what Gazebo calls it; in ROS it has another name" in outcome.report["diagnosis"]
    own = Recording(outcome.recording)
    assert "on patrol" in "".join(line.text for line in own.lines("log/given_node"))
    assert own.lines("log/student") == [], "a table says nothing"
    for name in ("report.html", "results.json"):
        text = (tmp_path / name).read_text().replace("&#39;", "'")
        assert "What the exercise's own node said" in text and "on patrol" in text and "your node said" not in text


def test_a_file_that_is_no_table_is_graded_without_a_run(grade, tmp_path):
    file = tmp_path / "topics.yaml"
    file.write_text("- ros_topic: /clock\n  ros_tpye: x\n")
    outcome = grade(TABLES, file)
    assert (outcome.code, outcome.report["score"], outcome.report["outcome"]) == (1, 0, "student_error")
    assert "topics.yaml, line 2: there is no column 'ros_tpye'; did you mean 'ros_type'?" in outcome.words


@pytest.mark.proof
def test_a_bridge_without_a_clock_still_leaves_a_recorded_world(grade, root):
    outcome = grade(BRIDGES, root / "exercises" / BRIDGES)
    assert (outcome.code, outcome.report["score"]) == (1, 0)
    assert len(Recording(outcome.recording).signal("truth/robot/x")) > 100


@pytest.mark.parametrize(
    ("text", "how"),
    [
        pytest.param("raise SystemExit(3)", "exit code 3", marks=pytest.mark.proof),
        (None, "has no given_node.py"),
    ],
)
def test_an_exercises_own_node_that_fails_is_the_authors_fault(grade, root, tmp_path, text, how):
    folder = tmp_path / "course" / "exercises" / TABLES
    shutil.copytree(root / "exercises" / TABLES, folder)
    if text is None:
        (folder / "given_node.py").unlink()
    else:
        (folder / "given_node.py").write_text(text)
    outcome = grade(TABLES, root / "solutions" / TABLES / "topics.yaml", COURSE_ROOT=str(tmp_path / "course"))
    assert (outcome.code, outcome.report) == (3, None)
    assert how in outcome.words and "given_node.py" in outcome.words
