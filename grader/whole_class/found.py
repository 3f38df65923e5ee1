"""The submissions of a class in a folder or a zip as learning platforms export them, and their students.

Each student has one folder, file or archive; `platforms.py` says whose each is. Entries that a platform names as one
student's belong together. No entry replaces another: two of which only one can count are both refused, by name. Nothing
is read before `Found.read` is called, so that only one submission at a time is in memory. Used by `grade_all.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from datetime import datetime
from functools import partial
from pathlib import Path, PurePosixPath

from gz_course.grader.errors import RefusedError, UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.learning_platforms.login_map import Person
from gz_course.grader.printable import shown
from gz_course.grader.submission.archive import (
    Member,
    Tree,
    damaged,
    is_archive,
    plain_name,
    zip_folders,
    zip_members,
)
from gz_course.grader.submission.given_names import is_of_kind
from gz_course.grader.submission.intake import JUNK, Selection, folder_member, folder_tree, is_junk, select
from gz_course.grader.whole_class.platforms import GRADESCOPE, METADATA, Entry, Export
from gz_course.grader.whole_class.unique_names import unique_names


@dataclass(frozen=True)
class Found:
    """What one student handed in. `student` is unique in the class; `source` is its name in the export.

    `read` returns the expected file and everything that belongs to it. It raises UsageError, or RefusedError, if there
    is nothing to grade in it, and UnreadableError if the machine cannot read it. `submitted` is when, as the platform
    says; `files` returns all files without reading them, and raises as `read` does. `entry` is the name that `source`
    shows, as it is in the folder or zip; `platform` is the one that has named it, or empty. `earlier` are the attempts
    before this one, in their order.
    """

    student: str
    id: str
    source: str
    read: Callable[[], Selection]
    submitted: datetime | None = None
    files: Callable[[], Tree] = dict
    entry: str = ""
    platform: str = ""
    earlier: tuple[Found, ...] = ()


@dataclass
class _Group:
    """An attempt of one student: what the first name says, and how to read each entry, by its name."""

    first: Entry
    parts: dict[str, Callable[[], Tree]]

    def files(self) -> Tree:
        if not self.first.platform and len(self.parts) > 1:
            raise RefusedError(f"{_both(self.parts)} have one name, so none of them is graded; rename all but one")
        tree: Tree = {}
        origin: dict[str, str] = {}
        for name, part in self.parts.items():
            for inside, member in part().items():
                if inside in tree:
                    both = _both((origin[inside], name))
                    raise RefusedError(f"{both} both hold {shown(inside, 120)!r}, so neither is graded; keep one")
                tree[inside], origin[inside] = member, name
        return tree


def _both(names: Iterable[str]) -> str:
    return " and ".join(map(_label, names))


def find_submissions(
    path: Path, exercise: Exercise, stack: ExitStack, people: Mapping[str, Person] | None = None
) -> tuple[list[Found], list[str]]:
    """Return the submissions of a class in the order of students' names, and the names of entries that are none.

    `stack` closes what is read later; `people` are the students by their logins at GitHub. Raises UsageError if there
    are none, if `path` cannot be read, or if nothing is of one of `people`.
    """
    try:
        top, below, folders = _zip_top(path, stack) if path.is_file() else _folder_top(path)
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror or error}") from None
    top, left_out = _unwrapped(top, below, folders, exercise), []
    suffixes = find_kind(exercise.kind).suffixes
    export, top = _export(top, suffixes, people)
    if people and not export.mapped:
        raise UsageError(f"no folder in {path} ends in a login of the map, as in 03-teleop-{next(iter(people))}")
    groups: dict[tuple[str, str], dict[str, _Group]] = {}
    for name, thing in sorted(top.items()):
        entry = export.entry(name, callable(thing))
        hidden = name.startswith(".") and name.strip(".")  # a hidden folder is nobody's, but is reported
        other = not callable(thing) and not is_of_kind(entry.file, suffixes) and not is_archive(entry.file)
        if (hidden or other) and not entry.platform:
            left_out.append(_label(name))
            continue
        tree = thing if callable(thing) else partial(_alone, entry.file, thing)
        attempts = groups.setdefault((entry.platform, entry.key), {})
        attempts.setdefault(entry.when, _Group(entry, {})).parts[name] = tree
    if not groups:
        raise UsageError(
            f"there are no submissions in {path}: expected a folder, archive or {suffixes[0]} file for each student"
        )
    return _named([[attempts[when] for when in sorted(attempts)] for attempts in groups.values()], exercise), left_out


def _export(top: Top, suffixes: tuple[str, ...] = (), people: Mapping[str, Person] | None = None) -> tuple[Export, Top]:
    """Return how the names of an export are read, and its entries without a platform's own."""
    others = {name: thing for name, thing in top.items() if name != METADATA}
    export = Export({name: callable(thing) for name, thing in others.items()}, top.get(METADATA), suffixes, people)
    return export, others if export.platform == GRADESCOPE else top


def _named(students: list[list[_Group]], exercise: Exercise) -> list[Found]:
    """Give every student, with the attempts in their order, a unique, printable name."""
    entries = [groups[-1].first for groups in students]
    labels = unique_names([_label(entry.student) for entry in entries], [entry.id for entry in entries])
    found = []
    for label, groups in zip(labels, students, strict=True):
        attempts = tuple(_attempt(label, group, exercise) for group in groups)
        found.append(replace(attempts[-1], earlier=attempts[:-1]))
    return sorted(found, key=lambda each: (each.student.casefold(), each.student))


def _attempt(label: str, group: _Group, exercise: Exercise) -> Found:
    first, entry = group.first, next(iter(group.parts))
    source = _label(entry)
    read = partial(_read, group, exercise, source)
    return Found(label, first.id, source, read, first.submitted, group.files, entry, first.platform)


