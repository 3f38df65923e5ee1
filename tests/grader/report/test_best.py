"""The best score so far: kept by `course grade`, found again among whatever else lies below the folder of runs."""

import dataclasses
import json
import os
import re
import threading

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.grader.errors import UsageError
from gz_course.grader.report.best import BEST, MOST_BYTES, best_scores, keep_best, runs_folder
from gz_course.tests.grader.report.handmade import REPORT, result, score_of

DEADLINE = 120.0  # [s]
MOST = {"03_teleop": 100.0, "04_lidar_listener": 100.0}
GOOD = {"exercise": "03_teleop", "score": 60, "max_score": 100, "outcome": "graded"}


@pytest.fixture
def put(tmp_path):
    """Put a report (or bytes) below the folder of runs: `put(where, **keys)`."""

    def write(where="a/report.json", data=None, **keys):
        path = tmp_path / where
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(json.dumps(GOOD | keys).encode() if data is None else data)
        return path

    return write


def test_the_best_of_each_exercise_wherever_its_report_lies(put, tmp_path):
    put(score=60)
    put("b/c/d.json", score=72.5)
    put("best.json", score=10)
    put("e.json", score=0, exercise="04_lidar_listener")
    put("f.json", exercise="99_of_another_course")
    best = best_scores(tmp_path, MOST)
    assert best.scores == {"03_teleop": 72.5, "04_lidar_listener": 0.0} and best.stale == set()


def test_no_folder_no_scores(tmp_path):
    assert best_scores(tmp_path / "nowhere", MOST).scores == {}


def test_reports_of_other_points_are_stale(put, tmp_path):
    put(score=90, max_score=90)
    best = best_scores(tmp_path, MOST)
    assert (best.scores, best.stale) == ({}, {"03_teleop"})


@pytest.mark.parametrize(
    "wrong",
    [
        {"score": 101}, {"score": -1}, {"score": True}, {"score": "90"}, {"score": None}, {"score": float("nan")},
        {"score": float("inf"), "max_score": float("inf")}, {"score": 10**400, "max_score": 10**400},
        {"max_score": [100]}, {"exercise": ["03_teleop"]}, {"exercise": {}},
    ],
    ids=str,
)  # fmt: skip
def test_what_cannot_be_a_score_does_not_count(put, tmp_path, wrong):
    put(**wrong)
    put("good.json", score=20)
    best = best_scores(tmp_path, MOST)
    assert (best.scores, best.stale) == ({"03_teleop": 20.0}, set())


DAMAGED = [b"", b"{", b"\xff\xfe", b"[" * 100_000, b"9" * 5000, b'"03_teleop"', b"[]", b"null", b"\0" * 100]


@pytest.mark.parametrize("data", DAMAGED, ids=lambda data: repr(data[:8]))
def test_damaged_files_are_passed_over(put, tmp_path, data):
    put("bad.json", data)
    put("good.json", score=20)
    assert best_scores(tmp_path, MOST).scores == {"03_teleop": 20.0}


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60, deadline=None)
@given(st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=9),
    lambda inner: st.lists(inner, max_size=3)
    | st.dictionaries(st.sampled_from([*GOOD, "x"]), inner | st.sampled_from(list(GOOD.values())), max_size=5),
    max_leaves=12,
))  # fmt: skip
def test_whatever_json_there_is_a_score_is_one(put, tmp_path, data):
    put("any.json", json.dumps(data).encode())
    assert all(0 <= score <= MOST[name] for name, score in best_scores(tmp_path, MOST).scores.items())


def test_pipes_folders_and_giants_are_no_reports(put, tmp_path):
    """A pipe would wait for its writer, a link to a folder could lead round in circles."""
    os.mkfifo(tmp_path / "pipe.json")
    (tmp_path / "folder.json").mkdir()
    (tmp_path / "round").symlink_to(tmp_path)
    (tmp_path / "gone.json").symlink_to(tmp_path / "nothing")
    put("huge.json", json.dumps(GOOD).encode().ljust(MOST_BYTES + 1))
    put("good.json", score=20)
    found = []
    reader = threading.Thread(target=lambda: found.append(best_scores(tmp_path, MOST).scores), daemon=True)
    reader.start()
    reader.join(DEADLINE)
    assert found == [{"03_teleop": 20.0}]


def of(passed, **more):
    score = score_of(result("good", True), result("bad", passed))
    return dataclasses.replace(REPORT, score=score, **more)


