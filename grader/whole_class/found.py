"""The submissions of a class in a folder or a zip as learning platforms export them, and their students.

Each student has one folder, file or archive; the names that Canvas, Moodle, Blackboard and Gradescope give are
understood. Files of one student side by side belong together. Nothing is read before `Found.read` is called, so that
only one submission at a time is in memory. Used by `grade_all.py`.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

import yaml

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.printable import shown
from gz_course.grader.submission.archive import (
    LONGEST_PART,
    Member,
    Tree,
    damaged,
    is_archive,
    plain_name,
    zip_folders,
    zip_members,
)
from gz_course.grader.submission.intake import JUNK, Selection, folder_member, folder_tree, is_junk, select
from gz_course.grader.whole_class.unique_names import unique_names

METADATA = "submission_metadata.yml"  # written by Gradescope beside the folders of an export
LARGEST_METADATA = 4 << 20  # [bytes]

# A platform's name for what a student handed in. `file` is the student's own name for it.
MOODLE = re.compile(r"(?P<student>.+?)_(?P<id>\d+)_assignsubmission_(?:file|onlinetext)_?(?P<file>.*)", re.DOTALL)
CANVAS = re.compile(r"(?P<student>.+?)(?:_LATE)?_(?P<id>\d+)_\d{2,}_(?P<file>.+)", re.DOTALL)
CANVAS_LATE = re.compile(r".+?_LATE_\d+_\d{2,}_.+", re.DOTALL)
BLACKBOARD = re.compile(r".+_(?P<student>[^_]+)_attempt_(?P<when>\d{4}(?:-\d\d){5})(?:_(?P<file>.+)|\.txt)", re.DOTALL)
BLACKBOARD_TIME = "%Y-%m-%d-%H-%M-%S"
AGAIN = re.compile(r"-\d+(?=\.[^.]*$)")  # Canvas numbers what was handed in again: teleop_node-2.py


@dataclass(frozen=True)
class Found:
    """What one student handed in. `student` is unique in the class; `source` is its name in the export.

    `read` returns the expected file and everything that belongs to it. It raises UsageError, or RefusedError, if there
    is nothing to grade in it, and UnreadableError if the machine cannot read it. `submitted` is when, as the platform
    says; `files` returns all files without reading them, and raises as `read` does. `entry` is the name that `source`
    shows, as it is in the folder or zip.
    """

    student: str
    id: str
    source: str
    read: Callable[[], Selection]
    submitted: datetime | None = None
    files: Callable[[], Tree] = dict
    entry: str = ""


class _Owner(NamedTuple):
    """The student an entry belongs to, derived from its name; equal for all entries of one student."""

    student: str
    id: str = ""


@dataclass
class _Group:
    """The entries of one owner, and how to read them."""

    source: str
    trees: list[Callable[[], Tree]]
    when: str = ""
    submitted: datetime | None = None

    def files(self) -> Tree:
        tree: Tree = {}
        for part in self.trees:
            tree |= part()
        return tree


def find_submissions(path: Path, exercise: Exercise, stack: ExitStack) -> tuple[list[Found], list[str]]:
    """Return the submissions of a class in the order of students' names, and the names of entries that are none.

    `stack` closes what is read later. Raises UsageError if there are none or `path` cannot be read.
    """
    try:
        top, folders = _zip_top(path, stack) if path.is_file() else _folder_top(path)
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from None
    top, left_out = _unwrapped(top, folders, exercise), []
    names, times = _gradescope(top.pop(METADATA, None))
    groups: dict[_Owner, _Group] = {}
    suffixes = find_kind(exercise.kind).suffixes
    for name, thing in sorted(top.items()):
        owner, file, when = _owner(name, folder=callable(thing), names=names)
        if name.startswith(".") and name.strip(".") and not owner.id:  # a hidden folder is nobody's, but is reported
            left_out.append(_label(name))
            continue
        if not callable(thing) and not file.endswith(suffixes) and not is_archive(file) and not owner.id:
            left_out.append(_label(name))
            continue
        tree = thing if callable(thing) else partial(_alone, file, thing)
        group = groups.get(owner)
        if group is None or when > group.when:  # a later attempt replaces an earlier one
            submitted = _blackboard_time(when) if when else times.get(name)
            groups[owner] = _Group(name, [tree], when, submitted)
        elif when == group.when:
            group.trees.append(tree)
    if not groups:
        raise UsageError(
            f"there are no submissions in {path}: expected a folder, archive or {suffixes[0]} file for each student"
        )
    return _named(groups, exercise), left_out


def _named(groups: dict[_Owner, _Group], exercise: Exercise) -> list[Found]:
    """Give every student a unique, printable name."""
    names = [_label(owner.student) for owner in groups]
    labels = unique_names(names, [owner.id for owner in groups])
    found = []
    for label, (owner, group) in zip(labels, groups.items(), strict=True):
        source = _label(group.source)
        read = partial(_read, group, exercise, source)
        found.append(Found(label, owner.id, source, read, group.submitted, group.files, group.source))
    return sorted(found, key=lambda each: (each.student.casefold(), each.student))


def _label(name: str) -> str:
    """Return a name fit to be shown: foreign bytes and control codes replaced, not too long."""
    clean = name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    return shown(clean, 120).strip() or "(no name)"


def _read(group: _Group, exercise: Exercise, source: str) -> Selection:
    tree = group.files()
    wanted = PurePosixPath(exercise.file)
    for name in [name for name in tree if AGAIN.search(name)]:
        if AGAIN.sub("", name) == wanted.name and wanted.name not in tree:
            tree[wanted.name] = tree.pop(name)
    return select(tree, exercise, source)


def _alone(name: str, member: Member) -> Tree:
    return {name: member}


Top = dict[str, "Callable[[], Tree] | Member"]  # name -> a function that returns a folder's tree, or a file


def _folder_top(path: Path) -> tuple[Top, list[str]]:
    """Return the entries at the top of a folder, and the names of the folders in it and in its only folder."""
    top: Top = {}
    for each in path.iterdir():
        if _is_trace(each.name, folder=each.is_dir()):
            continue
        if each.is_dir():
            top[each.name] = partial(folder_tree, each)
        elif (member := folder_member(each)) is not None:
            top[each.name] = member
    folders = [name for name, thing in top.items() if callable(thing)]
    if len(top) == len(folders) == 1:
        folders += [f"{folders[0]}/{each.name}" for each in (path / folders[0]).iterdir() if each.is_dir()]
    return top, folders


def _zip_top(path: Path, stack: ExitStack) -> tuple[Top, list[str]]:
    """Return the entries at the top of a zip, and the names of its folders, including empty ones.

    A member with an unsafe name is an error of its student, not of the class.
    """
    top: Top = {}
    folders: dict[str, Tree] = {}
    unsafe: dict[str, RefusedError] = {}
    try:
        stream = stack.enter_context(path.open("rb"))
        empty = [name for raw in zip_folders(stream) if (name := _safe(raw)) and not _is_trace(name, folder=True)]
        for raw, member in zip_members(stream):
            first, _, rest = raw.replace("\\", "/").removeprefix("./").partition("/")
            if _is_trace(first, folder=bool(rest)):
                continue
            try:
                plain_name(raw, _label(first))
            except RefusedError as error:
                unsafe[first[:LONGEST_PART]] = error
                continue
            if rest:
                folders.setdefault(first, {})[plain_name(rest, _label(first))] = member
            else:
                top[first] = member
    except OSError:
        raise
    except Exception as error:  # as for a student's archive: the exceptions of `zipfile` are not documented
        raise damaged(str(path), error) from None
    for name in empty:
        folders.setdefault(name.partition("/")[0], {})
    top |= {name: partial(dict, tree) for name, tree in folders.items()}
    return top | {name: partial(_refuse, error) for name, error in unsafe.items()}, empty


def _safe(raw: str) -> str:
    """Return the name of a folder; empty if it leads out of the archive."""
    try:
        return plain_name(raw.replace("\\", "/").removeprefix("./"), "")
    except RefusedError:
        return ""


def _is_trace(name: str, *, folder: bool) -> bool:
    """Return whether an entry at the top was left behind by a system or a tool; hidden folders may be submissions."""
    return name in JUNK or name == ".git" or (name.startswith(".") and not folder)


def _refuse(error: RefusedError) -> Tree:
    raise error


def _unwrapped(top: Top, folders: list[str], exercise: Exercise) -> Top:
    """Return the entries of the only folder of `top`, if that folder holds a class and not one student's work.

    Empty folders, which only `folders` lists, count as students of that class, too.
    """
    ((outer, only),) = top.items() if len(top) == 1 else (("", None),)
    if not callable(only):
        return top
    try:
        tree = only()
    except UsageError:
        return top
    inner: dict[str, Tree] = {}
    files: Top = {}
    for name, member in tree.items():
        first, _, rest = name.partition("/")
        if rest:
            inner.setdefault(first, {})[rest] = member
        else:
            files[first] = member
    holders = [
        n for n, t in inner.items() if any(PurePosixPath(name).name == exercise.file or is_archive(name) for name in t)
    ]
    holders += [name for name in files if is_archive(name) or _owner(name, folder=False, names={})[0].id]
    if not any(PurePosixPath(name).name == exercise.file for name in tree):
        holders += [name for name in files if name.endswith(find_kind(exercise.kind).suffixes)]
    if (len(holders) < 2 and METADATA not in files) or exercise.file in files or "exercises" in inner:
        return top
    for name in folders:
        first, _, second = name.partition("/")
        if first == outer and second and "/" not in second:
            inner.setdefault(second, {})
    return files | {name: partial(dict, each) for name, each in inner.items() if not is_junk(name)}


def _owner(name: str, *, folder: bool, names: dict[str, _Owner]) -> tuple[_Owner, str, str]:
    """Return the student of the entry called `name`, the student's own name for it, and when it was handed in."""
    if name in names:
        return names[name], name, ""
    if match := MOODLE.fullmatch(name):
        return _Owner(match["student"], match["id"]), match["file"] or name, ""
    if match := BLACKBOARD.fullmatch(name):
        return _Owner(match["student"], match["student"]), match["file"] or name, match["when"]
    if not folder and (match := CANVAS.fullmatch(name)):
        return _Owner(match["student"], match["id"]), match["file"], ""
    if folder:
        return _Owner(name), name, ""
    return _Owner(PurePosixPath(name.removesuffix(".gz")).stem.removesuffix(".tar")), name, ""


def _blackboard_time(when: str) -> datetime | None:
    try:
        return datetime.strptime(when, BLACKBOARD_TIME)
    except ValueError:
        return None


def _gradescope(member: object) -> tuple[dict[str, _Owner], dict[str, datetime]]:
    """Return the owner of each folder, and when it was handed in, from a Gradescope export's metadata."""
    if not isinstance(member, Member):
        return {}, {}
    try:
        raw: Any = yaml.safe_load(member.read(LARGEST_METADATA))
        found, times = {}, {}
        for folder, about in raw.items():
            people = about[":submitters"]
            student = " & ".join(str(person.get(":name") or person.get(":email")) for person in people)
            ids = ";".join(str(person.get(":sid") or person.get(":email") or "") for person in people)
            found[str(folder)] = _Owner(student, ids)
            if isinstance(created := about.get(":created_at"), datetime):
                times[str(folder)] = created if created.tzinfo else created.replace(tzinfo=UTC)
        return found, times
    except (yaml.YAMLError, UsageError, TypeError, KeyError, AttributeError, ValueError):
        return {}, {}
