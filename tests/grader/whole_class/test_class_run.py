"""A class when the machine fails: what is tried again, what is given up, and where a student's files go."""

import csv
import json
from concurrent.futures import Future

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.errors import InfrastructureError, RefusedError, UnreadableError, UsageError
from gz_course.grader.submission.intake import Selection
from gz_course.grader.whole_class import class_run
from gz_course.grader.whole_class.class_run import ClassRun
from gz_course.grader.whole_class.found import Found
from gz_course.grader.whole_class.gradebook import GRADEBOOK
from gz_course.grader.whole_class.grading import Graded
from gz_course.grader.whole_class.journal import JOURNAL
from gz_course.grader.whole_class.students_folder import folder_name


class Machine:
    """Grades as it is told: a list of what comes out for each student, one attempt after another."""

    def __init__(self, exercise, plan):
        self.exercise, self.plan, self.asked = exercise, plan, []

    def submit(self, _, setup, job):
        self.asked.append(job.student)
        future = Future()
        what = self.plan[job.student].pop(0)
        if isinstance(what, Exception):
            future.set_exception(what)
        elif isinstance(what, str):
            future.set_result(Graded(None, fault=what))
        else:
            checks = [{"id": check.id, "points": 0} for check in self.exercise.checks]
            report = {"score": what, "outcome": "graded", "diagnosis": "", "truth_sha256": "t", "checks": checks}
            report |= {"recording": "a.rrd", "trials": [{"recording": "a.rrd"}]}
            future.set_result(Graded(report, {"report.json": json.dumps(report).encode(), "a.rrd": b"run"}))
        return future


@pytest.fixture
def grade(exercise, tmp_path, monkeypatch):
    """Grade students by a plan; returns the results and who was asked for."""

    def run(plan, readers=(), jobs=1, told=lambda *_: None, **options):
        machine = Machine(exercise, {name: list(steps) for name, steps in plan.items()})
        monkeypatch.setattr(ClassRun, "_here", lambda self, jobs, stack: (machine, lambda: jobs, lambda: False))
        readers = dict(readers)
        found = [
            Found(name, "", name, readers.get(name, lambda n=name: Selection(".", "x.py", {"x.py": n.encode()})))
            for name in plan
        ]
        results = ClassRun(exercise, tmp_path / "out", **options).grade(found, told, jobs=jobs)
        return {result["student"]: result for result in results}, machine.asked

    return run


def test_a_fault_of_the_machine_is_tried_again(grade):
    results, asked = grade({"jane": ["it broke", RuntimeError("a worker died"), 65], "bob": [0]})
    assert asked.count("jane") == 3 and results["jane"]["score"] == 65
    assert asked.count("bob") == 1, "what a student lost is not tried again"


def test_a_fault_that_stays_is_listed_and_no_score(grade, tmp_path):
    results, asked = grade({"jane": ["it broke"] * 9, "bob": [30]})
    assert asked.count("jane") == class_run.ATTEMPTS
    assert (results["jane"]["outcome"], results["jane"]["score"]) == ("infra", None)
    assert results["jane"]["diagnosis"] == "not graded: it broke"
    journal = (tmp_path / "out" / JOURNAL).read_text()
    assert "bob" in journal and "jane" not in journal
    results, asked = grade({"jane": [40], "bob": ["never asked"]})
    assert asked == ["jane"] and (results["jane"]["score"], results["bob"]["score"]) == (40, 30)


@pytest.mark.parametrize(
    ("error", "outcome", "score"),
    [
        (UsageError("no file"), "student_error", 0),
        (RefusedError("a bomb"), "protocol", 0),
        (UnreadableError("no permission"), "infra", None),
        (ZeroDivisionError("a bug of ours"), "infra", None),
    ],
)
def test_a_submission_that_cannot_be_read_is_one_line_and_nobody_elses(grade, error, outcome, score):
    def read():
        raise error

    results, asked = grade({"jane": [65], "eve": []}, {"eve": read})
    assert (asked, results["jane"]["score"]) == (["jane"], 65)
    assert (results["eve"]["outcome"], results["eve"]["score"]) == (outcome, score)
    assert str(error) in results["eve"]["diagnosis"]


def test_who_cannot_be_read_has_a_page_too(grade, tmp_path):
    def read():
        raise UsageError("eve holds no <teleop_node.py>")

    grade({"jane": [65], "eve": []}, {"eve": read}, reports=("html",))
    page = (tmp_path / "out/eve/report.html").read_text()
    assert "eve holds no &lt;teleop_node.py&gt;" in page and 'id="by-hand"' in page


def test_the_gradebook_appears_while_the_run_goes_on(grade, tmp_path):
    seen = []

    def told(result, anew):
        data = (tmp_path / "out" / GRADEBOOK).read_bytes()
        assert data.startswith(b"\xef\xbb\xbf"), "Excel reads UTF-8 by this mark"
        rows = csv.DictReader(data.decode("utf-8-sig").splitlines())
        seen.append({row["student"]: (row["score"], row["outcome"]) for row in rows})

    grade({"bob": [0], "jane": [65]}, told=told)
    first, last = seen
    assert sorted(first.values()).count(("", "pending")) == 1, "whoever is graded first"
    assert last == {"bob": ("0", "graded"), "jane": ("65", "graded")}


