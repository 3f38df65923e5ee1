"""Temporary folders that are removed even if their owner was killed: the next run finds and removes them.

Every run makes a `TemporaryFolder`; `sweep()` is called where a run begins (`run/session.py`,
`whole_class/class_run.py`, `commands/verify.py`, `playground.py`). Each folder holds a file that its owner keeps
locked. Linux releases the lock when the owner ends for whatever reason, and no program started by the owner inherits
it. A folder gets that file only after it is locked, so one without the file is never touched; `course doctor` names old
ones.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import re
import select
import signal
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType

PREFIXES = ("course-", "playground-")  # of the names of all folders that are swept
OWNER = ".owner"
ROUNDS = 20  # of ending processes, in case some start others meanwhile
PATIENCE = 1000  # [ms] for a killed process to end


class TemporaryFolder:
    """A new folder at `path` for this user only; `close()` removes it. A context manager that returns the path.

    Its name begins with `prefix`, which begins with one of `PREFIXES`. Raises OSError if it cannot be made.
    """

    def __init__(self, prefix: str, within: Path | str | None = None) -> None:
        """Make the folder in `within`, by default in the system's folder for temporary files."""
        self.path = Path(tempfile.mkdtemp(prefix=prefix, dir=within))
        self._lock = _claim(self.path)

    def close(self) -> None:
        """Remove the folder with everything in it, as far as possible."""
        remove(self.path)
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def __enter__(self) -> Path:
        return self.path

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def sweep() -> None:
    """Remove the folders of this user whose owners were killed, and end the processes that still use them."""
    for folder in _candidates():
        with _of_the_dead(folder) as dead:
            if dead:
                end_processes_of(folder)
                remove(folder)


def abandoned() -> list[Path]:
    """Return the folders that `sweep()` would remove."""
    found = []
    for folder in _candidates():
        with _of_the_dead(folder) as dead:
            if dead:
                found.append(folder)
    return sorted(found)


def remove(folder: Path) -> None:
    """Remove a folder, even if its contents forbid reading or are nested too deep for a path.

    Follows no link and touches nothing that is mounted. What cannot be removed stays until the next sweep, with the
    file that names its owner.
    """
    if _has_mounts(folder):
        return
    pending = [folder]
    number = 0
    while pending:
        here = pending.pop()
        with contextlib.suppress(OSError):
            if here != folder:
                here.chmod(0o700)
            with os.scandir(here) as entries:
                listed = [(entry.name, entry.is_dir(follow_symlinks=False)) for entry in entries]
            for name, is_folder in listed:
                with contextlib.suppress(OSError):
                    if not is_folder:
                        if here != folder or name != OWNER:
                            (here / name).unlink()
                    else:  # moved up to the top, so that no path grows too long
                        number += 1
                        (here / name).chmod(0o700)
                        pending.append((here / name).rename(folder / f"{OWNER}-{number}"))
            if here != folder:
                here.rmdir()
    with contextlib.suppress(OSError):
        if [path.name for path in folder.iterdir()] in ([OWNER], []):
            (folder / OWNER).unlink(missing_ok=True)
            folder.rmdir()


def end_processes_of(folder: Path) -> None:
    """End the processes of this user whose environment puts their temporary files below a folder."""
    home = os.path.realpath(folder)
    for _ in range(ROUNDS):
        if not any([_end_if_at_home(int(name), home) for name in os.listdir("/proc") if name.isdecimal()]):  # noqa: PTH208
            return


def _end_if_at_home(pid: int, home: str) -> bool:
    if pid == os.getpid():
        return False
    try:
        process = os.pidfd_open(pid)  # the process id may be reused between the check and the signal
    except OSError:
        return False
    try:
        variables = Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
        places = [os.fsdecode(text[7:]) for text in variables if text.startswith(b"TMPDIR=")]
        if not any(os.path.realpath(place).startswith(f"{home}/") for place in places):
            return False
        signal.pidfd_send_signal(process, signal.SIGKILL)
        gone = select.poll()
        gone.register(process, select.POLLIN)
        gone.poll(PATIENCE)
        return True
    except OSError:  # the process has ended, or belongs to another user
        return False
    finally:
        os.close(process)


def _claim(folder: Path) -> int | None:
    """Put a locked file into a new folder; return its descriptor, None if the file system has no locks."""
    fresh = folder / f"{OWNER}-new"
    try:
        lock = os.open(fresh, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600)
    except OSError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        fresh.rename(folder / OWNER)  # from now on a sweep considers the folder
    except OSError:
        os.close(lock)
        fresh.unlink(missing_ok=True)
        return None
    return lock


def _candidates() -> list[Path]:
    try:
        with os.scandir(tempfile.gettempdir()) as entries:
            return [Path(entry.path) for entry in entries if entry.name.startswith(PREFIXES)]
    except OSError:
        return []


@contextlib.contextmanager
def _of_the_dead(folder: Path) -> Iterator[bool]:
    """Yield whether a folder is this user's and its owner has ended; if so, it stays locked while the block lasts."""
    lock = None
    try:
        lock = _take_over(folder)
        yield lock is not None
    finally:
        if lock is not None:
            os.close(lock)


def _take_over(folder: Path) -> int | None:
    lock = None
    try:
        status = folder.lstat()
        if not stat.S_ISDIR(status.st_mode) or status.st_uid != os.geteuid():
            return None
        lock = os.open(folder / OWNER, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        # Another sweep may have removed the file between the two calls.
        if os.path.samestat(os.fstat(lock), (folder / OWNER).lstat()):
            return lock
    except OSError:
        pass
    if lock is not None:
        os.close(lock)
    return None


def _has_mounts(folder: Path) -> bool:
    """Return whether something is mounted in a folder, into which removing would descend."""
    home = os.fsencode(os.path.realpath(folder))
    try:
        mounts = Path("/proc/self/mountinfo").read_bytes().splitlines()
    except OSError:
        return False
    places = (re.sub(rb"\\([0-7]{3})", lambda code: bytes([int(code[1], 8)]), line.split()[4]) for line in mounts)
    return any(place == home or place.startswith(home + b"/") for place in places)
