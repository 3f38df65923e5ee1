"""The score is a pure function of recording and manifest; the hash is over the truth alone."""

import dataclasses
import hashlib
import struct

import pytest

from gz_course.grader.exercise import CheckSpec, find_exercise
from gz_course.grader.score.score import TRUTH, score, truth_sha256

PUBLISHER = {
    "node": "/node",
    "kind": "publisher",
    "topic": "/count",
    "type": "std_msgs/msg/Int32",
    "reliability": "RELIABLE",
    "durability": "VOLATILE",
}
POSES = [(0.01, (1.0, 2.0, 0.0, 1.0, 0.0, 0.0, 0.0)), (0.02, (1.5, 2.0, 0.0, 1.0, 0.0, 0.0, 0.0))]


def truth(poses=POSES):
    return {f"truth/robot/{name}": [(t, pose[i]) for t, pose in poses] for i, name in enumerate(TRUTH)}


def check(id, points, low, title="A title"):
    return CheckSpec(id, title, points, "change", (f"Hint for {id}.",), {"signal": "truth/robot/x", "band": [low, 9]})


@pytest.fixture
def exercise(root):
    given = find_exercise("03_teleop", root)
    return dataclasses.replace(given, checks=(check("small", 30, 0.1), check("large", 70, 0.9, "The large one")))


def test_points_diagnosis_and_outcome(record, exercise):
    verdict = score(record(truth()), exercise)
    assert [(c.spec.id, c.points) for c in verdict.checks] == [("small", 30), ("large", 0.0)]
    assert (verdict.points, verdict.outcome) == (30, "graded")
    assert verdict.diagnosis == "The large one: changed by 0.50."


def test_a_whole_number_where_a_float_belongs_is_told_first(record, exercise):
    place = {"file": "node.py", "line": 19, "field": "command.linear.x", "value": "1"}
    diagnosis = score(record(truth(), facts={"whole_numbers": [place]}), exercise).feedback
    assert diagnosis.startswith("node.py, line 19: command.linear.x = 1 is no float, but the field holds one")
    assert diagnosis.endswith("The large one: changed by 0.50.")


def test_full_marks_have_no_diagnosis_whatever_was_odd(record, exercise):
    all_easy = dataclasses.replace(exercise, checks=(check("small", 100, 0.1),))
    verdict = score(record(truth(), facts={"dropped": {"/cmd_vel": 3}}), all_easy)
    assert (verdict.points, verdict.diagnosis) == (100, "")


@pytest.mark.parametrize(("low", "outcome"), [(0.1, "graded"), (0.9, "timeout")])
def test_full_marks_are_never_a_timeout(record, exercise, low, outcome):
    one = dataclasses.replace(exercise, checks=(check("small", 100, low),))
    assert score(record(truth(), facts={"ready": False}), one).outcome == outcome


def test_a_structural_fault_comes_before_the_checks(record, exercise):
    verdict = score(record(truth(), facts={"fault": "node.py, line 3: SyntaxError"}), exercise)
    assert (verdict.diagnosis, verdict.outcome) == ("node.py, line 3: SyntaxError", "student_error")


def test_the_hash_is_what_it_is_said_to_be(record):
    digest = hashlib.sha256()
    for index in range(len(TRUTH)):
        digest.update(struct.pack("<2q", *(round(t * 1e9) for t, _ in POSES)))
        digest.update(struct.pack("<2d", *(pose[index] for _, pose in POSES)))
    assert truth_sha256(record(truth()), "robot") == digest.hexdigest()


def test_the_hash_depends_on_the_truth_and_on_nothing_else(record):
    first = truth_sha256(record(truth()), "robot")
    other = record(truth() | {"topics/cmd_vel/linear/x": [(0, 1.0)]}, lines=[(0, "hello")], seed=5)
    assert truth_sha256(other, "robot") == first
    nudged = [POSES[0], (0.02, (1.5 + 1e-15, *POSES[1][1][1:]))]
    assert truth_sha256(record(truth(nudged)), "robot") != first
    assert truth_sha256(record(truth([POSES[0], (0.03, POSES[1][1])])), "robot") != first
    assert truth_sha256(record(truth(POSES[:1])), "robot") != first


def test_scoring_twice_is_scoring_once(record, exercise):
    recording = record(truth())
    assert score(recording, exercise) == score(recording, exercise)


def test_a_gated_check_is_not_blamed_first(record, exercise):
    gate = {"signal": "truth/robot/x", "reaches": 99, "otherwise": "it never drove"}
    gated = dataclasses.replace(check("huge", 70, 0.9), parameters=check("huge", 70, 0.9).parameters | {"gate": gate})
    both = dataclasses.replace(exercise, checks=(gated, check("small", 30, 0.9, "The small one")))
    assert score(record(truth()), both).diagnosis.startswith("The small one: ")


def test_a_check_that_names_the_misconception_says_more_than_that_nothing_was_published(record, exercise, tmp_path):
    (tmp_path / "checks.py").write_text(
        "from gz_course.grader.score.check import Finding\n"
        "def named(recording, parameters):\n"
        "    return Finding(False, 'one turn', 'it turned twice', explanation=parameters.get('why', ''))\n"
    )
    spec = CheckSpec("turn", "Turns once", 70, "python", "Hint.", {"function": "checks.py:named"})
    silent = record(truth(), facts={"listened": {"/count": "std_msgs/msg/Int32"}, "endpoints": [PUBLISHER]})
    unnamed = dataclasses.replace(exercise, grading=tmp_path, checks=(spec,))
    assert score(silent, unnamed).diagnosis == "Your node has a publisher on /count but never published a message."
    spec = dataclasses.replace(spec, parameters=spec.parameters | {"why": "it jumps at pi"})
    named = dataclasses.replace(unnamed, checks=(spec,))
    assert score(silent, named).diagnosis == "Turns once: it jumps at pi."
    assert score(silent, named).details == "Measured: it turned twice."


def test_where_a_wrong_value_is_made_is_said_if_nothing_else_is_known(record, exercise):
    origins = [{"file": "node.py", "line": 7, "code": "command.linear.x = 0.7"}]
    said = score(record(truth(), facts={"origins": origins}), exercise).feedback
    assert "What your node sends is made in line 7, `command.linear.x = 0.7`." in said
    slip = {"file": "node.py", "line": 3, "said": "that is a slip"}
    assert "line 7" not in score(record(truth(), facts={"origins": origins, "slips": [slip]}), exercise).feedback
