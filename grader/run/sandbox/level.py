"""The sandbox levels, and the best one that works on this machine.

A level works if a node in the sandbox and one outside can exchange a message over DDS (`probe.py`). The answer holds
until the machine or the installation changes; it is kept in the user's cache folder so that a grading need not repeat
the test.
"""

from __future__ import annotations

import contextlib
import hashlib
import importlib
import json
import os
import platform
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import Protocol, cast

from gz_course.grader.errors import InfrastructureError, UsageError
from gz_course.grader.run.sandbox.spec import SandboxSpec
from gz_course.sim.did_you_mean import did_you_mean

AUTO = "auto"
OFFICIAL = "B"  # the least level for a grade that counts: at it, hostile code and other gradings are kept out
# The firmest first; each file of `levels/` is a level.
LEVELS = tuple(sorted(p.stem.upper() for p in Path(__file__).with_name("levels").glob("[a-z].py")))
KEPT = 8  # answers; one process may be root, another in a user namespace
GUIDE = 'docs/instructors.md, "A firm sandbox",'
CACHE = "gz-ros2-course/sandbox.json"  # below XDG_CACHE_HOME


class Level(Protocol):
    """The interface of a file of `levels/`."""

    ABOUT: str  # in a few words
    PRIVATE_NETWORK: bool
    NAMESPACES: str  # what builds the namespaces: `bubblewrap`, `own` (init/namespaces.py), or empty for none
    LANDLOCK: bool

    def missing(self) -> str:
        """Return what this level lacks here; empty if it can be tried."""

    def command(self, spec: SandboxSpec, init: list[str]) -> list[str]:
        """Return the command that runs `init` in the sandbox."""


def level_module(level: str) -> Level:
    """Return the module of a level by its letter. Raises UsageError if there is none."""
    if level not in LEVELS:
        raise UsageError(f"there is no sandbox level {level!r}{did_you_mean(level, (AUTO, *LEVELS), listing='known')}")
    return cast(Level, importlib.import_module(f"gz_course.grader.run.sandbox.levels.{level.lower()}"))


def choose(wanted: str = AUTO, demand: str | None = None) -> str:
    """Return the level to grade with: the one `wanted`, which must be at least as firm as `demand`.

    Raises UsageError for an unknown level, InfrastructureError for one that does not work here.
    """
    for level in (wanted, demand):
        if level not in (AUTO, None):
            level_module(str(level))
    best, why = (wanted, {}) if wanted != AUTO else best_level()
    if demand is not None and LEVELS.index(best) > LEVELS.index(demand):
        if wanted != AUTO:
            raise UsageError(f"sandbox level {wanted} is asked for, but at least {demand} is demanded")
        reason = why.get(demand) or next(iter(why.values()), "it was not tried")
        raise InfrastructureError(
            f"a sandbox of level {demand} or better is demanded, but the best here is {best}: {reason}; "
            f"{GUIDE} says how to get it, `course doctor` shows more; `--sandbox {best}` without --demand takes {best}"
        )
    return best


def check_jobs(level: str, jobs: int) -> None:
    """Raise UsageError if so many gradings must not run beside each other on one machine at this level."""
    if jobs > 1 and not level_module(level).PRIVATE_NETWORK:
        raise UsageError(
            f"{jobs} gradings at a time need a sandbox of level {OFFICIAL} or better, because at level {level} they "
            "share a network and one submission can spoil another's grade; give --jobs 1 (with Dask: one worker with "
            f"one thread a machine), or get level {OFFICIAL} ({GUIDE} says how)"
        )


@cache
def best_level() -> tuple[str, dict[str, str]]:
    """Return the best level that works here, and why each better one does not; tested once per boot."""
    from gz_course.grader.run.sandbox.probe import try_level, try_levels

    path, key = _cache(), _fingerprint()
    with contextlib.suppress(OSError, ValueError, KeyError, TypeError):
        known = json.loads(path.read_text())[key]
        if known["level"] in LEVELS:
            return known["level"], dict(known["why"])
    level, why, certain = try_levels(try_level)
    if certain:
        remember(level, why)
    return level, why


def remember(level: str, why: dict[str, str]) -> None:
    """Cache the answer beside a few earlier ones; a cache that cannot be written is ignored."""
    path = _cache()
    known: dict[str, object] = {}
    with contextlib.suppress(OSError, ValueError, TypeError, AttributeError):
        known = dict(list(json.loads(path.read_text()).items())[-KEPT:])
    known.pop(_fingerprint(), None)
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False) as file:
            json.dump(known | {_fingerprint(): {"level": level, "why": why}}, file)
        Path(file.name).replace(path)


def _cache() -> Path:
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / CACHE


def _fingerprint() -> str:
    """Return a hash of what the answer depends on: boot and kernel, user and privileges, installation."""
    parts = [platform.release(), sys.prefix, str(os.geteuid())]
    with contextlib.suppress(OSError):
        parts.append(Path("/proc/sys/kernel/random/boot_id").read_text())
    with contextlib.suppress(OSError):
        status = Path("/proc/self/status").read_text().splitlines()
        parts += [line for line in status if line.startswith(("CapEff", "CapBnd", "NoNewPrivs", "Seccomp:"))]
    with contextlib.suppress(OSError):
        parts += [Path("/proc/self/uid_map").read_text(), str(Path("/proc/self/ns/mnt").readlink())]
    here = Path(__file__).parent
    for file in sorted(here.rglob("*.py")):
        parts.append(f"{file} {file.stat().st_mtime_ns}")
    with contextlib.suppress(OSError):
        parts.append(str(Path(sys.prefix, "lib").stat().st_mtime_ns))
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()
