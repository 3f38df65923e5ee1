"""The files with the grades of a class: what a platform imports, and an overview of what became of each submission.

- Canvas: the gradebook CSV with one assignment. Students are found by Canvas's own `ID`. The row `Points Possible` must
  agree with Canvas, or the import changes the assignment. A column that Canvas does not know would become a new
  assignment, so `LATE` is there only if the roster has a column of this name.
- Moodle, offline grading worksheet: the worksheet itself, with `Grade` and `Feedback comments` filled in.
- Moodle, grade import: what identifies the student, grade and feedback. One row with an unknown or empty identifier
  makes Moodle refuse or misread the file, so such rows are left out and listed.

Who is not in the file keeps the grade that the platform has. Text is guarded as in the gradebook; feedback is escaped,
because Moodle reads it as HTML.

Source: Canvas, `lib/gradebook_importer.rb`; Moodle, `grade/import/csv/classes/load_data.php` and
`mod/assign/feedback/offline/locallib.php`; MoodleDocs, "Grade import".
"""

from __future__ import annotations

import csv
import html
import io
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.matching import Match
from gz_course.grader.learning_platforms.roster import (
    CALCULATED,
    CANVAS,
    CANVAS_ID,
    EMAIL,
    ID,
    LOGIN,
    NAMES,
    PARTICIPANT_ID,
    POINTS_POSSIBLE,
    WORKSHEET,
    Person,
    Roster,
)
from gz_course.grader.printable import shown
from gz_course.grader.whole_class.final import EXCUSED
from gz_course.grader.whole_class.gradebook import cell
from gz_course.sim.did_you_mean import did_you_mean

LATE = "LATE"
NO_GRADE = "-"  # how platforms write that there is none; no formula
LARGEST_ROUNDING = 4  # decimal places of a scaled score


@dataclass(frozen=True)
class Grades:
    """The result: the file to import, who is in it, who is not and why, and what to do with the file."""

    text: str
    written: tuple[Match, ...]
    left_out: tuple[tuple[Match, str], ...]
    advice: str


def import_file(
    roster: Roster, matches: Iterable[Match], column: str, points: float | None, late: Callable[[Match], str] | None
) -> Grades:
    """Return the file that the platform of the roster imports.

    `column` names the assignment. Full marks are worth `points` there (None: as in the exercise). `late` returns the
    cell of the column LATE (None: no such column). Raises UsageError if the column is not there or the points disagree.
    """
    given = list(matches)
    if not given:
        raise UsageError("the gradebook has no submissions, so there is nothing to export")
    most = given[0].member.row.max_score
    if roster.system == CANVAS:
        layout = _canvas(roster, column, points, most, late)
    elif roster.system == WORKSHEET:
        layout = _worksheet(roster, points, most, late)
    else:
        layout = _moodle(roster, column, late)
    worth = most if points is None else points
    rows, written, left_out = [], [], []
    for each in given:
        if why := _unfit(each, layout):
            left_out.append((each, why))
        else:
            assert each.person is not None
            score = each.member.row.score
            scaled = score if score is None or worth == most else score * worth / most
            text = layout.excused if scaled is None else f"{round(scaled, LARGEST_ROUNDING):.10g}"
            rows.append(layout.row(each.person, text, each))
            written.append(each)
    table = io.StringIO()
    csv.writer(table, lineterminator="\n").writerows([*layout.head, *rows])
    return Grades(table.getvalue(), tuple(written), tuple(left_out), layout.advice)


@dataclass(frozen=True)
class _Layout:
    """What a platform expects: first rows, the row of a person with a score, and why a person cannot have one.

    `excused` is the score of who has none and needs none; empty if the platform has no word for it.
    """

    head: list[list[str]]
    row: Callable[[Person, str, Match], list[str]]
    unfit: Callable[[Person], str]
    advice: str
    excused: str = ""


