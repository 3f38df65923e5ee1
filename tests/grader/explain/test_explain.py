"""The search for the change that helps, and what is said of it."""

import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from gz_course.grader.edits import edits_of
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.bundle import digest
from gz_course.grader.explain.explanation import Explanation, explain
from gz_course.grader.explain.order import ordered
from gz_course.grader.explain.search import search
from gz_course.grader.explain.sentence import KINDS, group, kind, sentences
from gz_course.grader.explain.task import vocabulary, words_of
from gz_course.grader.explain.trials import Outcome, Trials
from gz_course.grader.explain.tried import with_trial
from gz_course.grader.report.report import Report
from gz_course.grader.score.score import Score
from gz_course.grader.whole_class.grading import gradings_end_here

MAIN = "teleop_node.py"
EXERCISE = find_exercise("03_teleop")
DEGREES = (EXERCISE.twin / "rejected/degrees" / MAIN).read_bytes()


def checks(**failed):
    """All checks as a report has them; those named here failed, with what was measured."""
    return tuple(
        {
            "id": each.id,
            "title": each.title,
            "points": 0 if each.id in failed else each.points,
            "status": "failed" if each.id in failed else "passed",
            "expected": "angular.z on /cmd_vel between 0.02 and 0.3 rad/s for at least 4.7 s",
            "measured": failed.get(each.id, "so it did"),
        }
        for each in EXERCISE.checks
    )


def outcome(**failed):
    found = checks(**failed)
    return Outcome(sum(each["points"] for each in found), found)


class Played:
    """Trials whose outcome a function of the file's text decides."""

    def __init__(self, judge, most=400):
        self.judge, self.most, self.spent, self.count = judge, most, 0.0, 0

    def grade(self, files, *, explained=False):
        self.count += 1
        return self.judge(files[MAIN].decode())

    def run(self, tried):
        for number, files in enumerate(tried):
            if self.count >= self.most:
                return
            yield number, self.grade(files)


def found_by(judge, content=DEGREES, most=400):
    *_, last = search(EXERCISE, {MAIN: content}, MAIN, Played(judge, most), lambda edit: None)
    return last


def turning(text):
    try:
        value = float(re.search(r"angular\.z = (\S+)", text)[1])
    except (TypeError, ValueError):
        return None
    return outcome() if 0.02 < value < 0.3 else outcome(commands_left=f"mostly {value:.2f} rad/s", turns_left="far")


def test_the_line_that_decides_is_found_and_the_answer_is_not_given_away():
    found = found_by(turning)
    said = sentences(found, {MAIN: DEGREES}, 100, shown=False)
    assert said[0].startswith("Line 27 decides it: with another number for command.angular.z")
    assert said[0].endswith("your program earns 100 of 100 (tried).")
    assert found.trials < 60
    assert not [each for each in said if found.changes[0].edits[0].now in each]
    shown = sentences(found, {MAIN: DEGREES}, 100, shown=True)
    assert f"5.7 -> {found.changes[0].edits[0].now}" in shown[-1]


def test_a_change_that_loses_a_check_is_no_help():
    def judge(text):
        return outcome(stops="no stop") if "angular.z = 5.7" not in text else turning(text)

    found = found_by(judge)
    assert found.changes == []
    assert found.nearest is not None
    said = " ".join(sentences(found, {MAIN: DEGREES}, 100, shown=False))
    assert "none helps by itself" in said
    assert 'loses "Stops and stays stopped"' in said


def test_two_changes_that_are_needed_together():
    def judge(text):
        failed = {}
        if "linear.x = 0.5\n" in text:
            failed["commands_forward"] = "mostly 0.50"
        if turning(text) is None or turning(text).failed:
            failed["commands_left"] = "mostly 5.70"
        return outcome(**failed)

    found = found_by(judge)
    assert found.full_marks
    said = sentences(found, {MAIN: DEGREES}, 100, shown=False)
    assert said[0].startswith("Lines 26 and 27 decide it: with ")


def test_nothing_is_said_that_was_not_tried():
    assert "Nothing was tried" in sentences(found_by(turning, most=1), {MAIN: DEGREES}, 100, shown=False)[0]


def test_what_the_task_speaks_of():
    failed = [each for each in checks(commands_left="mostly 5.70 rad/s") if each["status"] == "failed"]
    known = vocabulary(EXERCISE, failed)
    assert known.numbers[0] == 0.16, "the middle of the band comes first"
    assert known.ratios[0] == pytest.approx(0.16 / 5.7, rel=1e-3)
    assert "/cmd_vel" in known.topics
    assert "geometry_msgs/msg/Twist" in known.types
    assert {"angular", "left"} <= words_of(EXERCISE, failed)


def test_lines_that_the_report_names_come_first():
    files = {MAIN: DEGREES}
    edits = edits_of(MAIN, DEGREES, vocabulary(EXERCISE, []))
    assert ordered(edits, files, f"{MAIN}, line 18: a timer", set(), set())[0].line == 18
    assert ordered(edits, files, "", {"angular"}, {"linear"})[0].line == 27


def test_an_entry_of_a_bridge_is_named_by_its_first_line():
    text = b"- ros_topic_name: /a\n  direction: BIDIRECTIONAL\n- ros_topic_name: /b\n  direction: BIDIRECTIONAL\n"
    edits = edits_of("bridge.yaml", text, vocabulary(EXERCISE, []))
    first = ordered(edits, {"bridge.yaml": text}, "bridge.yaml:3: both ways", set(), set())[:4]
    assert {each.line for each in first} == {3, 4}


def test_every_kind_of_edit_has_words():
    used = {edit.operator for name in ("node.py", "bridge.yaml", "x.xml") for edit in _all(name)}
    assert used <= KINDS.keys()


