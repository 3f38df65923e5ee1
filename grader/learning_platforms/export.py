"""The export of a class's grades: gradebook, roster and times of submission become the files for a platform."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.learning_platforms.import_file import Grades, import_file, overview
from gz_course.grader.learning_platforms.lateness import UNKNOWN, absolute, lateness, read_deadline
from gz_course.grader.learning_platforms.login_map import read_login_map
from gz_course.grader.learning_platforms.matching import Match, match
from gz_course.grader.learning_platforms.roster import Roster, read_roster
from gz_course.grader.learning_platforms.submission_times import Submitted, submission_times
from gz_course.grader.process.whole_file import write_whole
from gz_course.grader.whole_class.gradebook import read_gradebook
from gz_course.grader.whole_class.platforms import CANVAS, is_late

WORKSHEET_TIME = "%A, %d %B %Y, %I:%M %p"  # of Moodle in English: Thursday, 12 November 2026, 2:33 PM


@dataclass(frozen=True)
class Exported:
    """The grades and the overview, and what to tell: the platform, and how many students there are of each sort."""

    grades: Grades
    overview: str
    system: str
    students: int
    without: int
    late: int


def export(
    exercise: Exercise,
    folder: Path,
    roster_file: Path,
    column: str | None = None,
    points: float | None = None,
    deadline: str | None = None,
    submissions: Path | None = None,
    login_map: Path | None = None,
) -> Exported:
    """Return the grades of the class in `folder`, as `course grade-all` wrote it, for the platform of the roster.

    Raises UsageError if something cannot be read, or if the roster does not fit.
    """
    due = read_deadline(deadline) if deadline is not None else None
    rows = read_gradebook(folder)
    roster = read_roster(roster_file)
    people = read_login_map(login_map) if login_map is not None else None
    times = submission_times(submissions, exercise, people) if submissions is not None else {}
    matches = match(rows, roster)

    def submitted(each: Match) -> Submitted | None:
        row = each.member.row
        return _moodle_time(roster, each) or times.get((row.student, row.submission))

    def late(each: Match) -> str:
        when, row = submitted(each), each.member.row
        if due is None:
            return ""
        if when is None and row.platform == CANVAS:
            return "LATE, says Canvas" if is_late(row.platform, row.submission) else ""
        return lateness(due, when.time if when else None)

    def facts(each: Match) -> list[str]:
        when = submitted(each)
        if when is None:
            return [late(each), "", ""]
        time = when.time if due is None else absolute(when.time, due).astimezone(due.tzinfo)
        return [late(each), time.isoformat(" ", "seconds"), when.said_by]

    grades = import_file(roster, matches, column or exercise.name, points, late if due else None)
    taken = {id(each.person) for each in matches if each.person is not None}
    marks = [late(each) for each in matches]
    return Exported(
        grades,
        overview(roster, grades, matches, facts),
        roster.system,
        len(matches),
        sum(id(person) not in taken for person in roster.people),
        sum(mark not in ("", UNKNOWN) for mark in marks),
    )


def _moodle_time(roster: Roster, each: Match) -> Submitted | None:
    """Return the time in the column "Last modified (submission)" of a worksheet."""
    place = roster.column("Last modified (submission)")
    if place is None or each.person is None:
        return None
    try:
        return Submitted(datetime.strptime(each.person.cells[place], WORKSHEET_TIME), "platform")
    except ValueError:
        return None


def write(path: Path, text: str) -> None:
    """Write a file as a whole or not at all. Raises UsageError if it cannot be written."""
    write_bytes(path, text.encode(errors="replace"))


def write_bytes(path: Path, data: bytes) -> None:
    """Write a file as a whole or not at all. Raises UsageError if it cannot be written."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, data)
    except OSError as error:
        raise UsageError(f"{path} cannot be written: {error.strerror}") from None
