"""The students of a course as Moodle or Canvas export them: who they are, and in which columns that stands.

Three exports are understood. Canvas: the gradebook (`Student`, `ID`, ...). Moodle: the offline grading worksheet of an
assignment (`Identifier`, `Grade`, ...), or any other list with an email address, an ID number or a username, such as
the grader export.

Source: Canvas, `lib/gradebook_exporter.rb` and `lib/gradebook_importer.rb` (columns and rows of the gradebook CSV);
Moodle, `mod/assign/feedback/offline/importgradeslib.php` (worksheet) and MoodleDocs, "Grade import".
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.spreadsheet import rows_of, text_of
from gz_course.grader.printable import shown

CANVAS, WORKSHEET, MOODLE = "Canvas", "Moodle worksheet", "Moodle"
POINTS_POSSIBLE = "Points Possible"  # marks a row of Canvas that is no student
PARTICIPANT = re.compile(r"\D*(\d+)")  # of the worksheet's column Identifier: Participant 123
# What Canvas calculates itself, with the name of an assignment group before it or a grading period after it.
CALCULATED = re.compile("(Current|Final) (Score|Points|Grade)|Override (Score|Grade|Status)")
ID, LOGIN, EMAIL = "id", "login", "email"  # kinds of what identifies a person
CANVAS_ID, PARTICIPANT_ID = "Canvas ID", "participant"
KINDS = {
    "sis user id": ID,
    "id number": ID,
    "sis login id": LOGIN,
    "username": LOGIN,
    "email address": EMAIL,
    "email": EMAIL,
}
NAMES = ("full name", "student", "name", "first name", "last name", "surname", "firstname", "lastname")


@dataclass(frozen=True)
class Person:
    """A student of the roster: the line in its file, all cells, names as they may be written, and what identifies."""

    line: int
    cells: tuple[str, ...]
    names: tuple[str, ...]
    ids: dict[str, str] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """A name to be shown, or what else there is."""
        return shown(next(iter((*self.names, *self.ids.values())), f"line {self.line}"), 120)


@dataclass(frozen=True)
class Roster:
    """An export of a platform. `points` is Canvas's row with the points possible; empty elsewhere."""

    system: str
    header: tuple[str, ...]
    people: tuple[Person, ...]
    points: tuple[str, ...] = ()

    def column(self, *names: str) -> int | None:
        """Return the place of the first column with one of these names; None without it."""
        lower = [each.casefold() for each in self.header]
        return next((lower.index(name.casefold()) for name in names if name.casefold() in lower), None)

    def kinds(self) -> dict[int, str]:
        """Return column -> kind of what identifies a student in it."""
        return _kinds(self.header, [person.cells for person in self.people])


def read_roster(path: Path) -> Roster:
    """Read a roster. Raises UsageError if it cannot be read or has no column that identifies students."""
    text = text_of(path)
    rows = rows_of(path, text)
    header, *rest = [(line, [cell.strip() for cell in row]) for line, row in rows]
    names = tuple(header[1])
    body = [(line, tuple(row[: len(names)] + [""] * (len(names) - len(row)))) for line, row in rest if any(row)]
    system = _system(names)
    points: tuple[str, ...] = ()
    if system == CANVAS:
        id = [name.casefold() for name in names].index("id")
        points = next((row for _, row in body if POINTS_POSSIBLE in row[0] and not row[id]), ())
        body = [(line, row) for line, row in body if row[id] or (row[0] and POINTS_POSSIBLE not in row[0])]
    kinds = _kinds(names, [row for _, row in body])
    if system == MOODLE and not kinds:
        raise UsageError(
            f"{path} has the columns {shown(', '.join(names))}, but none that identifies students: expected Email "
            "address, ID number or Username (Moodle, with English as the language of the export), or Student and ID "
            "(Canvas)"
        )
    people = tuple(_person(system, names, kinds, line, row) for line, row in body)
    if not people:
        raise UsageError(f"{path} has no students: every line after the header is empty")
    return Roster(system, names, people, points)


def _system(header: tuple[str, ...]) -> str:
    lower = [each.casefold() for each in header]
    canvas = header[0].casefold() == "student" or lower[:2] == ["lastname", "firstname"]
    if canvas and "id" in lower and "section" in lower:
        return CANVAS
    if {"identifier", "grade", "last modified (grade)"} <= set(lower):
        return WORKSHEET
    return MOODLE


def _kinds(header: tuple[str, ...], rows: list[tuple[str, ...]]) -> dict[int, str]:
    """Return column -> kind. A column of email addresses is recognised by its cells, whatever its name is."""
    found = {n: KINDS[name.casefold()] for n, name in enumerate(header) if name.casefold() in KINDS}
    if EMAIL not in found.values():
        for n in range(len(header)):
            filled = [row[n] for row in rows if row[n]]
            if filled and n not in found and all(re.fullmatch(r"[^@\s]+@[^@\s]+", each) for each in filled):
                return found | {n: EMAIL}
    return found


def _person(system: str, header: tuple[str, ...], kinds: dict[int, str], line: int, row: tuple[str, ...]) -> Person:
    by_name = {name.casefold(): row[n] for n, name in enumerate(header) if name.casefold() in NAMES and row[n]}
    whole = by_name.get("full name") or by_name.get("student") or by_name.get("name")
    first = by_name.get("first name") or by_name.get("firstname") or ""
    last = by_name.get("last name") or by_name.get("surname") or by_name.get("lastname") or ""
    names = [whole] if whole else []
    if whole and whole.count(",") == 1:  # Canvas: Doe, Jane
        back, _, front = whole.partition(",")
        names.insert(0, f"{front.strip()} {back.strip()}")
    if first or last:
        names.append(f"{first} {last}".strip())
    ids = {kind: row[n] for n, kind in kinds.items() if row[n]}
    if system == CANVAS and (canvas := row[[each.casefold() for each in header].index("id")]):
        ids[CANVAS_ID] = canvas
    if system == WORKSHEET and (
        match := PARTICIPANT.fullmatch(row[[h.casefold() for h in header].index("identifier")])
    ):
        ids[PARTICIPANT_ID] = match[1]
    return Person(line, row, tuple(names), ids)