def test_keep_frees_what_earlier_runs_kept(grade, tmp_path):
    plan = {"full": [100], "jane": [65]}
    kept = lambda: sorted(path.parent.name for path in (tmp_path / "out").glob("*/a.rrd"))  # noqa: E731
    grade(plan)
    assert kept() == ["full", "jane"]
    for keep, left in (("failing", ["jane"]), ("none", [])):
        _, asked = grade(plan, keep=keep)
        assert (asked, kept()) == ([], left)
    report = json.loads((tmp_path / "out/jane/report.json").read_text())
    assert report["recording"] is None and report["trials"] == [{"recording": None}]
    _, asked = grade(plan, keep="all")
    assert sorted(asked) == ["full", "jane"] and kept() == ["full", "jane"]


def test_where_nothing_can_be_graded_we_stop_early(grade, tmp_path):
    plan = {f"student {n}": ["no room on the disk"] * 9 for n in range(40)}
    with pytest.raises(InfrastructureError, match=r"no room on the disk.*no student loses points"):
        grade(plan)
    assert not (tmp_path / "out" / GRADEBOOK).exists()


def test_one_that_can_be_graded_is_enough_to_go_on(grade):
    plan = {"a": [10]} | {f"student {n}": ["it broke"] * 9 for n in range(10)}
    results, _ = grade(plan)
    assert sum(result["outcome"] == "infra" for result in results.values()) == 10


def test_results_whose_files_somebody_deleted_are_graded_again(grade, tmp_path):
    grade({"jane": [65], "bob": [30]})
    (tmp_path / "out/jane/report.json").unlink()
    _, asked = grade({"jane": [65], "bob": [30]})
    assert asked == ["jane"]


@pytest.mark.parametrize("change", [{"seed": 1}, {"reports": ("html",)}, {"demand": "B"}, {"trials": "public"}])
def test_only_the_same_grading_is_not_done_again(exercise, tmp_path, grade, change, monkeypatch):
    grade({"jane": [65]})
    machine = Machine(exercise, {"jane": [70]})
    monkeypatch.setattr(ClassRun, "_here", lambda self, jobs, stack: (machine, lambda: jobs, lambda: False))
    found = [Found("jane", "", "jane", lambda: Selection(".", "x.py", {"x.py": b"jane"}))]
    ClassRun(exercise, tmp_path / "out", **change).grade(found, lambda *_: None)
    assert machine.asked == ([] if change == {"trials": "public"} else ["jane"])


def test_a_folder_that_another_grading_has_taken_is_filled_again(exercise, tmp_path, grade, monkeypatch):
    grade({"jane": [65]})
    machine = Machine(exercise, {"jane": [70]})
    with monkeypatch.context() as patch:
        patch.setattr(ClassRun, "_here", lambda self, jobs, stack: (machine, lambda: jobs, lambda: False))
        found = [Found("jane", "", "jane", lambda: Selection(".", "x.py", {"x.py": b"jane"}))]
        ClassRun(exercise, tmp_path / "out", seed=1).grade(found, lambda *_: None)
    results, asked = grade({"jane": [65]})
    assert asked == ["jane"] and results["jane"]["score"] == 65
    assert json.loads((tmp_path / "out/jane/report.json").read_text())["score"] == 65


def test_another_text_of_the_same_student_is_graded(exercise, tmp_path, grade, monkeypatch):
    grade({"jane": [65]})
    machine = Machine(exercise, {"jane": [70]})
    monkeypatch.setattr(ClassRun, "_here", lambda self, jobs, stack: (machine, lambda: jobs, lambda: False))
    found = [Found("jane", "", "jane", lambda: Selection(".", "x.py", {"x.py": b"jane", "more.py": b""}))]
    (result,) = ClassRun(exercise, tmp_path / "out").grade(found, lambda *_: None)
    assert result["score"] == 70


def test_a_folder_of_somebody_else_is_not_touched(exercise, tmp_path):
    (tmp_path / "thesis.tex").write_text("x")
    with pytest.raises(UsageError, match="not empty"):
        ClassRun(exercise, tmp_path).grade([], lambda *_: None)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


@given(st.text(min_size=1, max_size=200))
def test_a_students_folder_stays_where_it_belongs(name):
    folder = folder_name(name)
    assert "/" not in folder and "\0" not in folder and folder[0] not in ".-@" and len(folder.encode()) <= 120
    assert folder.strip() == folder != "" and folder.casefold() not in (GRADEBOOK, JOURNAL)


@given(st.lists(st.text(max_size=20), unique=True, max_size=8))
def test_two_students_never_share_a_folder(names):
    assert len({folder_name(name) for name in names}) == len(names)


@pytest.mark.parametrize("name", ["Jane Doe", "O.Brien-Smith", "jürgen@x.org", "Al (2)"])
def test_plain_names_stay_readable(name):
    assert folder_name(name) == name