def _unfit(match: Match, layout: _Layout) -> str:
    if match.person is None:
        return match.why
    if match.member.row.outcome == EXCUSED and layout.excused:
        return layout.unfit(match.person)
    if match.member.row.outcome == EXCUSED:
        return "excused"
    if match.member.row.score is None:
        return f"not graded: {match.member.row.diagnosis}"
    return layout.unfit(match.person)


def _canvas(
    roster: Roster, column: str, points: float | None, most: float, late: Callable[[Match], str] | None
) -> _Layout:
    section = [name.casefold() for name in roster.header].index("section")
    place = _assignment(roster, section, column)
    title = column if place is None else roster.header[place]
    possible = f"{most if points is None else points:g}"
    if place is not None:  # an empty cell leaves Canvas's points as they are
        possible = roster.points[place] if roster.points else ""
        _check_points(possible, points, most, f"{shown(title, 120)} in Canvas")
    mark = roster.column(LATE) if late is not None else None
    kept = [*range(section + 1), *([] if mark is None else [mark])]
    student = roster.header[0].casefold() == "student"

    def row(person: Person, score: str, match: Match) -> list[str]:
        cells = [_safe(person.cells[n]) for n in range(section + 1)]
        cells[0] = cells[0].replace(POINTS_POSSIBLE, POINTS_POSSIBLE.replace(" ", "-")) if student else cells[0]
        cells += [] if mark is None or late is None else [_safe(late(match))]
        return [*cells, score]

    blank = ["" for _ in kept[1:]]
    head = [[*(_safe(roster.header[n]) for n in kept), _safe(title)], [f"    {POINTS_POSSIBLE}", *blank, possible]]
    advice = "In Canvas: Grades, Import."
    if place is None:
        advice += f" The roster has no assignment, so Canvas offers to make a new one called {shown(title, 120)}."
    return _Layout(head, row, lambda person: _no_canvas_id(person), advice, excused="EX")


def _no_canvas_id(person: Person) -> str:
    number = person.ids.get(CANVAS_ID, "")
    return "" if number.isascii() and number.isdecimal() else f"line {person.line} of the roster has no Canvas ID"


def _assignment(roster: Roster, section: int, column: str) -> int | None:
    """Return the place of the assignment called `column`, with or without Canvas's number; None if there are none."""
    read_only = {n for n, text in enumerate(roster.points) if "read only" in text}
    places = [
        n
        for n in range(section + 1, len(roster.header))
        if n not in read_only and not CALCULATED.search(roster.header[n]) and roster.points[n : n + 1] != ("",)
    ]
    named = {roster.header[n]: n for n in places}
    if column in roster.header[section + 1 :]:
        return roster.header.index(column, section + 1)
    plain: dict[str, list[int]] = {}
    for name, n in named.items():
        plain.setdefault(name.rpartition(" (")[0] or name, []).append(n)
    if len(plain.get(column, ())) == 1:
        return plain[column][0]
    if not places:
        return None
    if column in plain:
        raise UsageError(f"several assignments are called {shown(column, 120)}; give --column with the number")
    raise UsageError(
        f"the roster has no assignment {shown(column, 120)!r}; give it with --column"
        + did_you_mean(column, [shown(name, 120) for name in named], listing="its columns are")
    )


def _check_points(theirs: str, points: float | None, most: float, what: str) -> None:
    """Raise UsageError unless the platform's points are those that full marks are worth."""
    try:
        value = float(theirs.replace(",", "."))
    except ValueError:
        return
    if value != (most if points is None else points):
        asked = f"the exercise has {most:g}" if points is None else f"--points says {points:g}"
        raise UsageError(f"{what} is worth {theirs} points, but {asked}; give --points {value:g} to scale the scores")


