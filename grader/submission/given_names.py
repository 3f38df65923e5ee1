"""Names as students and platforms change them on the way: numbered copies, `.PY`, `.py.txt`, one file of another name.

    teleop_node-1.py, teleop_node (2).py     handed in again (Canvas), or downloaded twice (a browser)
    teleop_node.py.txt, Teleop_Node.PY       saved by an editor, or by a system without case

A file gets the name that the exercise asks for if no file has it. Whatever is taken under another name, and whatever is
there twice, is said in a note: nothing is chosen silently.
"""

from __future__ import annotations

import re
from pathlib import PurePosixPath

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.printable import shown
from gz_course.grader.submission.archive import Tree

COPY = re.compile(r"(?:-[0-9]{1,3}| ?\([0-9]{1,3}\))$")  # of a file's name without its suffix
TEXT = ".txt"
COPIED_MODULE = re.compile(rf"{COPY.pattern[:-1]}\.py$")
VARIANTS = frozenset({"accepted", "rejected"})  # folders beside a solution
MOST_NOTES = 5  # of one sort, for one submission


def without_text_suffix(name: str, suffixes: tuple[str, ...]) -> str:
    """Return a name as an editor got it: a suffix that the kind accepts, in lower case and without `.txt` after it."""
    lower = name.lower()
    bare = name[: -len(TEXT)] if lower.endswith(TEXT) and lower[: -len(TEXT)].endswith(suffixes) else name
    ending = next((each for each in suffixes if bare.lower().endswith(each)), "")
    return bare[: len(bare) - len(ending)] + ending if ending else name


def is_of_kind(name: str, suffixes: tuple[str, ...]) -> bool:
    """Return whether a file has the suffix of a kind of submission, in any case and also with `.txt` after it."""
    return without_text_suffix(name, suffixes).endswith(suffixes)


def as_asked(tree: Tree, exercise: Exercise, where: str) -> tuple[Tree, list[str]]:
    """Return a tree with the names that the exercise asks for, and notes on what was renamed or is there twice.

    Raises UsageError if several files would get one name that no file has.
    """
    suffixes = find_kind(exercise.kind).suffixes
    meant: dict[str, list[str]] = {}
    again = _folders_numbered(tree, exercise)
    for name in sorted(tree):
        asked = _asked(name, exercise, suffixes)
        if asked == name and name.rpartition("/")[0] in again:  # the modules of a program are numbered with it
            asked = COPIED_MODULE.sub(".py", name)
        if asked != name:
            meant.setdefault(asked, []).append(name)
    named, renamed, beside = dict(tree), list[str](), list[str]()
    for asked, names in meant.items():
        if asked in tree:
            beside += [f"{shown(asked)} is graded, and {shown(name)} beside it is not." for name in names]
        elif len(names) > 1:
            both = shown(", ".join(names))
            raise UsageError(f"{where} holds {shown(asked)} {len(names)} times: {both}; keep one")
        else:
            named[asked] = named.pop(names[0])
            renamed.append(f"{shown(names[0])} is taken as {shown(asked)}.")
    return named, renamed[:MOST_NOTES] + beside[:MOST_NOTES]


def _folders_numbered(tree: Tree, exercise: Exercise) -> set[str]:
    """Return the folders in which the file that is started has a number, and none has its own name."""
    wanted = PurePosixPath(exercise.file)
    numbered = re.compile(rf"{re.escape(wanted.stem)}{COPY.pattern[:-1]}{re.escape(wanted.suffix)}")
    folders = [name.rpartition("/") for name in tree]
    return {
        folder
        for folder, slash, last in folders
        if numbered.fullmatch(last) and f"{folder}{slash}{exercise.file}" not in tree
    }


def _asked(name: str, exercise: Exercise, suffixes: tuple[str, ...]) -> str:
    """Return the name that a file should have: that of a file of the exercise, or its own with a proper suffix."""
    folder, _, last = name.rpartition("/")
    plain = without_text_suffix(last, suffixes)
    for part in map(PurePosixPath, exercise.parts):
        inside = "" if str(part.parent) == "." else str(part.parent)
        if inside and folder != inside and not folder.endswith(f"/{inside}"):
            continue
        stem = plain.removesuffix(part.suffix) if plain.endswith(part.suffix) else plain
        if part.name.casefold() in (plain.casefold(), f"{COPY.sub('', stem)}{part.suffix}".casefold()):
            return f"{folder}/{part.name}" if folder else part.name
    return f"{folder}/{plain}" if folder else plain


def twice(tree: Tree, base: str, exercise: Exercise) -> list[str]:
    """Return notes on files of the exercise that are there more than once; those in the folder `base` are graded.

    In a copy of the course, what lies in the folders of other exercises is theirs; beside a solution lie its variants.
    """
    notes = []
    folder, _, last = base.rpartition("/")
    if last == exercise.name and folder.rpartition("/")[2] == "exercises":
        tree = {n: m for n, m in tree.items() if not n.startswith(f"{folder}/") or n.startswith(f"{base}/")}
    for part in exercise.parts:
        taken = part if base == "." else f"{base}/{part}"
        others = sorted(name for name in tree if name != taken and f"/{name}".endswith(f"/{part}"))
        others = [name for name in others if not VARIANTS & {*PurePosixPath(name).parts}]
        if others and taken in tree:
            more = f" and {len(others) - 1} more are" if len(others) > 1 else " is"
            often = f"{len(others) + 1} times" if len(others) > 1 else "twice"
            notes.append(f"{shown(part)} is there {often}: {shown(taken)} is graded, {shown(others[0])}{more} not.")
    return notes[:MOST_NOTES]