def _label(name: str) -> str:
    """Return a name fit to be shown: foreign bytes and control codes replaced, not too long."""
    clean = name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    return shown(clean, 120).strip() or "(no name)"


def _read(group: _Group, exercise: Exercise, source: str) -> Selection:
    tree = group.files()
    return select(tree, exercise, source, own_name=not group.first.platform and [*tree] == [group.first.file])


def _alone(name: str, member: Member) -> Tree:
    return {name: member}


Top = dict[str, "Callable[[], Tree] | Member"]  # name -> a function that returns a folder's tree, or a file
Folders = Mapping[str, Callable[[], Tree]]  # name, with `/` between its parts -> the same for folders, also empty ones
Below = Callable[[], Iterable[tuple[str, "Member | RefusedError"]]]  # returns what is in the only folder at the top


def _folder_top(path: Path) -> tuple[Top, Below, Folders]:
    """Return the entries at the top of a folder, what is in its only folder, and the folders in both."""
    top: Top = {}
    for each in path.iterdir():
        if _is_trace(each.name, folder=each.is_dir()):
            continue
        if each.is_dir():
            top[each.name] = _folder(each)
        elif (member := folder_member(each)) is not None:
            top[each.name] = member
    folders = {name: thing for name, thing in top.items() if callable(thing)}
    below: Below = list
    if len(top) == len(folders) == 1:
        ((only, tree),) = folders.items()
        if not (path / only).is_symlink():
            below = partial(_items, tree)
            folders |= {f"{only}/{each.name}": _folder(each) for each in (path / only).iterdir() if each.is_dir()}
    return top, below, folders


def _items(tree: Callable[[], Tree]) -> Iterable[tuple[str, Member]]:
    return tree().items()


def _folder(path: Path) -> Callable[[], Tree]:
    """Return what reads a folder; a link to one is refused, because it leads out of the class."""
    if path.is_symlink():
        error = RefusedError(f"{_label(path.name)} is a link to a folder, which is not followed; put the folder there")
        return partial(_refuse, error)
    return partial(folder_tree, path)


def _zip_top(path: Path, stack: ExitStack) -> tuple[Top, Below, Folders]:
    """Return the entries at the top of a zip, what is in its only folder, and its folders, including empty ones.

    A member with an unsafe name is an error of its student, not of the class.
    """
    members: list[tuple[str, Member | RefusedError]] = []
    try:
        stream = stack.enter_context(path.open("rb"))
        empty = [name for raw in zip_folders(stream) if (name := _safe(raw)) and not _is_trace(name, folder=True)]
        for raw, member in zip_members(stream):
            name = raw.replace("\\", "/").removeprefix("./")
            first, _, rest = name.partition("/")
            if _is_trace(first, folder=bool(rest)):
                continue
            try:
                members.append((plain_name(raw, _label(first)), member))
            except RefusedError as error:
                members.append((name, error))
    except OSError:
        raise
    except Exception as error:  # as for a student's archive: the exceptions of `zipfile` are not documented
        raise damaged(str(path), error) from None
    below = [(rest, member) for name, member in members if (rest := name.partition("/")[2])]
    return _by_first_part(members, empty), lambda: below, dict.fromkeys(empty, dict)


def _by_first_part(members: Iterable[tuple[str, Member | RefusedError]], folders: Iterable[str] = ()) -> Top:
    """Return the entries at the top of a tree; one that is there twice, or holds a file twice, is refused."""
    files: dict[str, Member] = {}
    inner: dict[str, Tree] = {name.partition("/")[0]: {} for name in folders}
    refused: dict[str, RefusedError] = {}
    for name, member in members:
        first, _, rest = name.partition("/")
        if isinstance(member, RefusedError):
            refused.setdefault(first, member)
            continue
        place, inside = (inner.setdefault(first, {}), rest) if rest else (files, first)
        if inside in place:
            refused.setdefault(first, _twice(first, name))
        place[inside] = member
    refused = {name: _twice(name, name) for name in files.keys() & inner.keys()} | refused
    top: Top = files | {name: partial(dict, tree) for name, tree in inner.items()}
    return top | {name: partial(_refuse, error) for name, error in refused.items()}


def _twice(entry: str, name: str) -> RefusedError:
    return RefusedError(f"{_label(entry)}: {shown(name, 120)!r} is there twice, so neither is graded; keep one")


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


def _unwrapped(top: Top, below: Below, folders: Folders, exercise: Exercise) -> Top:
    """Return the entries of the only folder of `top`, if that folder holds a class and not one student's work.

    `below` returns what is in it. Empty folders, which only `folders` lists, count as students of that class, too.
    """
    ((outer, only),) = top.items() if len(top) == 1 else (("", None),)
    if not callable(only):
        return top
    try:
        members = list(below())
    except UsageError:
        return top
    inside = {name: thing for name, thing in _by_first_part(members).items() if not is_junk(name)}
    parts = [(name.partition("/"), read) for name, read in folders.items()]
    empty = {second: read for (first, _, second), read in parts if first == outer and second and "/" not in second}
    if exercise.file in inside or any(name.startswith("exercises/") for name, _ in members):
        return top
    suffixes = find_kind(exercise.kind).suffixes
    names = [PurePosixPath(name) for name, _ in members]
    wanted = {name.parts[0] for name in names if name.name == exercise.file or is_archive(name.name)}
    if not any(name.name == exercise.file for name in names):
        wanted |= {name for name, thing in inside.items() if not callable(thing) and is_of_kind(name, suffixes)}
    if len(wanted) < 2 and (len(inside) < 2 or not _export(inside)[0].platform):
        return top
    return {name: read for name, read in empty.items() if not is_junk(name)} | inside
