"""A term of two exercises and 30 students, from hand-out to final grades; every number is worked out by hand here.

Exercise 00 comes from three platforms, exercise 03 from one that tells times and keeps attempts. A fifth of the
students hands in the released starter, two fifths the solution.
"""

import csv
import io
import subprocess
import sys
import zipfile

import pytest

from gz_course.tests.grader.learning_platforms.classes import (
    MOODLE_HEAD,
    WORKSHEET_HEAD,
    comments_taken_by_canvas,
    feedback_taken_by_moodle,
    imported_by_canvas,
    imported_by_moodle,
    parsed,
    table,
)

pytestmark = [pytest.mark.proof, pytest.mark.timeout(2400)]

STUDENTS = range(1, 31)
HELLO, TELEOP = "00_first_run", "03_teleop"
FILES = {HELLO: "hello_node.py", TELEOP: "teleop_node.py"}
# What student n hands in, by n % 5, and what it earns: of 100 points, and in 03 of 110 after the change of a check.
HANDED_IN = {
    HELLO: ["solution", "wrong_text", "never_stops_speaking", "starter", "solution"],
    TELEOP: ["solution", "turns_right", "kilometres_per_hour", "starter", "solution"],
}
HELLO_POINTS = [100, 80, 80, 0, 100]  # what is said, and once: 20 points each
TELEOP_POINTS = [100, 70, 65, 0, 100]  # both checks of turning: 15 + 15; of driving: 20 + 15
# Stopping is worth 30 instead of 20 points, which all but the starter's students earn.
CHANGED_POINTS = [110, 80, 75, 0, 110]
CLASS = 'deadline = "2026-11-20 23:59 UTC"\nlate = "10 % a day, 3 days"\nattempts = "best"\n'
DAYS_LATE = {26: 1, 27: 2, 28: 3, 29: 4, 30: 2}
OVERRIDES = (
    "\ufeffStudent;Exercise;Check;Points;Comment;Excuse;Deadline;By\r\n"  # as Excel writes it
    "Student 1;03_teleop;turns_left;15;seen in the recording;;;Ada\r\n"
    "Student 13;03;;;ill;yes;;\r\n"
    "1030;;;;;;2026-11-27 23:59 UTC;\r\n"
)


def wanted_teleop(points, day):
    """Return what each student's grade in 03 is; a day of lateness costs `day` points."""
    grades = {n: float(points[n % 5]) for n in STUDENTS}
    grades[1] += 15  # by hand
    grades[13] = None  # excused
    for n, days in DAYS_LATE.items():
        grades[n] = max(0.0, grades[n] - days * day)
    grades[29] = 0.0  # four days are too many
    grades[30] = float(points[0])  # the extension
    grades[5] = float(points[0])  # the first of two attempts; the second turns right
    return grades


@pytest.fixture
def term(root, tmp_path):
    """Run a command of `course` in the term's folder; its exit code must be as given."""

    def run(*words, code=0, course=tmp_path / "course"):
        done = subprocess.run(
            [sys.executable, "-m", "gz_course.grader", *map(str, words)],
            cwd=tmp_path, env={"PATH": "/usr/bin:/bin", "HOME": str(tmp_path), "COURSE_ROOT": str(course)},
            capture_output=True, text=True, timeout=1200, check=False,
        )  # fmt: skip
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout

    return run


def copy_of_the_course(root, folder):
    """Write the two exercises with their private halves, so that a check can be changed."""
    for name in FILES:
        for half in ("exercises", "solutions"):
            for path in sorted((root / half / name).rglob("*")):
                if path.is_file() and "__pycache__" not in path.parts:
                    (folder / path.relative_to(root)).parent.mkdir(parents=True, exist_ok=True)
                    (folder / path.relative_to(root)).write_bytes(path.read_bytes())


def submission(root, released, exercise, what):
    file = FILES[exercise]
    if what == "starter":
        return (released / "exercises" / exercise / file).read_bytes()
    private = root / "solutions" / exercise
    return (private / file if what == "solution" else private / "rejected" / what / file).read_bytes()


