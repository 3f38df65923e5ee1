"""Whose a login of GitHub is: a CSV file with a line for each student (`course grade-all --map FILE`).

    login,student                   or, as GitHub Classroom exports its roster:
    jdoe,Jane Doe                   identifier,github_username,github_id,name

`student` (or `name`) is what gradebook and page say, `identifier` (or `id`) what `course export` looks for. GitHub
Classroom calls a student's repository by the assignment and the login, `03-teleop-jdoe`.

Source: GitHub Docs, "Manage classrooms" (roster) and "Use the Git and GitHub starter assignment" (repositories).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import NamedTuple

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.spreadsheet import rows_of, text_of
from gz_course.grader.printable import shown
from gz_course.sim.did_you_mean import did_you_mean

LOGIN, STUDENT, ID = ("login", "github_username"), ("student", "name"), ("id", "identifier")


class Person(NamedTuple):
    """A student of the map; `id` is empty if the map has none."""

    login: str
    student: str
    id: str


def read_login_map(path: Path) -> dict[str, Person]:
    """Return the students by their logins, in lower case. Raises UsageError with the line of what cannot be used."""
    (_, head), *rows = rows_of(path, text_of(path))
    header = [cell.strip().casefold() for cell in head]
    login, student, id = (_column(header, names) for names in (LOGIN, STUDENT, ID))
    if login is None or (student is None and id is None):
        near = did_you_mean("login" if login is None else "student", [shown(name, 60) for name in header])
        raise UsageError(f"{path}, line 1: expected the columns login and student{near}")
    found: dict[str, Person] = {}
    lines: dict[str, int] = {}
    for line, cells in rows:
        given = [cells[n].strip() if n is not None and n < len(cells) else "" for n in (login, student, id)]
        if not any(given) or not given[0]:  # a roster lists those who have not joined, too
            continue
        person = Person(given[0], given[1] or given[2], given[2])
        if not person.student:
            raise UsageError(f"{path}, line {line}: the login {shown(person.login, 60)!r} has no student")
        for what, key in (("login", person.login), ("student", f"\n{person.id or person.student}")):
            if (before := lines.setdefault(key.casefold(), line)) != line:
                raise UsageError(f"{path}, line {line}: the {what} {shown(key.strip(), 60)!r} is on line {before}, too")
        found[person.login.casefold()] = person
    if not found:
        raise UsageError(f"{path} has no student: expected a line for each, with the columns login and student")
    return found


def _column(header: list[str], names: Iterable[str]) -> int | None:
    return next((header.index(name) for name in names if name in header), None)


def of_repositories(names: Iterable[str], people: Mapping[str, Person]) -> dict[str, Person]:
    """Return whose the folders of cloned repositories are, by their names.

    All are called by one assignment and a login: it is the assignment that fits most of them, and then the shortest.
    """
    given = list(names)
    ends = {name: [n for n, c in enumerate(name) if c == "-" and name[n + 1 :].casefold() in people] for name in given}
    fits = Counter(name[:end] for name, all_ends in ends.items() for end in all_ends)
    if not fits:
        return {}
    assignment = min(fits, key=lambda each: (-fits[each], len(each), each))
    found = {name: people.get(name[len(assignment) + 1 :].casefold()) for name in given}
    return {name: person for name, person in found.items() if person and name.startswith(f"{assignment}-")}
