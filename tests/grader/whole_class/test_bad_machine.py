"""A class on a bad machine: a full disk, a quota, a folder that cannot be written, a clock that jumps, a torn journal.

One sentence each; nothing is lost, and nothing is graded twice.
"""

import contextlib
import ctypes
import json
import os
import resource
import shutil
import subprocess

import pytest

from gz_course.grader.errors import InfrastructureError, UsageError
from gz_course.grader.whole_class.class_run import ClassRun
from gz_course.grader.whole_class.gradebook import GRADEBOOK
from gz_course.grader.whole_class.index import INDEX
from gz_course.grader.whole_class.journal import HOLDER, JOURNAL, Journal, read_results
from gz_course.grader.whole_class.kept import readable_size, without_recordings
from gz_course.tests.filled_class import Inventor, fill
from gz_course.tests.generated_class import hand_in

FILE = "teleop_node.py"
JUMPS = """
import itertools, time
real, jumps = time.time, itertools.cycle([0.0, -3e7, 4e7, 1.0, -1e9])
time.time = lambda: real() + next(jumps)
time.time_ns = lambda: int(time.time() * 1e9)
"""


@contextlib.contextmanager
def largest_file(size):
    """Let this process write no file beyond `size` bytes, as a quota does. Source: setrlimit(2), RLIMIT_FSIZE."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def test_a_quota_leaves_no_half_line_in_the_journal(tmp_path):
    with Journal(tmp_path) as journal:
        journal.add("one", {"score": 1, "folder": "a"})
        size = journal.path.stat().st_size
        with largest_file(size + 10), pytest.raises(InfrastructureError, match=r"cannot be written.*the same command"):
            journal.add("two", {"score": 2, "folder": "b"})
        assert journal.path.stat().st_size == size
        journal.add("two", {"score": 2, "folder": "b"})
    assert set(read_results(tmp_path).done) == {"one", "two"} and read_results(tmp_path).damaged == 0


@pytest.mark.parametrize("where", ["report", "journal", "gradebook", "page"])
def test_wherever_the_quota_ends_it_the_same_command_goes_on(tmp_path, where, monkeypatch):
    submissions = hand_in(tmp_path / "class", 6)
    asked = []
    whole = Inventor.submit
    monkeypatch.setattr(Inventor, "submit", lambda self, *words: asked.append(words[2].student) or whole(self, *words))
    fill(submissions, tmp_path / "whole")
    wanted = [(tmp_path / "whole" / name).read_bytes() for name in (GRADEBOOK, INDEX)]
    first = len(asked)
    report = max(path.stat().st_size for path in (tmp_path / "whole").glob("*/*"))
    sizes = {"report": report - 1, "journal": 2 * report, "gradebook": None, "page": None}
    if sizes[where] is not None:
        journal = (tmp_path / "whole" / JOURNAL).stat().st_size
        assert report < sizes["journal"] < journal
        with largest_file(sizes[where]), pytest.raises(InfrastructureError, match="cannot be written"):
            fill(submissions, tmp_path / "out")
    else:
        (tmp_path / "out").mkdir()
        (tmp_path / "out" / JOURNAL).touch()
        taken = tmp_path / "out" / f".{GRADEBOOK if where == 'gradebook' else INDEX}.part"
        taken.mkdir()
        with pytest.raises(InfrastructureError, match=r"the gradebook cannot be written.*in the journal"):
            fill(submissions, tmp_path / "out")
        taken.rmdir()
    done = {result["student"] for result in read_results(tmp_path / "out").all()}
    before = len(asked)
    fill(submissions, tmp_path / "out")
    assert not done & set(asked[before:]) and len(done) + len(asked[before:]) == first == 6
    assert [(tmp_path / "out" / name).read_bytes() for name in (GRADEBOOK, INDEX)] == wanted
    assert not list((tmp_path / "out").glob(".*"))


def test_a_torn_journal_is_told_and_costs_one_grading(tmp_path, monkeypatch):
    submissions = hand_in(tmp_path / "class", 6)
    run = fill(submissions, tmp_path / "out")
    before = (tmp_path / "out" / GRADEBOOK).read_bytes()
    journal = tmp_path / "out" / JOURNAL
    journal.write_bytes(journal.read_bytes()[:-7])
    lines = run.plan([], 1).lines()
    assert "1 line of the journal is damaged or cut off; what is missing is graded again" in lines
    asked = []
    whole = Inventor.submit
    monkeypatch.setattr(Inventor, "submit", lambda self, *words: asked.append(words[2].student) or whole(self, *words))
    fill(submissions, tmp_path / "out")
    assert len(asked) == 1 and len((tmp_path / "out" / GRADEBOOK).read_bytes().splitlines()) == len(before.splitlines())


def test_a_folder_with_the_report_on_similarity_is_no_stranger(exercise, tmp_path):
    submissions = hand_in(tmp_path / "class", 2)
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "similarity.csv").write_text("")
    fill(submissions, tmp_path / "out")
    assert (tmp_path / "out" / GRADEBOOK).exists()


def test_two_instructors_are_told_of_one_another(tmp_path):
    with Journal(tmp_path):
        assert str(os.getpid()) in (tmp_path / HOLDER).read_text()
        with pytest.raises(UsageError, match=rf"another course grade-all is at work in .* on .*process {os.getpid()}"):
            Journal(tmp_path)
        (tmp_path / HOLDER).unlink()
        with pytest.raises(UsageError, match="another course grade-all is at work"):
            Journal(tmp_path)
    assert not (tmp_path / HOLDER).exists()


def test_a_folder_that_cannot_be_written(exercise, tmp_path):
    (tmp_path / "file").write_text("")
    for place in (tmp_path / "file" / "out", tmp_path / "file"):
        with pytest.raises(UsageError, match=r"cannot be used: "):
            ClassRun(exercise, place).grade([], lambda *_: None)


@pytest.mark.parametrize(("keep", "kept"), [("all", 6), ("failing", None), ("none", 0)])
def test_whose_recordings_stay(tmp_path, exercise, keep, kept):
    submissions = hand_in(tmp_path / "class", 6)
    fill(submissions, tmp_path / "out", keep=keep)
    results = read_results(tmp_path / "out").all()
    failing = sum(result["score"] < exercise.max_score for result in results)
    recordings = list((tmp_path / "out").glob("*/*.rrd"))
    assert len(recordings) == (failing if kept is None else kept)
    for result in results:
        folder = tmp_path / "out" / result["folder"]
        report = json.loads((folder / "report.json").read_text())
        assert bool(report["recording"]) == bool(list(folder.glob("*.rrd")))
    again = fill(submissions, tmp_path / "out", keep="all")
    assert len(list((tmp_path / "out").glob("*/*.rrd"))) == 6, "who asks for recordings later gets them"
    assert "6 are done" in again.plan([], 2).lines()[0] or again.plan([], 2).done == 0


def test_sizes_and_reports_without_recordings():
    assert [readable_size(size) for size in (0, 999, 1500, 190_000, 1.94e9, 31e9)] == [
        "0 bytes", "999 bytes", "2 kB", "190 kB", "1.9 GB", "31 GB",
    ]  # fmt: skip
    files = {"report.json": b'{"recording": "a.rrd", "trials": [{"recording": "a.rrd"}]}', "a.rrd": b"", "x.html": b""}
    left = without_recordings(files)
    assert set(left) == {"report.json", "x.html"} and b"a.rrd" not in left["report.json"]


@pytest.fixture
def small_disk(tmp_path):
    """Mount a file system of a few hundred kilobytes; it can be made larger, and read-only."""
    place = tmp_path / "disk"
    place.mkdir()
    if os.geteuid() != 0 or shutil.which("mount") is None:
        pytest.skip("only root can mount")
    done = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", place], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"nothing can be mounted here: {done.stderr.strip()}")
    yield place, lambda options: subprocess.run(["mount", "-o", f"remount,{options}", place], check=True)
    ctypes.CDLL(None).umount2(str(place).encode(), 2)


@pytest.mark.proof
def test_a_full_disk_and_a_read_only_one(course, hand_in, solved, short_course, small_disk, tmp_path):
    place, remount = small_disk
    folder = hand_in({f"{student}/{FILE}": solved for student in ("ada", "bob", "cy", "di", "ed", "flo")})
    course_of = {"COURSE_ROOT": str(short_course)}
    command = ("grade-all", "03", folder, "--out", place / "out", "--jobs", "2")
    full = course(*command, **course_of)
    assert full.code == 3 and "No space left on device" in full.words, full.output
    assert "Traceback" not in full.output and "internal error" not in full.output
    done = len(read_results(place / "out").all())
    assert done < 6
    remount("ro")
    closed = course(*command, **course_of)
    assert closed.code == 2 and "Read-only file system" in closed.words, closed.output
    remount("rw,size=30m")
    whole = course(*command, **course_of)
    assert whole.code == 0 and whole.output.count("(done before)") == done, whole.output
    assert len(read_results(place / "out").all()) == 6
    assert list((tmp_path / "tmp").iterdir()) == []


@pytest.mark.proof
def test_a_full_folder_for_temporary_files_costs_nobody_points(course, hand_in, solved, short_course, small_disk):
    place, remount = small_disk
    folder = hand_in({f"{student}/{FILE}": solved for student in ("ada", "bob")})
    variables = {"COURSE_ROOT": str(short_course), "TMPDIR": str(place)}
    remount("size=60k")
    full = course("grade-all", "03", folder, "--out", "out", "--jobs", "1", **variables)
    assert full.code == 3 and "not the student's fault: ada" in full.words, full.output
    remount("size=60m")
    assert course("grade-all", "03", folder, "--out", "out", "--jobs", "1", **variables).code == 0


@pytest.mark.proof
def test_a_clock_that_jumps_changes_nothing(course, hand_in, solved, short_course, tmp_path):
    folder = hand_in({f"{student}/{FILE}": solved for student in ("ada", "bob", "cy")})
    variables = {"COURSE_ROOT": str(short_course)}
    books = []
    for name, prelude in (("calm", ""), ("jumping", JUMPS)):
        outcome = course("grade-all", "03", folder, "--out", tmp_path / name, prelude=prelude, **variables)
        assert outcome.code == 0, outcome.output
        books.append((tmp_path / name / GRADEBOOK).read_bytes())
        again = course("grade-all", "03", folder, "--out", tmp_path / name, prelude=prelude, **variables)
        assert again.output.count("(done before)") == 3, again.output
    assert books[0] == books[1]
