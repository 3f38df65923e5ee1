"""What stands under the name of a file and is none.

What is no regular file is never opened, because reading it may wait or never end.
"""

from __future__ import annotations

import stat
from pathlib import Path

_KINDS = {
    stat.S_IFIFO: "a FIFO (a named pipe)",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
    stat.S_IFSOCK: "a socket",
    stat.S_IFDIR: "a folder",
}


_LFS = b"version https://git-lfs.github.com/spec/"
_LONGEST_POINTER = 1024  # [byte]


def special_kind(path: Path) -> str:
    """Return what a path is, in words, if it exists and is no file that can be read; else an empty text."""
    try:
        found = path.stat()
        if stat.S_ISREG(found.st_mode) and found.st_size < _LONGEST_POINTER and path.read_bytes().startswith(_LFS):
            return "the pointer of Git LFS to a file that was not fetched; `git lfs pull` fetches it"
        return _KINDS.get(stat.S_IFMT(found.st_mode), "")
    except (OSError, ValueError):
        return ""
