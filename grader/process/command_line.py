"""The command line of this process as others see it: what is secret in it is blotted out before a submission runs.

A process that was forked to do something else has the command line of the one it was forked from; it shows its own.

Where a sandbox has no process namespace, a submission can read every command line of the machine.

Source: proc(5), `/proc/pid/stat`, fields 48 and 49; `/proc/pid/cmdline`.
"""

from __future__ import annotations

import contextlib
import ctypes
from pathlib import Path

SECRET = ("--seed", "--trials")  # options whose value tells what will be asked
FIRST, LAST = 48 - 3, 49 - 3  # addresses of the first and last byte, counted from the field behind the name


def blot_out() -> None:
    """Overwrite the values of the options `SECRET` in /proc/self/cmdline; what was parsed of them stays as it is."""
    with contextlib.suppress(OSError, ValueError, IndexError):
        begin, end = _place()
        words = ctypes.string_at(begin, end - begin).split(b"\0")
        at, before = begin, b""
        for word in words:
            name, is_one_word, value = word.partition(b"=")
            if before.decode(errors="replace") in SECRET:
                ctypes.memset(at, ord("."), len(word))
            elif is_one_word and name.decode(errors="replace") in SECRET:
                ctypes.memset(at + len(name) + 1, ord("."), len(value))
            at += len(word) + 1
            before = word


def show(*words: str) -> None:
    """Overwrite /proc/self/cmdline with other words, as far as there is room."""
    with contextlib.suppress(OSError, ValueError, IndexError):
        begin, end = _place()
        room = end - begin
        ctypes.memmove(begin, "\0".join(words).encode(errors="replace")[: room - 1].ljust(room, b"\0"), room)


def _place() -> tuple[int, int]:
    fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    return int(fields[FIRST]), int(fields[LAST])
