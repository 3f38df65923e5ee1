"""Changes made by hand: `overrides.csv` in the folder of a class. It is only ever read, so that no run loses it.

    student,exercise,check,points,comment,excuse,deadline,by
    Ada Lovelace,03_teleop,stops,20,the log shows it,,,Grace
    linus,,,75,,,,            a total
    jane,,,,ill,yes,,         no grade
    17,,,,,,2026-11-27 23:59 Europe/Berlin,       an extension (`late_policy.py`)

Columns may be left out, and stand in any order. `student` is the name or the id in the gradebook; without `check` the
points are those of the whole exercise; lines of other exercises are left alone. A spreadsheet may write semicolons, and
a byte order mark.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.learning_platforms.spreadsheet import rows_of, text_of
from gz_course.grader.printable import shown
from gz_course.grader.whole_class.late_policy import read_deadline
from gz_course.sim.did_you_mean import did_you_mean

OVERRIDES = "overrides.csv"
COLUMNS = ("student", "exercise", "check", "points", "comment", "excuse", "deadline", "by")
YES, NO = {"yes", "y", "true", "1", "x"}, {"", "no", "n", "false", "0"}


@dataclass(frozen=True)
class Override:
    """One line of the file. `check` is empty for the whole exercise, `points` None if they stay."""

    line: int
    student: str
    check: str
    points: float | None
    comment: str
    excused: bool
    deadline: datetime | None
    by: str


def read_overrides(folder: Path, exercise: Exercise, students: Mapping[str, str]) -> list[Override]:
    """Return the changes for an exercise, none without a file. `students` are the names of the class, with their ids.

    Raises UsageError with the line of an unknown student or check, of points that the exercise does not have, of two
    lines that contradict each other, or of what cannot be read.
    """
    path = folder / OVERRIDES
    if not path.exists() or not (text := text_of(path)).strip():
        return []
    (_, head), *rows = rows_of(path, text)
    header = _header(path, head)
    found = []
    for line, cells in rows:
        if len(cells) > len(header):
            raise UsageError(f"{path}, line {line}: more cells than columns; quote a cell that holds a comma")
        row = dict(zip(header, (cell.strip() for cell in cells), strict=False))
        if any(row.values()) and (each := _read(path, line, row, exercise, students)):
            found.append(each)
    _check_together(path, found)
    return found


def _header(path: Path, cells: list[str]) -> list[str]:
    header = [name.strip().casefold() for name in cells]
    for name in header:
        if name not in COLUMNS or header.count(name) > 1:
            near = did_you_mean(name, COLUMNS, listing="known")
            what = "comes twice" if name in COLUMNS else f"is not known{near}"
            raise UsageError(f"{path}, line 1: the column {shown(name, 60)!r} {what}")
    if "student" not in header:
        raise UsageError(f"{path}, line 1: there is no column 'student'; the columns are {', '.join(COLUMNS)}")
    return header


def _read(
    path: Path, line: int, row: dict[str, str], exercise: Exercise, students: Mapping[str, str]
) -> Override | None:
    """Return the change of a line, None if it is of another exercise."""
    where = f"{path}, line {line}"
    if (named := row.get("exercise", "")) and _exercise(where, named, exercise) != exercise.name:
        return None
    student = _student(where, row["student"], students)
    check, points = row.get("check", ""), None
    ids = {each.id: each.points for each in exercise.checks}
    check = "" if check.casefold() == "total" else check
    if check and check not in ids:
        near = did_you_mean(check, ids, listing="known")
        raise UsageError(f"{where}: {exercise.name} has no check {shown(check, 60)!r}{near}")
    if given := row.get("points", ""):
        most = ids[check] if check else exercise.max_score
        try:
            points = float(given.replace(",", "."))
        except ValueError:
            raise UsageError(f"{where}: {shown(given, 40)!r} is no number of points") from None
        if not 0 <= points <= most:
            raise UsageError(f"{where}: {given} points, but {check or exercise.name} has 0 to {most:g}")
    excuse = row.get("excuse", "").casefold()
    if excuse not in YES | NO:
        raise UsageError(f"{where}: excuse is {shown(excuse, 40)!r}; write yes, or nothing")
    due = None
    if moved := row.get("deadline", ""):
        due = read_deadline(moved, f"{where}: the deadline")
    if check and points is None:
        raise UsageError(f"{where}: the check {check} is named, but no points are given")
    return Override(line, student, check, points, row.get("comment", ""), excuse in YES, due, row.get("by", ""))


def _exercise(where: str, named: str, exercise: Exercise) -> str:
    """Return the name of the exercise that a line names, also by its number, of the course of `exercise`."""
    if named == exercise.name:
        return named
    root = exercise.folder.parents[1]
    try:
        return find_exercise(named, root).name
    except UsageError:
        near = did_you_mean(named, exercise_names(root))
        raise UsageError(f"{where}: there is no exercise {shown(named, 60)!r}{near}") from None


def _student(where: str, named: str, students: Mapping[str, str]) -> str:
    """Return the name of the student that a line names, by the name or the id."""
    if named in students:
        return named
    alike = [name for name, id in students.items() if named and (id == named or name.casefold() == named.casefold())]
    if len(alike) == 1:
        return alike[0]
    if alike:
        raise UsageError(f"{where}: {shown(named, 60)!r} may be {' or '.join(map(repr, alike[:2]))}; write the name")
    near = did_you_mean(named, students)
    raise UsageError(f"{where}: the class has no student {shown(named, 60)!r}{near}")


def _check_together(path: Path, found: list[Override]) -> None:
    """Raise UsageError if two lines contradict each other."""
    seen: dict[tuple[str, str], Override] = {}
    for each in found:
        what = [("points", each.check)] if each.points is not None else []
        what += [("excuse", "")] if each.excused else []
        what += [("deadline", "")] if each.deadline is not None else []
        for kind, check in what:
            key = (each.student, f"{kind} {check}")
            if key in seen:
                raise UsageError(f"{path}, line {each.line}: contradicts line {seen[key].line}; keep one of them")
            seen[key] = each
    for each in found:
        excused = seen.get((each.student, "excuse "))
        whole = seen.get((each.student, "points "))
        if each.points is not None and excused is not None:
            raise UsageError(f"{path}, line {each.line}: contradicts line {excused.line}, which excuses {each.student}")
        if each.check and each.points is not None and whole is not None:
            raise UsageError(f"{path}, line {each.line}: contradicts line {whole.line}, which gives all points at once")
