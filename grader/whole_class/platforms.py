"""Whose an entry of an export is: the names that learning platforms give to what students handed in.

A platform writes the beginning of a name, and a student chooses the rest. So the beginning is read, up to the first
place where the platform's form is complete, and the rest decides nothing. One platform made the whole export: it is
the one whose form most names have, and a single name that imitates another form changes nothing.

Source: Canvas, `lib/content_zipper.rb`; Moodle, `mod/assign/classes/downloader.php`; Blackboard Help, "Download
Assignments"; Gradescope Help, "Export Submissions"; GitHub Docs, "Use the Git and GitHub starter assignment".
Brightspace documents no form: it is that of its archives, `USER-FOLDER - NAME - TIME`, with English names of months.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import PurePosixPath
from typing import Any

import yaml

from gz_course.grader.errors import UsageError
from gz_course.grader.learning_platforms.login_map import Person, of_repositories
from gz_course.grader.submission.archive import Member
from gz_course.grader.submission.given_names import without_text_suffix

CANVAS, MOODLE, BLACKBOARD, GRADESCOPE = "Canvas", "Moodle", "Blackboard", "Gradescope"
BRIGHTSPACE, GITHUB = "Brightspace", "GitHub Classroom"
METADATA = "submission_metadata.yml"  # written by Gradescope beside the folders of an export
LARGEST_METADATA = 4 << 20  # [bytes]
LARGEST_GROUP = 100  # [people]

# `file` is what the student chose. Canvas infers the ids as here, and keeps `_NUMBER_` out of the names of people.
# Moodle writes `_` in no name of a person or group, but programs that unpack its archives replace blanks by it.
FORMS = {
    CANVAS: re.compile(
        r"(?:(?P<late_anonymous>LATE_)?anon_(?P<anonymous>[0-9A-Za-z]+)|(?P<student>.+?)(?P<late>_LATE)?_(?P<id>[0-9]+))"
        r"_(?:(?P<attachment>[0-9]+)_(?P<file>.+)|(?:text|link)\.html)",
        re.DOTALL,
    ),
    MOODLE: re.compile(
        r"(?P<student>(?:(?!_assignsubmission_).)+?)(?:_(?P<id>[0-9]+))?_assignsubmission_[a-z0-9]+(?:_(?P<file>.*))?",
        re.DOTALL,
    ),
    BLACKBOARD: re.compile(
        r"(?P<student>.+?)_attempt_(?P<when>[0-9]{4}(?:-[0-9]{2}){5})(?:_(?P<file>.+)|\.txt)", re.DOTALL
    ),
    BRIGHTSPACE: re.compile(
        r"(?P<user>[0-9]+)-[0-9]+ - (?P<student>.+?) - "
        r"(?P<when>(?:[A-Z][a-z]{2,8} [0-9]{1,2}|[0-9]{1,2} [A-Z][a-z]{2,8}),? [0-9]{4} [0-9]{1,2}:?[0-9]{2} [AP]M)"
        r"(?: - (?P<file>.+))?",
        re.DOTALL,
    ),
    GRADESCOPE: re.compile(r"(?P<student>submission_[0-9]+)"),
}
BLACKBOARD_TIME = "%Y-%m-%d-%H-%M-%S"
BRIGHTSPACE_TIMES = ("%b %d %Y %I%M %p", "%B %d %Y %I%M %p", "%d %b %Y %I%M %p", "%d %B %Y %I%M %p")


@dataclass(frozen=True)
class Entry:
    """What the name of an entry says. `key` is equal for all entries of one student, and for nobody else's.

    `file` is the student's own name for it; `when` orders the attempts of a student. `platform` is empty for an entry
    that no platform has named.
    """

    key: str
    student: str
    id: str
    file: str
    platform: str = ""
    when: str = ""
    submitted: datetime | None = None


class Export:
    """The names of an export, read as those of the one platform that made it."""

    def __init__(
        self,
        names: Mapping[str, bool],
        metadata: object = None,
        suffixes: tuple[str, ...] = (),
        people: Mapping[str, Person] | None = None,
    ) -> None:
        """Decide on the platform. `names` says whether an entry is a folder; `metadata` is Gradescope's file.

        `suffixes` are those of the submission's kind; `people` are the students by their logins at GitHub.
        """
        self._suffixes = suffixes
        self._people = of_repositories((name for name in names if names[name]), people) if people else {}
        numbered = [name for name in names if FORMS[GRADESCOPE].fullmatch(name)]
        self._gradescope = _gradescope(metadata, numbered) if 2 * len(numbered) > len(names) else {}
        counts = {platform: self._count(platform, names) for platform in FORMS}
        platform = max(counts, key=lambda each: counts[each])
        self.platform = platform if 2 * counts[platform] > len(names) else ""
        self._assignment = self._shared_beginning(names) if self.platform == BLACKBOARD else ""

    @property
    def mapped(self) -> bool:
        """Whether the map of logins names anybody here."""
        return bool(self._people)

    def _count(self, platform: str, names: Mapping[str, bool]) -> int:
        """Return how many names have the form of a platform. Every file of Canvas has a number of its own."""
        found = {name: match for name, folder in names.items() if (match := self._match(platform, name, folder))}
        return len({match.groupdict().get("attachment") or name for name, match in found.items()})

    def _match(self, platform: str, name: str, folder: bool) -> re.Match[str] | None:
        if (platform == CANVAS and folder) or (platform == GRADESCOPE and name not in self._gradescope):
            return None
        return FORMS[platform].fullmatch(name)

    def _shared_beginning(self, names: Mapping[str, bool]) -> str:
        """Return the name of the assignment and a `_`: what is before each login, which may have a `_`, too."""
        found = [self._match(BLACKBOARD, name, folder) for name, folder in names.items()]
        heads = sorted({match["student"] for match in found if match})
        beginning = os.path.commonprefix(heads)  # noqa: RUF071 - names, not paths
        return beginning[: beginning.rfind("_") + 1]

    def entry(self, name: str, folder: bool) -> Entry:
        """Return what a name says; an entry that the platform has not named belongs to whom its whole name says."""
        if person := self._people.get(name):
            return Entry(person.login.casefold(), person.student, person.id, name, GITHUB)
        match = self._match(self.platform, name, folder) if self.platform else None
        if match is None:
            plain = without_text_suffix(name, self._suffixes).removesuffix(".gz")
            plain = PurePosixPath(plain).stem.removesuffix(".tar")
            student = name if folder else plain
            return Entry(student, student, "", name)
        key, facts = match["student"] or match[0], match.groupdict()
        file = facts.get("file") or name
        if self.platform == GRADESCOPE:
            student, id, submitted = self._gradescope[name]
            return Entry(name, student, id, file, GRADESCOPE, submitted=submitted)
        if self.platform == BLACKBOARD:
            login = key.removeprefix(self._assignment)
            return Entry(key, login, login, file, BLACKBOARD, facts["when"], _blackboard_time(facts["when"]))
        if self.platform == BRIGHTSPACE:
            time = _brightspace_time(facts["when"])
            when = time.isoformat() if time is not None else facts["when"]
            whole = name if facts["file"] is None else name.removesuffix(f" - {facts['file']}")
            person_and_folder = whole.removesuffix(f" - {facts['when']}")
            return Entry(person_and_folder, key, facts["user"], file, BRIGHTSPACE, when, time)
        if anonymous := facts.get("anonymous"):
            return Entry(anonymous, f"anon_{anonymous}", anonymous, file, CANVAS)
        id = facts["id"] or ""
        return Entry(f"{key}_{id}", key, id, file, self.platform)


def is_late(platform: str, name: str) -> bool:
    """Return whether the name of an entry says that it was late, as only Canvas writes it."""
    match = FORMS[CANVAS].fullmatch(name) if platform == CANVAS else None
    return match is not None and bool(match["late"] or match["late_anonymous"])


def _brightspace_time(when: str) -> datetime | None:
    text = when.replace(",", "").replace(":", "")
    day, clock, half = text.rsplit(" ", 2)
    for form in BRIGHTSPACE_TIMES:
        try:
            return datetime.strptime(f"{day} {clock.zfill(4)} {half}", form)
        except ValueError:
            continue
    return None


def _blackboard_time(when: str) -> datetime | None:
    try:
        return datetime.strptime(when, BLACKBOARD_TIME)
    except ValueError:
        return None


def _gradescope(member: object, folders: list[str]) -> dict[str, tuple[str, str, datetime | None]]:
    """Return folder -> students, their ids, and when it was handed in, from a Gradescope export's metadata."""
    if not isinstance(member, Member):
        return {}
    try:
        raw: Any = yaml.safe_load(member.read(LARGEST_METADATA))
        return {folder: _submitters(raw[folder]) for folder in folders if folder in raw}
    except (yaml.YAMLError, UsageError, TypeError, KeyError, AttributeError, ValueError, RecursionError):
        return {}


def _submitters(about: Any) -> tuple[str, str, datetime | None]:
    people = about[":submitters"][:LARGEST_GROUP]
    student = " & ".join(_text(person, ":name") or _text(person, ":email") for person in people)
    ids = ";".join(_text(person, ":sid") or _text(person, ":email") for person in people)
    created = about.get(":created_at")
    if not isinstance(created, datetime):
        return student, ids, None
    return student, ids, created if created.tzinfo else created.replace(tzinfo=UTC)


def _text(person: dict[str, Any], name: str) -> str:
    value = person.get(name)
    return str(value) if isinstance(value, str | int) else ""
