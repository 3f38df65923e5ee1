"""When submissions were handed in: as the platform says, else the last commit of a clone, else the newest file.

A file of Canvas has no time of its own; its name says whether it was late. Commits and files are claims: they have the
time that their author's computer gave them. No program of a submission runs for this, and no configuration of its
repository is read.

Source: Canvas, `lib/content_zipper.rb`; git-cat-file(1) and git(1) (GIT_OBJECT_DIRECTORY); gitrepository-layout(5).
"""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import Exercise
from gz_course.grader.learning_platforms.login_map import Person
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.whole_class.found import Found, find_submissions
from gz_course.grader.whole_class.platforms import CANVAS

GIT = 10.0  # [s] for one call of git
LARGEST_REF, LARGEST_REFS = 4096, 4 << 20  # [bytes]
COMMIT = re.compile(r"[0-9a-f]{40}([0-9a-f]{24})?")
COMMITTER = re.compile(rb"^committer [^\n]*> (\d{1,12}) [+-]\d{4}$", re.MULTILINE)


class Submitted(NamedTuple):
    """A time, and who says so: `platform`, `commit` or `file`."""

    time: datetime
    said_by: str


def submission_times(
    path: Path, exercise: Exercise, people: Mapping[str, Person] | None = None
) -> dict[tuple[str, str], Submitted]:
    """Return the time of every submission that has one, by what the gradebook calls it (`student`, `submission`).

    `path` is the folder or zip that was graded, `people` are the students by their logins at GitHub.
    Raises UsageError if it cannot be read.
    """
    found: dict[tuple[str, str], Submitted] = {}
    with ExitStack() as stack:
        submissions, _ = find_submissions(path, exercise, stack, people)
        when = times_in(path, stack)
        for each in (one for last in submissions for one in (*last.earlier, last)):
            if submitted := when(each):
                found[each.student, each.source] = submitted
    return found


def times_in(path: Path, stack: ExitStack) -> Callable[[Found], Submitted | None]:
    """Return what tells when a submission of the folder or zip `path` was handed in; `stack` cleans up after it."""
    folders = _folders(path) if path.is_dir() else {}
    ours = stack.enter_context(TemporaryFolder("course-git-")) / "objects"  # the next run removes what a kill leaves
    return lambda found: _submitted(found, folders.get(found.entry), ours)


def _submitted(found: Found, folder: Path | None, ours: Path) -> Submitted | None:
    if found.submitted is not None:
        return Submitted(found.submitted, "platform")
    if folder is not None and (folder / ".git").exists():  # its files are as old as the clone
        time = commit_time(folder / ".git", ours)
        return Submitted(time, "commit") if time else None
    if found.platform == CANVAS:  # Canvas gives files the time at which it packs them
        return None
    try:
        times = [member.modified for member in found.files().values() if member.modified is not None]
    except (UsageError, OSError):
        return None
    aware = [time for time in times if time.tzinfo]
    newest = max(aware or times, default=None)
    return Submitted(newest, "file") if newest else None


def _folders(path: Path) -> dict[str, Path]:
    """Return name -> folder, for the folders in `path`, or in the only folder there."""
    try:
        top = [each for each in path.iterdir() if each.is_dir() and not each.is_symlink()]
        if len(top) == 1:
            top += [each for each in top[0].iterdir() if each.is_dir() and not each.is_symlink()]
    except OSError:
        return {}
    return {each.name: each for each in top}


def commit_time(git: Path, ours: Path) -> datetime | None:
    """Return when the commit at HEAD of a repository was made; None if that cannot be found out.

    git reads the objects of that repository with the configuration of an empty one in the folder `ours`.
    """
    try:
        commit = _head(git)
    except (OSError, ValueError):
        return None
    if commit is None or not (git / "objects").is_dir() or (git / "objects").is_symlink():
        return None
    environment = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    environment |= {"GIT_CONFIG_NOSYSTEM": "1", "GIT_CONFIG_GLOBAL": os.devnull, "GIT_NO_LAZY_FETCH": "1"}
    try:
        if not (ours / "HEAD").exists():
            command = ["git", "init", "--quiet", "--bare", "--template=", str(ours)]
            subprocess.run(command, env=environment, capture_output=True, timeout=GIT, check=True)
        told = subprocess.run(
            ["git", f"--git-dir={ours}", "cat-file", "commit", commit],
            env=environment | {"GIT_OBJECT_DIRECTORY": str(git / "objects")},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=GIT,
            check=True,
        ).stdout
        match = COMMITTER.search(told.partition(b"\n\n")[0])
        return datetime.fromtimestamp(int(match[1]), UTC) if match else None
    except (OSError, subprocess.SubprocessError, ValueError, OverflowError):
        return None


def _head(git: Path) -> str | None:
    """Return the commit that HEAD names, directly or by a branch, in a file of its own or in `packed-refs`."""
    head = _read(git / "HEAD", LARGEST_REF).strip()
    if not head.startswith("ref: "):
        return head if COMMIT.fullmatch(head) else None
    name = head.removeprefix("ref: ")
    if not re.fullmatch(r"refs/[\w./+@-]+", name) or ".." in name:
        return None
    if (git / name).is_file() and not (git / name).is_symlink():
        commit = _read(git / name, LARGEST_REF).strip()
        return commit if COMMIT.fullmatch(commit) else None
    for line in _read(git / "packed-refs", LARGEST_REFS).splitlines():
        commit, _, ref = line.partition(" ")
        if ref == name and COMMIT.fullmatch(commit):
            return commit
    return None


def _read(path: Path, most: int) -> str:
    """Return the beginning of a file. Raises OSError for a link or what is no file."""
    handle = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    with os.fdopen(handle, "rb") as stream:
        return stream.read(most).decode("utf-8", "replace")
