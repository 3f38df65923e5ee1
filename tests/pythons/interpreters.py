"""The Pythons of this machine that the course promises to run on."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from gz_course.sim.machine import NEWEST, OLDEST

PROMISED = [(3, minor) for minor in range(OLDEST[1], NEWEST[1] + 1)]
PYENV = Path("~/.pyenv/versions")
_WHICH = "import sys; print(*sys.version_info[:3], sys.implementation.name, getattr(sys, 'abiflags', ''))"


@dataclass(frozen=True)
class Interpreter:
    """A CPython: where it is, and its version, such as (3, 12, 1)."""

    path: str
    version: tuple[int, int, int]

    @property
    def name(self) -> str:
        return ".".join(map(str, self.version))


def found(named: Sequence[str] = ()) -> list[Interpreter]:
    """Return the newest interpreter of each promised version, oldest version first.

    `named` are paths or commands to look at instead of those on the search path and of pyenv.
    """
    newest: dict[tuple[int, int], Interpreter] = {}
    for path in named or _installed():
        interpreter = _asked(path)
        if interpreter is None or interpreter.version[:2] not in PROMISED:
            continue
        other = newest.get(interpreter.version[:2])
        if other is None or other.version < interpreter.version:
            newest[interpreter.version[:2]] = interpreter
    return [newest[version] for version in sorted(newest)]


def _installed() -> Iterable[str]:
    for major, minor in PROMISED:
        if path := shutil.which(f"python{major}.{minor}"):
            yield path
        yield from map(str, PYENV.expanduser().glob(f"{major}.{minor}.*/bin/python3"))


def _asked(path: str) -> Interpreter | None:
    """Ask a program for its version; None if it is no CPython with the global lock, or does not start."""
    try:
        done = subprocess.run([path, "-I", "-c", _WHICH], capture_output=True, text=True, timeout=60, check=True)
    except (OSError, subprocess.SubprocessError):
        return None  # such as pyenv's stand-in for a version that is not chosen
    major, minor, micro, implementation, *flags = done.stdout.split()
    if implementation != "cpython" or "t" in "".join(flags):
        return None
    return Interpreter(path, (int(major), int(minor), int(micro)))
