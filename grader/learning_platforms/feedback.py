"""What students get back of a class, in the form that a platform takes: `course feedback`.

- Moodle: a zip with a folder `NAME_ID_assignsubmission_file_` for each, as its own export has. Moodle finds a student
  by the number alone, and a group has numbers of its own, so a student must be in the grading worksheet by both.
- Canvas: a zip of the names that it gave to the files. Canvas attaches each to a comment under the name of the
  student's own file, so the feedback is text in comments of Python. Its gradebook CSV takes no comments.
- zip: a folder for each. mail-merge: a CSV file with a line for each person.

What is told is that of `grader/report/seen.py`. The page of a grading, which has pictures of all trials, goes along
only where nothing is left out of it.

Source: Moodle, `mod/assign/feedback/file/importziplib.php`; Canvas, `infer_comment_context_from_filename`, and Canvas
Guides, "How do I upload all student submissions for an assignment?".
"""

from __future__ import annotations

import csv
import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise, find_exercise
from gz_course.grader.exercise.visibility import AFTER
from gz_course.grader.learning_platforms.feedback_text import as_page, as_text, commented
from gz_course.grader.learning_platforms.matching import Match, match, members
from gz_course.grader.learning_platforms.roster import EMAIL, PARTICIPANT_ID, WORKSHEET, Roster
from gz_course.grader.printable import shown
from gz_course.grader.report.format import formats
from gz_course.grader.report.seen import Rules, Seen, rules_of, seen
from gz_course.grader.whole_class.gradebook import Row, cell, read_gradebook
from gz_course.grader.whole_class.grading import REPORT
from gz_course.grader.whole_class.late_policy import read_policy
from gz_course.grader.whole_class.overrides import read_overrides
from gz_course.grader.whole_class.platforms import CANVAS, FORMS
from gz_course.grader.whole_class.students_folder import folder_name

TARGETS = ("moodle", "canvas", "zip", "mail-merge")
ADVICE = {
    "moodle": "In Moodle: the assignment, Upload multiple feedback files in a zip.",
    "canvas": "In Canvas: the assignment, Upload Submissions; each student gets a comment with the file.",
    "zip": "A folder for each student.",
    "mail-merge": "A line for each student; the column feedback has the text.",
}
FIRST_DAY = (1980, 1, 1, 0, 0, 0)  # of zip: equal feedback gives equal bytes


@dataclass(frozen=True)
class Feedback:
    """The feedback for one student: the row of the gradebook, as text and as a page."""

    row: Row
    text: str
    page: bytes


@dataclass(frozen=True)
class Made:
    """The file, for how many students it is, who is left out and why, and what to tell besides."""

    data: bytes
    count: int
    left_out: Mapping[str, str]
    advice: str


def make_feedback(
    folder: Path, target: str, hidden: str, roster: Roster | None = None, now: datetime | None = None
) -> Made:
    """Return the file for a platform from the folder of a class, as `course grade-all` wrote it.

    `roster` names the students, for Moodle by the number in its worksheet, for a mail merge with an address. `now` is
    the time that is compared with the deadline. Raises UsageError if something cannot be read or nobody has feedback.
    """
    if target == "moodle" and (roster is None or roster.system != WORKSHEET):
        raise UsageError("for Moodle, give --roster with the grading worksheet of the assignment: it has the numbers")
    rows = read_gradebook(folder)
    exercise = exercise_of(folder, rows)
    dues, at = _deadlines(folder, exercise, rows), now or datetime.now(UTC)
    rules = {due: rules_of(exercise, hidden, due) for due in (False, True)}
    left_out: dict[str, str] = {}
    found = []
    for row in rows:
        due = row.student in dues and at > dues[row.student]
        if each := _of_student(folder, exercise, row, rules[due]):
            found.append(each)
        else:
            left_out[row.student] = f"not graded: {row.diagnosis}" if row.score is None else "there is no report"
    matches = match([each.row for each in found], roster) if roster is not None else []
    if target == "mail-merge":
        data, count = _mail_merge(found, matches), sum(len(members(each.row)) for each in found)
    else:
        data, count = _zip(target, found, matches, left_out)
    if not count:
        raise UsageError(f"there is no feedback for {target}: {shown(next(iter(left_out.values()), 'no submissions'))}")
    return Made(data, count, left_out, ADVICE[target] + _without_deadline(rules[False], dues))