def test_a_kind_of_change_says_no_word_twice():
    text = b"- direction: BIDIRECTIONAL\n  lazy: true\n"
    said = {each.operator: kind(each, text) for each in edits_of("bridge.yaml", text, vocabulary(EXERCISE, []))}
    assert said["direction"] == "another direction"
    assert said["switch"] == "the other truth value"


def _all(name):
    texts = {
        "bridge.yaml": b"- a: /x\n  b: GZ_TO_ROS\n- c: true\n",
        "x.xml": b'<a b="1"/><c>${d / 2}</c><e f="true" g="/h"/>',
    }
    known = vocabulary(EXERCISE, [])
    if name in texts:
        return edits_of(name, texts[name], known)
    return [edit for path in EXERCISE.twin.parent.glob("*/*.py") for edit in edits_of("n.py", path.read_bytes(), known)]


def test_what_the_change_of_a_group_is_called_has_no_name_of_one_program():
    found = found_by(turning)
    assert group(found, {MAIN: DEGREES}) == "another number for angular.z"


def test_a_change_that_leaves_something_to_do_helps_and_does_not_decide():
    def judge(text):
        failed = {each["id"]: each["measured"] for each in turning(text).failed} if turning(text) else {"stops": "x"}
        return outcome(five_seconds="4 s", **failed)

    said = sentences(found_by(judge, most=80), {MAIN: DEGREES}, 100, shown=False)
    assert said[0].startswith("Line 27 helps: with another number for command.angular.z")
    assert said[-1].startswith("Then this is still to do: ")


def reported(diagnosis):
    return Report(
        "03_teleop", "Teleop", "x.py", Path("x.rrd"), Score((), "graded", diagnosis, "", "More."), 100, 1, 0, {}
    )


@pytest.mark.parametrize(
    ("diagnosis", "stays"),
    [("Line 27: degrees.", True), ("It turns too fast.", True), (f"{MAIN}, line 12: publish() comes late.", False)],
)
def test_what_a_trial_has_shown_is_said_before_what_the_text_suggests(diagnosis, stays):
    explanation = Explanation(("Line 27 decides it (tried).",), found_by(turning), True, 1.0, files={MAIN: DEGREES})
    score = with_trial(reported(diagnosis), explanation).score
    assert score.diagnosis == "Line 27 decides it (tried)."
    assert (diagnosis in score.details) == stays


def test_a_search_without_a_find_leaves_the_first_sentence():
    explanation = Explanation(("3 of 9 were tried.",), found_by(lambda _: outcome(stops="no")), False, 1.0)
    score = with_trial(reported("Line 12: it never stops."), explanation).score
    assert (score.diagnosis, score.details) == ("Line 12: it never stops.", "More. 3 of 9 were tried.")


def test_outcomes_are_kept_and_read_again(tmp_path):
    kept = tmp_path / "explained.json"
    trials = Trials(EXERCISE, MAIN, 1.0, "auto", kept)
    trials._known["key"] = outcome(stops="no")
    trials.keep()
    assert Trials(EXERCISE, MAIN, 1.0, "auto", kept)._known["key"].failed == outcome(stops="no").failed
    files = {MAIN: DEGREES}
    trials._known[digest(files)] = replace(outcome(), said="so")
    assert trials.grade(files) is trials.grade(files, explained=True)
    kept.write_text('{"same": 1}')
    assert Trials(EXERCISE, MAIN, 1.0, "auto", kept)._known == {}


@pytest.mark.proof
@pytest.mark.parametrize(("variant", "line"), [("turns_right", 27), ("wrong_topic", 16)])
def test_a_wrong_program_is_run_until_one_change_mends_it(variant, line, tmp_path):
    path = EXERCISE.twin / "rejected" / variant / MAIN
    command = [sys.executable, "-m", "gz_course.grader", "explain", "03", "--submission", str(path), "--budget", "120"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=900, check=False)
    assert f"Line {line} decides it" in done.stdout, done.stderr
    assert "100 of 100 (tried)" in done.stdout
    assert done.returncode == 0


@pytest.mark.proof
def test_a_class_is_grouped_by_what_would_help(tmp_path):
    for student, variant in (("ada", "turns_right"), ("bo", "turns_right"), ("cy", "")):
        (tmp_path / "class" / student).mkdir(parents=True)
        source = EXERCISE.twin / "rejected" / variant / MAIN if variant else EXERCISE.starter
        (tmp_path / "class" / student / MAIN).write_bytes(source.read_bytes())
    command = [sys.executable, "-m", "gz_course.grader", "grade-all", "03", "class", "--out", "out", "--explain"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=900, check=False)
    assert done.returncode == 0, done.stderr
    assert "ada: Line 27 decides it: with another sign" in done.stderr
    page = (tmp_path / "out/index.html").read_text()
    assert '"groups":[["another sign for angular.z",2]]' in page
    again = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=900, check=False)
    assert "decides" not in again.stderr, "it was done before"


@pytest.mark.proof
def test_a_trial_is_a_grading_in_a_box(tmp_path):
    files = {MAIN: (EXERCISE.twin / MAIN).read_bytes()}
    with gradings_end_here():
        trials = Trials(EXERCISE, MAIN, 60.0, "auto", None)
        assert trials.grade(files).failed == []
        [(number, again)] = trials.run([files])
    assert (number, again.points, trials.count) == (0, 100, 2)


def test_what_cannot_run_yet_is_told_so_and_not_searched(tmp_path):
    (tmp_path / MAIN).write_text("def f(:\n")
    broken = explain(EXERCISE, tmp_path / MAIN, 1.0)
    assert "line 1" in broken.sentences[0] and not broken.solved
    starter = explain(EXERCISE, EXERCISE.starter, 1.0)
    assert starter.found is None and "teleop_node.py" in starter.sentences[0]
