"""Shared memory that killed processes have left behind.

A process that is killed cannot remove its segment of shared memory, and Fast DDS removes it only where another process
has opened it. `shared_memory` does so here before it makes a new one. While a process lives, it holds a lock (`flock`)
on the file `NAME_el` beside its segment `NAME`; it takes the lock before it makes the segment.

Source: `fastdds shm clean` and SharedMemManager of Fast DDS 2.14,
https://fast-dds.docs.eprosima.com/en/2.14.x/fastddscli/cli/cli.html
"""

from __future__ import annotations

import contextlib
import fcntl
import re
from pathlib import Path

FOLDER = Path("/dev/shm")
_SEGMENT = re.compile(r"(fastrtps|fastdds)_[0-9a-f]{16}")
_LOCK = "_el"


def remove_abandoned_segments(folder: Path = FOLDER) -> int:
    """Remove the segments of processes that have ended, as far as this user may; return their size [byte]."""
    size = 0
    with contextlib.suppress(OSError):  # there is no shared memory
        for segment in list(folder.iterdir()):
            if _SEGMENT.fullmatch(segment.name):
                with contextlib.suppress(OSError):  # of another user, in use, or gone
                    size += _remove(segment)
    return size


def _remove(segment: Path) -> int:
    """Remove a segment and its lock if nobody holds the lock. Raises OSError if that is not possible."""
    lock = segment.with_name(segment.name + _LOCK)
    with lock.open() as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        size = segment.stat().st_size
        segment.unlink()
        lock.unlink()
    return size
