"""Who of a roster handed in what of a gradebook: by an id, a login, an email address or a name.

The strongest of these that fits decides. If it fits several people, or several submissions fit one person, nobody is
chosen: a person must decide.
"""

from __future__ import annotations

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass

from gz_course.grader.learning_platforms.roster import (
    CANVAS_ID,
    EMAIL,
    ID,
    LOGIN,
    PARTICIPANT_ID,
    Person,
    Roster,
)
from gz_course.grader.printable import shown
from gz_course.grader.whole_class.gradebook import Row
from gz_course.grader.whole_class.platforms import CANVAS, MOODLE

NUMBERED = re.compile(r" \[\d+\]$")  # how a gradebook tells students of one name apart
LOCAL, NAME, WORDS, LETTERS = "email before the @", "name", "words of the name", "letters of the name"


@dataclass(frozen=True)
class Member:
    """One student of a submission: all of a row, for a group one of its members."""

    row: Row
    name: str
    id: str


@dataclass(frozen=True)
class Match:
    """A student of a submission, the person of the roster (None: nobody was chosen), and by what, or why not."""

    member: Member
    person: Person | None
    why: str


def match(rows: list[Row], roster: Roster) -> list[Match]:
    """Return a match for every student of every submission, in the order of the gradebook."""
    index: dict[tuple[str, str], set[int]] = defaultdict(set)
    for place, person in enumerate(roster.people):
        for kind, key in _of_person(person):
            if key:
                index[kind, key].add(place)
    known = {kind for kind, _ in index}
    chosen = [(member, *_chosen(member, index, known, roster)) for row in rows for member in members(row)]
    takers: dict[int, list[Member]] = defaultdict(list)
    for member, at, _ in chosen:
        if at is not None:
            takers[at].append(member)
    found = []
    for member, at, why in chosen:
        owner = None if at is None else roster.people[at]
        if at is not None and owner is not None and len(takers[at]) > 1:
            others = ", ".join(sorted(each.row.submission for each in takers[at]))
            found.append(Match(member, None, f"{owner.name} has several submissions: {shown(others)}"))
        else:
            found.append(Match(member, owner, why))
    return found


def members(row: Row) -> list[Member]:
    """Return the students of a submission; Gradescope's groups have several."""
    label = row.student.removesuffix(f" ({row.id})") if row.id else row.student
    label = NUMBERED.sub("", label)
    if ";" not in row.id:
        return [Member(row, label, row.id)]
    ids, names = row.id.split(";"), label.split(" & ")
    if len(names) != len(ids):  # the label was too long, or a name holds the sign
        names = [""] * len(ids)
    return [Member(row, name, id) for name, id in zip(names, ids, strict=True)]


def _chosen(
    member: Member, index: dict[tuple[str, str], set[int]], known: set[str], roster: Roster
) -> tuple[int | None, str]:
    for kind, key in _of_member(member):
        places = index.get((kind, key), set()) if key else set()
        if len(places) > 1:
            lines = ", ".join(str(line) for line in sorted(roster.people[place].line for place in places)[:5])
            return None, f"its {kind} fits several people of the roster, on the lines {lines}"
        for place in places:
            person = roster.people[place]
            if kind == PARTICIPANT_ID and not _may_be(member, person):
                return None, (
                    f"participant {member.id} of the roster is {person.name}; is the worksheet of another assignment?"
                )
            return place, kind
        if key and kind in known and kind == CANVAS_ID:
            return None, f"nobody in the roster has the Canvas ID {shown(member.id, 60)}"
    return None, "nobody in the roster has this id, login, email address or name"


def _may_be(member: Member, person: Person) -> bool:
    """Return whether the names agree, as far as both are known."""
    names = {_letters(_words(each)) for each in person.names} - {""}
    return not names or not _letters(_words(member.name)) or _letters(_words(member.name)) in names


def _of_person(person: Person) -> Iterator[tuple[str, str]]:
    for kind in (CANVAS_ID, PARTICIPANT_ID):
        yield kind, person.ids.get(kind, "")
    for kind in (ID, LOGIN, EMAIL):
        yield ID, fold(person.ids.get(kind, ""))
        yield LOCAL, fold(person.ids.get(kind, "")).partition("@")[0] if "@" in person.ids.get(kind, "") else ""
    for name in person.names:
        yield NAME, fold(name)
        yield WORDS, _words(name)
        yield LETTERS, _letters(_words(name))
    yield from ((LETTERS, squeezed(name)) for name in person.names)


def _of_member(member: Member) -> Iterator[tuple[str, str]]:
    if member.row.platform == MOODLE:
        yield PARTICIPANT_ID, member.id
    elif member.row.platform == CANVAS:
        yield CANVAS_ID, member.id
    elif member.id:
        yield ID, fold(member.id)
        yield LOCAL, fold(member.id)
    else:  # nothing but a name, which may be an id, too
        yield ID, fold(member.name)
        yield LOCAL, fold(member.name)
    yield NAME, fold(member.name)
    yield WORDS, _words(member.name)
    yield LETTERS, _letters(_words(member.name))
    yield LETTERS, squeezed(member.name)


def fold(text: str) -> str:
    """Return a text without what differs between programs: case, width, composition, kinds of blanks, invisible signs.

    A gradebook shows what cannot be printed as U+FFFD, which therefore equals every such character.
    """
    plain = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", text).casefold())
    seen = (c if c.isprintable() and c != "\N{REPLACEMENT CHARACTER}" else " " for c in plain)
    return " ".join("".join(seen).split())


def _words(name: str) -> str:
    """Return the words of a name in alphabetical order, without accents and signs."""
    bare = (c for c in unicodedata.normalize("NFKD", fold(name)) if not unicodedata.combining(c))
    return " ".join(sorted("".join(c if c.isalnum() else " " for c in bare).split()))


def _letters(words: str) -> str:
    return words.replace(" ", "")


def squeezed(name: str) -> str:
    """Return a name as Canvas has it in file names: letters and digits in their order, in lower case."""
    return "".join(c for c in fold(name) if c.isalnum())
