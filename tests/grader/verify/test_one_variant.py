"""`course verify` of one variant: the reason of a WRONG at once, and what a fault in an author's check leaves."""

import re
import shutil

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.check_fault import CheckFault, trace_of
from gz_course.grader.verify import kept as keeping
from gz_course.grader.verify.jobs import Job
from gz_course.grader.verify.kept import Kept
from gz_course.grader.verify.proof import plan, planned_jobs

NAME = "00_first_run"
FAULTY = """
def broken(recording, parameters):
    return deeper(recording.signal("topics/hello/count"))

def deeper(signal):
    return signal.vlaues
"""


@pytest.fixture
def copy(tmp_path, root):
    """The folder of a course with one exercise."""
    for half in ("exercises", "solutions"):
        shutil.copytree(root / half / NAME, tmp_path / half / NAME)
    return tmp_path


def test_a_wrong_variant_says_why(copy, course, clean):
    expect = copy / "solutions" / NAME / "expect.toml"
    name = re.search(r"\[rejected\.(\w+)\]", expect.read_text())[1]
    shutil.copy(copy / "solutions" / NAME / find_exercise(NAME, copy).file, copy / f"solutions/{NAME}/rejected/{name}")
    outcome = course("verify", f"00/rejected/{name}", COURSE_ROOT=str(copy))
    clean(outcome)
    assert outcome.code == 1, outcome.output
    wrong = [line for line in outcome.stdout.splitlines() if line.startswith("WRONG")]
    assert any(f"rejected/{name}: passes" in line for line in wrong), outcome.stdout
    assert "100 of 100 points" in outcome.words
    assert "accepted/" not in outcome.output, "nothing else is graded"


def test_a_variant_that_does_not_exist(copy, course):
    outcome = course("verify", "00/rejected/misspelt", COURSE_ROOT=str(copy))
    assert outcome.code == 2 and "no variant 'rejected/misspelt'" in outcome.words


def test_a_path_is_still_called_one(copy, course):
    outcome = course("verify", f"exercises/{NAME}", COURSE_ROOT=str(copy))
    assert outcome.code == 2 and "is a path" in outcome.words


def test_a_fault_in_an_authors_check_leaves_recording_and_traceback(copy, course, clean):
    folder = copy / "exercises" / NAME / "grading"
    (folder / "faulty.py").write_text(FAULTY)
    check = '[[check]]\nid = "odd"\ntitle = "Odd"\npoints = 5\nhint = "Think."\n'
    manifest = folder / "exercise.toml"
    text = manifest.read_text()
    manifest.write_text(
        text.replace("[[check]]", f'{check}kind = "python"\nfunction = "faulty.py:broken"\n\n[[check]]', 1)
    )
    outcome = course("verify", "00/solution", COURSE_ROOT=str(copy))
    clean(outcome)
    assert outcome.code == 3, outcome.output
    assert re.search(r"faulty\.py, line 6: AttributeError", outcome.stderr), outcome.stderr
    (recording,) = (copy / f"runs/verify/{NAME}.faults").glob("*.rrd")
    assert str(recording) in outcome.stderr
    assert len(Recording(recording).signal("topics/hello/count")), "the run is complete"
    traceback = trace_of(recording).read_text()
    assert "line 3, in broken" in traceback and "line 6, in deeper" in traceback
    assert "/grader/" not in traceback, "it begins with the author's line"
    # The repaired check is tried on the recording, without a run.
    (folder / "faulty.py").write_text(FAULTY.replace("vlaues", "values"))
    again = course("score", recording, COURSE_ROOT=str(copy))
    assert again.code == 3 and "must return a Finding" in again.stderr


def test_a_fault_goes_from_process_to_process_as_it_is(tmp_path):
    import pickle

    fault = CheckFault("checks.py, line 3: KeyError: 'x'", "Traceback", tmp_path / "x.rrd")
    again = pickle.loads(pickle.dumps(fault))
    assert (str(again), again.trace, again.recording) == (str(fault), fault.trace, fault.recording)


@pytest.fixture
def graded(copy, monkeypatch):
    """`graded(planned_jobs)`: run them all; the names of those that were really graded."""
    from gz_course.grader.report.report import Report
    from gz_course.grader.score.score import Score

    monkeypatch.setenv("COURSE_RUNS", str(copy / "runs"))
    calls = []

    def grade(exercise, file, out, *, trials):
        calls.append(out.name)
        return Report(NAME, "", str(file), out / "x.rrd", Score((), "graded", "", ""), 1.0, 1.0, 0, {})

    monkeypatch.setattr("gz_course.grader.verify.jobs.grade", grade)

    def run(jobs):
        calls.clear()
        reports = [job.run() for job in jobs]
        assert all(report.exercise == NAME for report in reports)
        return list(calls)

    return run


def test_what_was_graded_is_not_graded_again_until_something_changes(copy, graded, tmp_path, monkeypatch):
    def jobs(most=0):
        exercise = find_exercise(NAME, copy)
        kept = Kept(exercise, None)
        return kept, planned_jobs(plan(exercise, most), tmp_path / "out", kept)

    kept, every = jobs()
    assert isinstance(every[0], Job)
    assert graded(every[:3]) == [job.out.name for job in every[:3]], "then it is interrupted"
    kept, every = jobs()
    assert [job.done for job in every[:4]] == [True, True, True, False]
    assert graded(every) == [job.out.name for job in every[3:]]
    # One variant is changed: that one alone is graded again.
    changed = every[-1].file
    changed.write_text(changed.read_text() + "\n# changed\n")
    kept, every = jobs()
    assert graded(every) == [every[-1].out.name]
    # A torn file, and another version of the course.
    every[0].kept.write_bytes(b"torn")
    assert graded(every) == [every[0].out.name]
    monkeypatch.setattr(keeping, "code_stamp", lambda: "another")
    assert len(graded(jobs()[1])) == len(every)
    kept.forget()
    assert not any(job.done for job in jobs()[1])