def zipped(path, files):
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


def scores(folder):
    with (folder / "gradebook.csv").open(newline="", encoding="utf-8-sig") as stream:
        rows = list(csv.DictReader(stream))
    return {row["student"]: float(row["score"]) if row["score"] else None for row in rows}


def names_in(path):
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name).decode() for name in archive.namelist()}


def test_a_term(root, term, tmp_path):
    copy_of_the_course(root, tmp_path / "course")
    term("release", tmp_path / "students", course=root)
    assert not list((tmp_path / "students").rglob("trials.toml"))

    def work(n, exercise):
        return submission(root, tmp_path / "students", exercise, HANDED_IN[exercise][n % 5])

    hello(term, tmp_path, lambda n: work(n, HELLO))
    teleop(term, tmp_path, lambda n: work(n, TELEOP), submission(root, tmp_path, TELEOP, "turns_right"))


def hello(term, folder, work):
    """Grade exercise 00 from three platforms, and give grades and feedback back to two of them."""
    moodle = zipped(
        folder / "moodle.zip",
        {f"Student {n}_{100 + n}_assignsubmission_file_/hello_node.py": work(n) for n in range(1, 11)},
    )
    canvas = zipped(
        folder / "canvas.zip", {f"student{n}_{200 + n}_9{n}_hello_node-1.py": work(n) for n in range(11, 21)}
    )
    github = zipped(
        folder / "github.zip",
        {f"00-hello-login{n}/exercises/00_first_run/hello_node.py": work(n) for n in range(21, 31)},
    )
    (folder / "logins.csv").write_text(
        table(["login", "student"], *[[f"Login{n}", f"Student {n}"] for n in range(21, 31)])
    )
    term("grade-all", "00", moodle, "--out", "m", "--trials", "all", "--html")
    term("grade-all", "00", canvas, "--out", "c")
    term("grade-all", "00", github, "--out", "g", "--map", "logins.csv")
    assert scores(folder / "m") == {f"Student {n}": HELLO_POINTS[n % 5] for n in range(1, 11)}
    assert scores(folder / "c") == {f"student{n}": HELLO_POINTS[n % 5] for n in range(11, 21)}
    assert scores(folder / "g") == {f"Student {n}": HELLO_POINTS[n % 5] for n in range(21, 31)}

    people = [[f"Participant {100 + n}", f"Student {n}", *[""] * 3, "100.00", *[""] * 4] for n in range(1, 11)]
    (folder / "worksheet.csv").write_text(table(WORKSHEET_HEAD, *people))
    term("export", "00", "m", "--roster", "worksheet.csv", "--out", "m.csv")
    name, grade = WORKSHEET_HEAD.index("Full name"), WORKSHEET_HEAD.index("Grade")
    grades = {row[name]: float(row[grade]) for row in parsed((folder / "m.csv").read_text())[1:]}
    assert grades == {f"Student {n}": HELLO_POINTS[n % 5] for n in range(1, 11)}
    term("feedback", "m", "--for", "moodle", "--roster", "worksheet.csv", "--out", "m.zip")
    pages = names_in(folder / "m.zip")
    assert feedback_taken_by_moodle(pages, {100 + n for n in range(1, 11)}) == {
        100 + n: ["feedback.html"] for n in range(1, 11)
    }
    for n in range(1, 11):
        page = pages[f"Student {n}_{100 + n}_assignsubmission_file_/feedback.html"]
        assert f"{HELLO_POINTS[n % 5]} of 100 points" in page and "slower_clock" not in page

    head = ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "00_first_run (7)"]
    rows = [[f"{n}, Student", 200 + n, "", "", "A", ""] for n in range(11, 21)]
    (folder / "canvas.csv").write_text(table(head, ["Points Possible", "", "", "", "", "100"], *rows))
    term("export", "00", "c", "--roster", "canvas.csv", "--out", "c.csv")
    grades, possible = imported_by_canvas((folder / "c.csv").read_text(), {200 + n for n in range(11, 21)})
    assert possible == "100"
    assert {n: float(grades[200 + n]) for n in range(11, 21)} == {n: HELLO_POINTS[n % 5] for n in range(11, 21)}
    term("feedback", "c", "--for", "canvas", "--out", "c.zip")
    texts = names_in(folder / "c.zip")
    attachments = {200 + n: int(f"9{n}") for n in range(11, 21)}
    assert comments_taken_by_canvas(texts, attachments) == attachments
    for n in range(11, 21):
        assert (
            f"# Your grade: {HELLO_POINTS[n % 5]} of 100 points." in texts[f"student{n}_{200 + n}_9{n}_hello_node-1.py"]
        )