def _worksheet(roster: Roster, points: float | None, most: float, late: Callable[[Match], str] | None) -> _Layout:
    grade, comments = roster.column("Grade"), roster.column("Feedback comments")
    maximum = roster.column("Maximum Grade")
    assert grade is not None
    for person in roster.people if maximum is not None else ():
        if theirs := person.cells[maximum or 0]:
            _check_points(theirs, points, most, "the assignment in Moodle")
            break

    def row(person: Person, score: str, match: Match) -> list[str]:
        cells = [_safe(each) for each in person.cells]
        cells[grade] = score
        if comments is not None:
            cells[comments] = _feedback(match)
        return [*cells, *([] if late is None else [_safe(late(match))])]

    def unfit(person: Person) -> str:
        return "" if PARTICIPANT_ID in person.ids else f"line {person.line} of the roster has no participant's number"

    head = [[*map(_safe, roster.header), *([] if late is None else [LATE])]]
    without = "" if comments is not None else " The worksheet has no column Feedback comments, so there is no feedback."
    return _Layout(head, row, unfit, f"In Moodle: the assignment, Upload grading worksheet.{without}")


def _moodle(roster: Roster, column: str, late: Callable[[Match], str] | None) -> _Layout:
    kinds = roster.kinds()
    usable = {n: _usable(roster, n) for n in kinds}
    order = (EMAIL, ID, LOGIN)
    by = min(usable, key=lambda n: (-len(usable[n]), order.index(kinds[n])))
    named = [n for n, name in enumerate(roster.header) if name.casefold() in NAMES]
    kept = sorted({*named, *kinds})

    def row(person: Person, score: str, match: Match) -> list[str]:
        cells = [_safe(person.cells[n]) for n in kept]
        return [*cells, score, _feedback(match), *([] if late is None else [_safe(late(match))])]

    def unfit(person: Person) -> str:
        name = roster.header[by]
        return (
            ""
            if person.line in usable[by]
            else (f"on line {person.line} of the roster {shown(name, 60)} is empty, not unique, or a formula")
        )

    title = _safe(column)
    head = [[*(_safe(roster.header[n]) for n in kept), title, f"{title} (Feedback)", *([] if late is None else [LATE])]]
    advice = (
        f"In Moodle: Grades, Import, CSV file. Map from {shown(roster.header[by], 60)}; map {shown(column, 120)} and "
        "its feedback to the same grade item"
    )
    return _Layout(head, row, unfit, advice + (", and ignore LATE." if late is not None else "."))


def _usable(roster: Roster, column: int) -> set[int]:
    """Return the lines of those people whom a column identifies: it is filled, unique, and the same when guarded."""
    seen: dict[str, list[Person]] = {}
    for person in roster.people:
        seen.setdefault(person.cells[column].casefold(), []).append(person)
    return {
        people[0].line
        for text, people in seen.items()
        if text and len(people) == 1 and _safe(people[0].cells[column]) == people[0].cells[column]
    }


def _feedback(match: Match) -> str:
    return cell(html.escape(match.member.row.diagnosis, quote=False))


def _safe(text: str) -> str:
    """Return a cell of the roster, guarded, on one line."""
    return text if text == NO_GRADE else cell(text)


def overview(roster: Roster, grades: Grades, order: Iterable[Match], late: Callable[[Match], list[str]]) -> str:
    """Return a CSV with a line for each student of each submission: who it is, and what became of the grade.

    `late` returns the cells LATE, time of submission, and who says so.
    """
    reasons = {id(each): why for each, why in grades.left_out}
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    head = ["student", "id", "submission", "score", "max_score", "outcome", "roster_line", "roster_name", "matched_by"]
    writer.writerow([*head, LATE, "submitted", "submitted_says", "exported", "reason"])
    for each in order:
        row, person, why = each.member.row, each.person, reasons.get(id(each))
        known = [row.student, each.member.id, row.submission, row.score, row.max_score, row.outcome]
        who = [person.line, person.name, each.why] if person else ["", "", ""]
        writer.writerow([cell(x) for x in [*known, *who, *late(each), "no" if why else "yes", why or ""]])
    return text.getvalue()
