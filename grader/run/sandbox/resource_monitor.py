"""Monitor of what per-process limits cannot bound: memory, number of processes and files of a whole submission.

A thread of the grader looks every `PERIOD`; a submission that exceeds a limit is ended at once, and `broken` names the
limit. Wall time decides only how soon that happens.
"""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import threading
from collections.abc import Callable
from pathlib import Path

MOST_MEMORY = 2 << 30  # [bytes] of all processes of a submission together
MOST_PROCESSES = 128  # of a submission at the same time, threads not counted
PERIOD = 0.05  # [s]
ROUNDS = 100  # of killing, in case new processes appear as fast as they are ended
MEMORY, PROCESSES, DISK = "memory", "processes", "disk"


class ResourceMonitor:
    """A thread that watches the processes below `root`, except those in `apart`; `close()` ends the thread only.

    `kill` ends the submission. `folder`, if given, may hold `most_bytes` in `most_files` files.
    """

    def __init__(
        self,
        root: int,
        kill: Callable[[], None],
        apart: frozenset[int] = frozenset(),
        folder: Path | None = None,
        most_bytes: int = 0,
        most_files: int = 0,
    ) -> None:
        self.broken: str | None = None
        self._root, self._kill, self._apart = root, kill, apart
        self._folder, self._most_bytes, self._most_files = folder, most_bytes, most_files
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="sandbox-watch", daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._over.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._over.wait(PERIOD):
            self.broken = self._look()
            if self.broken:
                self._end()
                return

    def _look(self) -> str | None:
        members = descendants(self._root, self._apart)
        if len(members) > MOST_PROCESSES:
            return PROCESSES
        if sum(map(_resident, members)) > MOST_MEMORY and sum(map(_proportional, members)) > MOST_MEMORY:
            return MEMORY
        if self._folder is not None and _too_full(self._folder, self._most_bytes, self._most_files):
            return DISK
        return None

    def _end(self) -> None:
        """Kill all processes, after stopping them all so that none can start another meanwhile."""
        self._kill()
        for _ in range(ROUNDS):
            members = descendants(self._root, self._apart)
            if not members:
                return
            for number in (signal.SIGSTOP, signal.SIGKILL):
                for pid in members:
                    with contextlib.suppress(OSError):
                        os.kill(pid, number)
            if self._over.wait(PERIOD / 10):
                return


def descendants(root: int, apart: frozenset[int] = frozenset()) -> list[int]:
    """Return the processes below a process, except zombies and what is in or below `apart`."""
    found: list[int] = []
    todo = [root]
    while todo:
        here = todo.pop()
        for child in _children(here):
            if child not in apart and child != here:
                todo.append(child)
                found.append(child)
    return [pid for pid in found if not _is_zombie(pid)]


def _children(pid: int) -> list[int]:
    # Read often, so without `pathlib`, which takes longer than Linux does.
    found: list[int] = []
    with contextlib.suppress(OSError):
        for task in os.listdir(f"/proc/{pid}/task"):  # noqa: PTH208
            with contextlib.suppress(OSError):
                found += map(int, _read(f"/proc/{pid}/task/{task}/children").split())
    return found


def _is_zombie(pid: int) -> bool:
    try:
        return _read(f"/proc/{pid}/stat").rpartition(b")")[2].split()[0] in (b"Z", b"X")
    except OSError:
        return True


def _read(path: str) -> bytes:
    """Return what a file in /proc says."""
    handle = os.open(path, os.O_RDONLY)
    try:
        parts = []
        while part := os.read(handle, 1 << 16):
            parts.append(part)
        return b"".join(parts)
    finally:
        os.close(handle)


def _resident(pid: int) -> int:
    """Return a process's memory [bytes] that is not backed by files; shared memory counts in full."""
    return _kilobytes(f"/proc/{pid}/status", ("RssAnon:", "RssShmem:"))


def _proportional(pid: int) -> int:
    """Return the same with shared memory divided among its users; slower to read."""
    return _kilobytes(f"/proc/{pid}/smaps_rollup", ("Pss_Anon:", "Pss_Shmem:")) or _resident(pid)


def _kilobytes(path: str, names: tuple[str, ...]) -> int:
    total = 0
    with contextlib.suppress(OSError):
        for line in Path(path).read_text().splitlines():
            if line.startswith(names):
                total += int(line.split()[1]) << 10
    return total


def _too_full(folder: Path, most_bytes: int, most_files: int) -> bool:
    total = files = 0
    pending = [str(folder)]  # os.walk is recursive, and folders may be nested thousands deep
    while pending:
        try:
            with os.scandir(pending.pop()) as entries:
                for entry in entries:
                    files += 1
                    if entry.is_dir(follow_symlinks=False):
                        pending.append(entry.path)
                    else:
                        with contextlib.suppress(OSError):
                            total += entry.stat(follow_symlinks=False).st_blocks * 512
        except OSError as error:
            if error.errno == errno.ENAMETOOLONG:  # too deep for any path, so its content cannot be counted
                return True
        if total > most_bytes or files > most_files:
            return True
    return False
