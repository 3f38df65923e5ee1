"""Files that are written whole or not at all: after a kill there is the old one or the new one."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path


def write_whole(path: Path, content: bytes, *, sole_writer: bool = False) -> None:
    """Write a file by way of one beside it. Raises OSError, and leaves nothing of it then.

    `sole_writer` says that no other process writes this file meanwhile. The one beside it then has a name that the next
    writer overwrites after a kill, and it has reached the disk before it takes the place of the old file.
    """
    part = path.with_name(f".{path.name}.part" if sole_writer else f".{path.name}.{os.getpid()}.part")
    try:
        with part.open("wb") as stream:
            stream.write(content)
            if sole_writer:
                stream.flush()
                os.fsync(stream.fileno())
        part.replace(path)
    except OSError:
        with contextlib.suppress(OSError):
            part.unlink()
        raise
