"""The command line of this process as others see it: what is secret in it is blotted out before a submission runs.

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
        fields = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
        begin, end = int(fields[FIRST]), int(fields[LAST])
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
