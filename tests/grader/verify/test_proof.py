"""What a report on a variant is held against: checks, trials, words. The reports are made by hand."""

import dataclasses
from pathlib import Path

import pytest

from gz_course.grader.edits import Edit
from gz_course.grader.exercise import CheckSpec, find_exercise
from gz_course.grader.exercise.bundle import write
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.report.report import Report, TrialReport
from gz_course.grader.score.check import Finding
from gz_course.grader.score.combined import combined
from gz_course.grader.score.consequences import CheckResult
from gz_course.grader.score.score import Score
from gz_course.grader.verify.declared import Variant
from gz_course.grader.verify.proof import MutantProof, Verification, judge, submitted_file

CHECKS = ("a", "b")


@pytest.fixture
def exercise(root):
    given = find_exercise("03", root)
    specs = tuple(CheckSpec(id, f"Check {id}", 10, "change", ("A hint.",)) for id in CHECKS)
    return dataclasses.replace(given, checks=specs, trials=(Trial("open", 0), Trial("wide", 1)))


def report(exercise, **failed):
    """A report with a trial for each name; `failed` says which checks failed in it."""

    def scored(lost):
        checks = tuple(CheckResult(spec, Finding(spec.id not in lost, "so", "not so")) for spec in exercise.checks)
        return Score(checks, "graded", "Check: not so. A hint." if lost else "", "hash")

    scores = {name: scored(lost) for name, lost in failed.items()}
    trials = tuple(TrialReport(name, 0, score, Path("x.rrd"), "hash") for name, score in scores.items())
    whole = combined(list(scores.items()))
    return Report(exercise.name, "Title", "node.py", Path("x.rrd"), whole, 20, 8.0, 0, {}, None, trials)


def faults(exercise, variant, **failed):
    return judge(exercise, variant, report(exercise, **failed)).faults


def variant(name="rejected/x", fails="a", words=(), trial=None):
    return Variant(name, Path("folder"), frozenset(fails), words, trial)


def test_a_variant_that_loses_what_it_declares(exercise):
    assert faults(exercise, variant(), open="a", wide="a", hidden="a") == []
    assert faults(exercise, variant(), open="a", wide="", hidden="") == [], "one public trial is enough"


def test_more_or_less_than_declared(exercise):
    assert faults(exercise, variant(fails="a"), open="ab") == ["fails b, which it must pass: not so"]
    assert faults(exercise, variant(fails="ab"), open="a") == ["passes b, which it must fail"]


def test_what_only_a_hidden_trial_finds_out_must_be_declared(exercise):
    assert faults(exercise, variant(), open="", wide="", hidden="a") == [
        'passes a in public; say trial = "..." if only a hidden trial can find it out'
    ]
    hidden = variant(trial="hidden")
    assert faults(exercise, hidden, open="", wide="", hidden="a") == []
    assert faults(exercise, hidden, open="", wide="", hidden="a", more="a") == []
    assert faults(exercise, hidden, open="a", wide="", hidden="a") == [
        "fails a in public already, but declares trial = 'hidden'"
    ]
    assert faults(exercise, hidden, open="", wide="", hidden="", more="a") == [
        "passes a in the trial hidden, which must find it out"
    ]


def test_a_starter_earns_nothing_in_any_trial(exercise):
    starter = variant("starter", "ab")
    assert faults(exercise, starter, open="ab", wide="ab") == []
    assert faults(exercise, starter, open="a", wide="b") == [
        "earns 10 points in the trial open; a starter earns nothing",
        "earns 10 points in the trial wide; a starter earns nothing",
    ]


def test_a_solution_must_pass_in_every_trial(exercise):
    solution = variant("solution", "")
    assert faults(exercise, solution, open="", wide="", hidden="") == []
    (fault,) = faults(exercise, solution, open="", wide="", hidden="b")
    assert fault == "fails b, which it must pass: in the trial hidden: not so"


def test_words_stand_in_the_first_line(exercise):
    assert faults(exercise, variant(words=("not so", "hint")), open="a") == []
    first = "'Check: not so. A hint. A hint.'"
    assert faults(exercise, variant(words=("wheel",)), open="a") == [
        f"its first line of feedback does not say 'wheel' (nowhere does it stand): {first}"
    ]


def test_kills_are_counted_by_check(exercise):
    result = Verification(exercise)
    for name, lost in (("starter", "ab"), ("rejected/x", "a"), ("rejected/y", "ab"), ("accepted/z", "b")):
        result.proofs.append(judge(exercise, variant(name, lost), report(exercise, open=lost)))
    mutant = Edit("node.py", 1, "sign", "1", "-1", b"")
    result.mutants = [MutantProof(mutant, frozenset("a")), MutantProof(mutant, frozenset())]
    assert [result.killed_by(check) for check in CHECKS] == [(2, 1), (1, 0)]
    assert result.survivors == [mutant]
    assert result.fault_lines == []
    result.faults.append("no solution")
    result.proofs[1].faults.append("passes a")
    assert result.fault_lines == [f"{exercise.name}: no solution", f"{exercise.name} rejected/x: passes a"]


def test_a_variant_holds_only_the_files_that_differ_from_the_solution(exercise, tmp_path):
    twin = tmp_path / "solutions/03_teleop"
    variant = twin / "rejected/heavy"
    write({"bringup.launch.py": b"solved", "robot.sdf": b"light", "rejected/heavy/robot.sdf": b"heavy"}, twin)
    names = {"file": "bringup.launch.py", "files": ("robot.sdf",)}
    two = dataclasses.replace(exercise, folder=tmp_path / "exercises/03_teleop", **names)
    place = submitted_file(two, Variant("rejected/heavy", variant, frozenset()), tmp_path / "out")
    assert place.read_bytes() == b"solved"
    assert (place.parent / "robot.sdf").read_bytes() == b"heavy"
    assert submitted_file(two, Variant("solution", twin, frozenset()), tmp_path / "out") == twin / "bringup.launch.py"


def test_what_one_misconception_costs(exercise):
    """Of exercises with four checks or more: 10 points each, of which 40 % may be lost."""
    specs = tuple(CheckSpec(id, f"Check {id}", 10, "change", ("A hint.",)) for id in "abcde")
    longer = dataclasses.replace(exercise, checks=specs)

    def said(fails, nothing_runs=""):
        whole = dataclasses.replace(report(longer, open=fails, wide=fails, hidden=fails), max_score=50)
        given = dataclasses.replace(variant(fails=fails), nothing_runs=nothing_runs)
        return judge(longer, given, whole).faults

    assert said("ab") == [] and said("abcd", "it ends with an error") == []
    assert said("abc") == ["loses 30 of 50 points; one misconception costs at most 40%"]
    assert said("ab", "it ends with an error") == ["loses 20 of 50 points: more runs than nothing_runs says"]
    assert faults(exercise, variant(fails="ab"), open="ab", wide="ab", hidden="ab") == [], "two checks are no ladder"