def test_a_worse_report_does_not_take_the_place_of_a_better_one(tmp_path):
    def kept():
        return json.loads((tmp_path / BEST).read_text())

    keep_best(of(False, submission="first"), tmp_path)
    assert (kept()["score"], kept()["submission"]) == (50, "first")
    keep_best(of(True, submission="second"), tmp_path)
    keep_best(of(False, submission="third"), tmp_path)
    assert (kept()["score"], kept()["submission"]) == (100, "second")
    keep_best(of(True, submission="fourth"), tmp_path)
    assert kept()["submission"] == "fourth"
    assert [path.name for path in tmp_path.iterdir()] == [BEST]


@pytest.mark.parametrize("there", [{"score": 90, "max_score": 90}, {"exercise": "04_lidar_listener", "score": 90}])
def test_a_stale_or_foreign_best_gives_way(put, tmp_path, there):
    put(BEST, **there)
    keep_best(of(False), tmp_path)
    assert best_scores(tmp_path, MOST).scores == {"03_teleop": 50.0}


def test_a_best_that_cannot_be_written_is_said_and_leaves_nothing(tmp_path):
    (tmp_path / BEST / "x").mkdir(parents=True)
    with pytest.raises(UsageError, match=r"cannot write .*best\.json"):
        keep_best(of(True), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == [BEST]


def listed(course, *arguments):
    outcome = course("list", *arguments)
    assert outcome.code == 0 and "internal error" not in outcome.output, outcome.output
    return outcome


@pytest.mark.proof
def test_grading_keeps_the_best_and_the_list_shows_it(course, root, tmp_path):
    """The whole way: full marks, then a file that cannot even run."""
    assert re.search(r"01_two_transports +100 +- +(0/\d +)?topics.yaml", listed(course).stdout)
    assert course("grade", "01", "--submission", root / "solutions/01_two_transports").code == 0
    bad = tmp_path / "topics.yaml"
    bad.write_text("- ros_topic: /clock\n  ros_tpye: x\n")
    assert course("grade", "01", "--submission", bad).code == 1
    assert course("grade", "03", "--submission", bad, "--out", tmp_path / "runs/elsewhere").code == 1
    shown = listed(course).stdout
    assert re.search(r"01_two_transports +100 +100 +(0/\d +)?topics.yaml", shown)
    assert re.search(r"03_teleop +100 +- +0/\d +teleop_node.py", shown)
    assert "best score so far: 100" in listed(course, "01").stdout
    assert sorted(path.name for path in (tmp_path / "runs/01_two_transports").iterdir()) == [
        "01_two_transports.html",
        "01_two_transports.rrd",
        BEST,
    ]


def test_the_runs_stand_beside_the_exercises_wherever_one_is(tmp_path, monkeypatch):
    monkeypatch.delenv("COURSE_RUNS", raising=False)
    monkeypatch.delenv("COURSE_ROOT", raising=False)
    (tmp_path / "exercises/01_x/grading").mkdir(parents=True)
    (tmp_path / "exercises/01_x/grading/exercise.toml").touch()
    (tmp_path / "chapters/01_x").mkdir(parents=True)
    for folder, shown in ((".", "runs"), ("chapters/01_x", "../../runs"), ("exercises", "../runs")):
        monkeypatch.chdir(tmp_path / folder)
        assert str(runs_folder()) == shown
    monkeypatch.chdir("/")
    monkeypatch.setenv("COURSE_ROOT", str(tmp_path))
    assert runs_folder() == tmp_path / "runs"
    monkeypatch.setenv("COURSE_RUNS", "/elsewhere")
    assert str(runs_folder()) == "/elsewhere"


def test_the_list_says_what_is_stale_and_survives_the_rest(course, put, tmp_path):
    put("mine/a.json", score=90, max_score=90)
    put("mine/b.json", b"[" * 100_000)
    put("mine/c.json", score=80, exercise="04_lidar_listener")
    outcome = listed(course, "--runs", tmp_path / "mine")
    assert re.search(r"03_teleop +100 +- ", outcome.stdout) and re.search(r"04_\w+ +100 +80 ", outcome.stdout)
    assert "03_teleop had other points when it was graded; grade it again." in outcome.words
    assert "04_lidar_listener had" not in outcome.words
    wrong = course("list", "--runs", tmp_path / "mien")
    assert wrong.code == 2 and "there is no folder" in wrong.words


def test_a_folder_in_place_of_the_best_is_said_before_anything_runs(course, root, tmp_path):
    (tmp_path / "runs/03_teleop" / BEST).mkdir(parents=True)
    outcome = course("grade", "03", "--submission", root / "solutions/03_teleop")
    assert outcome.code == 2 and "best.json" in outcome.words and "score:" not in outcome.output