def _zip(
    target: str, found: Sequence[Feedback], matches: Sequence[Match], left_out: dict[str, str]
) -> tuple[bytes, int]:
    """Return a zip for a platform, and for how many students it is; `left_out` gets the others."""
    numbers = {id(each.member.row): each.person.ids.get(PARTICIPANT_ID, "") for each in matches if each.person}
    files: dict[str, str | bytes] = {}
    count = 0
    for each in found:
        made = _files(target, each, numbers)
        if isinstance(made, str):
            left_out[each.row.student] = made
        else:
            files |= made
            count += 1
    return _zipped(files), count


def exercise_of(folder: Path, rows: Sequence[Row]) -> Exercise:
    """Return the exercise that a class was graded in, as its reports say. Raises UsageError if there is none."""
    for row in rows:
        try:
            return find_exercise(str(json.loads((folder / row.folder / REPORT).read_bytes())["exercise"]))
        except (OSError, ValueError, KeyError, TypeError):
            continue
    raise UsageError(f"{folder} has no {REPORT} of a student; give the folder that course grade-all wrote (--out)")


def _deadlines(folder: Path, exercise: Exercise, rows: Sequence[Row]) -> dict[str, datetime]:
    """Return the deadline of each student, with extensions; empty if the class has none."""
    policy = read_policy(folder)
    if policy is None or policy.deadline is None:
        return {}
    own = read_overrides(folder, exercise, {row.student: row.id for row in rows})
    extended = {each.student: each.deadline for each in own if each.deadline is not None}
    return {row.student: extended.get(row.student) or policy.deadline for row in rows}


def _without_deadline(rules: Rules, dues: Mapping[str, datetime]) -> str:
    """Return a warning if something is shown after a deadline that the class does not have."""
    if dues or AFTER not in {*rules.checks.values(), *rules.trials.values()}:
        return ""
    return " There is no deadline in class.toml, so what is shown after the deadline is left out."


def _of_student(folder: Path, exercise: Exercise, row: Row, rules: Rules) -> Feedback | None:
    place = folder / row.folder
    try:
        report = json.loads((place / REPORT).read_bytes())
        told: Seen = seen(report, rules)
    except (OSError, ValueError, KeyError, TypeError):
        return None
    page = place / formats()["html"].file
    title = f"{exercise.name}: {exercise.title}"
    own = as_page(title, row, told).encode()
    return Feedback(row, as_text(title, row, told), page.read_bytes() if told.whole and page.is_file() else own)


def _files(target: str, each: Feedback, numbers: Mapping[int, str]) -> dict[str, str | bytes] | str:
    """Return the files of a student in the zip for a platform, by name; or why there are none."""
    row = each.row
    if target == "zip":
        place = folder_name(row.student)
        return {f"{place}/feedback.txt": each.text, f"{place}/feedback.html": each.page}
    if target == "canvas":
        form = FORMS[CANVAS].fullmatch(row.submission) if row.platform == CANVAS else None
        if form is None or form["attachment"] is None:
            return "Canvas has not named a file of this submission, and takes comments only to its own names"
        return {row.submission: commented(each.text)}
    if not (number := numbers.get(id(row), "")):
        return "no participant of the worksheet has its number and its name"
    name = " ".join(row.student.replace("_", " ").replace("/", " ").split())
    return {f"{name}_{number}_assignsubmission_file_/feedback.html": each.page}


def _mail_merge(found: Sequence[Feedback], matches: Sequence[Match]) -> bytes:
    """Return a CSV file that spreadsheets and mail programs open: UTF-8 with a byte order mark."""
    address = {(id(each.member.row), each.member.name, each.member.id): each.person for each in matches}
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(["student", "id", "email", "score", "max_score", "feedback"])
    for each in found:
        for member in members(each.row):
            person = address.get((id(each.row), member.name, member.id))
            email = person.ids.get(EMAIL, "") if person is not None else ""
            known = [member.name or each.row.student, member.id, email, each.row.score, each.row.max_score]
            lines = "\n".join(cell(line) for line in each.text.splitlines())
            writer.writerow([*map(cell, known), lines])
    return text.getvalue().encode("utf-8-sig")


def _zipped(files: Mapping[str, str | bytes]) -> bytes:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            archive.writestr(zipfile.ZipInfo(name, FIRST_DAY), files[name], zipfile.ZIP_DEFLATED)
    return stream.getvalue()