def teleop(term, folder, work, second):
    """Grade exercise 03 with late ones, attempts, an extension and changes by hand; change a check, and score again."""
    files = {}
    for n in STUDENTS:
        day = 20 + DAYS_LATE.get(n, 0)
        files[f"{1000 + n}-7 - Student {n} - Nov {day}, 2026 1030 PM/teleop_node.py"] = work(n)
    files["1005-7 - Student 5 - Nov 20, 2026 1040 PM/teleop_node.py"] = second
    (folder / "t").mkdir()
    (folder / "t/class.toml").write_text(CLASS)
    (folder / "t/overrides.csv").write_text(OVERRIDES, encoding="utf-8")
    term("grade-all", "03", zipped(folder / "brightspace.zip", files), "--out", "t", "--html")
    assert scores(folder / "t") == {f"Student {n}": grade for n, grade in wanted_teleop(TELEOP_POINTS, 10).items()}

    manifest = folder / "course/exercises/03_teleop/grading/exercise.toml"
    before, id, after = manifest.read_text().partition('id = "stops"')
    assert id and "points = 20" in after.partition("[[check]]")[0]
    manifest.write_text(before + id + after.replace("points = 20", "points = 30", 1))
    told = term("rescore", "03", "t")
    # All but the six starters changed, and the earlier attempt of student 5.
    assert told.splitlines()[-1] == "25 changed, 6 did not, 0 left", told
    wanted = wanted_teleop(CHANGED_POINTS, 11)
    assert wanted[1] == 95 and (wanted[26], wanted[27], wanted[30]) == (69, 53, 110)
    assert scores(folder / "t") == {f"Student {n}": grade for n, grade in wanted.items()}
    again = term("grade-all", "03", "brightspace.zip", "--out", "t", "--html", "--plan")
    assert "31 submissions, 1 trial each" in again and "31 are done" in again  # student 5 has two

    term("feedback", "t", "--for", "zip", "--out", "t.zip")
    texts = names_in(folder / "t.zip")
    for n, grade in wanted.items():
        said = "no grade" if grade is None else f"{grade:g} of 110 points"
        assert f"Your grade: {said}." in texts[f"Student {n}/feedback.txt"]
    assert "seen in the recording" in texts["Student 1/feedback.txt"]
    assert "attempt 1 of 2 counts" in texts["Student 5/feedback.txt"]

    people = [["Student", str(n), str(1000 + n), f"s{n}@x.edu", ""] for n in STUDENTS]
    (folder / "list.csv").write_text(table(MOODLE_HEAD, *people))
    told = term("export", "03", "t", "--roster", "list.csv", "--out", "t.csv", code=1)
    assert "29 of 30 students" in told and "Student 13" in told and "excused" in told
    grades = imported_by_moodle(
        (folder / "t.csv").read_text(), "Email address", {f"s{n}@x.edu" for n in STUDENTS}, TELEOP
    )
    assert {name: float(grade) for name, (grade, _) in grades.items()} == {
        f"s{n}@x.edu": grade for n, grade in wanted.items() if grade is not None
    }
    assert len(io.StringIO((folder / "t/gradebook.csv").read_text(encoding="utf-8-sig")).readlines()) == 31
