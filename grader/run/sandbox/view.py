"""The files a submission sees: a list of places, the same for every way of building the sandbox.

They are the system's programs and libraries, Python with what is installed for it, `sim/`, `public/`, and of the grader
only what runs in the submission's own process; all read-only. Exercises, solutions, tests, homes and other submissions
are not mounted at all; where a course lies below a folder that is shown (as in /usr/src), it is masked.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import gz_course
from gz_course.grader.exercise import course_root

SUBMISSION = Path("/submission")
SOCKETS = Path("/grader")  # the grader's sockets
HOME = Path("/tmp")
SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/libx32")
SETTINGS = ("ld.so.cache", "alternatives", "localtime")  # of /etc
DEVICES = ("null", "zero", "full", "random", "urandom")
LINKS = {"/dev/fd": "/proc/self/fd", "/dev/stdin": "fd/0", "/dev/stdout": "fd/1", "/dev/stderr": "fd/2"}
HALVES = ("exercises", "solutions")  # of a course: they may lie below one of the places shown
INSTALLED = ("exercises", "chapters")  # of a course, in the installed package
# Folders of the package `grader` that are needed inside.
OF_THE_GRADER = ("run/agent", "run/sandbox/init")
TMP_SIZE, TMP_FILES = 64 << 20, 20_000  # [bytes] and files of /tmp
SHM_SIZE, SHM_FILES = 16 << 20, 1_000  # of /dev/shm


@dataclass(frozen=True)
class Place:
    """A file or folder of the sandbox at `path`.

    `kind` is `bind` (read-only, from `source`), `device` (from `source`), `link` (to `source`), `folder` (empty),
    `mask` (empty and read-only, hides something bound), `proc` or `tmpfs` (writable).
    """

    kind: str
    path: str
    source: str = ""
    size: int = 0  # [bytes] of a tmpfs
    files: int = 0  # largest number of files in a tmpfs


def view(submission: Path, door: Path, etc: Path) -> list[Place]:
    """Return the places of a sandbox, parents first.

    `submission` is bound to `SUBMISSION` and `door` to `SOCKETS`; `etc` holds replacements for files of /etc.
    """
    places = [_system(name) for name in SYSTEM if os.path.lexists(name)]
    places += [_bind(f"/etc/{name}", f"/etc/{name}") for name in SETTINGS if Path("/etc", name).exists()]
    places += [_bind(f"/etc/{path.name}", path) for path in etc.iterdir()]
    homes = _python()
    places += [_bind(home, home) for home in homes if not any(home.is_relative_to(name) for name in SYSTEM)]
    package = _package("gz_course.grader")
    masks = [path for path in (*_courses(package), package) if _within(path, places)]
    places += [Place("mask", str(path)) for path in masks]
    places += [_bind(home, home) for home in homes if any(home.is_relative_to(mask) for mask in masks)]
    places += [_bind(path, path) for path in (_package("gz_course.sim"), Path(gz_course.__file__).parents[1])]
    places += [_bind(path, path) for pattern in OF_THE_GRADER for path in package.glob(pattern)]
    places += [_bind(SUBMISSION, submission), _bind(SOCKETS, door), Place("proc", "/proc")]
    places += [Place("device", f"/dev/{name}", f"/dev/{name}") for name in DEVICES]
    places += [Place("link", path, target) for path, target in LINKS.items()]
    places += [Place("tmpfs", str(HOME), size=TMP_SIZE, files=TMP_FILES)]
    places += [Place("tmpfs", "/dev/shm", size=SHM_SIZE, files=SHM_FILES)]
    by_path = {place.path: place for place in places}
    for path in list(by_path):
        for parent in Path(path).parents[:-1]:
            masked = any(parent.is_relative_to(mask) and parent != mask for mask in masks)
            if masked or not _within(parent, places):
                by_path.setdefault(str(parent), Place("folder", str(parent)))
    return sorted(by_path.values(), key=lambda place: Path(place.path).parts)


def readable(places: Iterable[Place]) -> list[str]:
    """Return the files and folders that may be read where nothing can be masked: of a place with a mask, all else."""
    masks = [Path(place.path) for place in places if place.kind == "mask"]
    found: list[str] = []

    def take(path: Path) -> None:
        if any(mask.is_relative_to(path) for mask in masks):
            if path not in masks:
                for inside in path.iterdir():
                    take(inside)
        else:
            found.append(str(path))

    for place in places:
        if place.kind == "bind":
            take(Path(place.source))
    return found


def _courses(package: Path) -> list[Path]:
    """Return the folders of courses: that of the exercises, and what surrounds the package `grader`.

    That is a checkout, or the installed package, of which `sim` must stay to be seen.
    """
    roots = {course_root().resolve(), package.parent}
    found = [root for root in roots if any((root / half).is_dir() for half in HALVES)]
    inside = Path(gz_course.__file__).resolve().parent
    return [path for root in found for path in ((root / h for h in INSTALLED) if root == inside else (root,))]


def _bind(path: str | Path, source: str | Path) -> Place:
    return Place("bind", str(path), os.path.realpath(source))


def _system(name: str) -> Place:
    return Place("link", name, str(Path(name).readlink())) if Path(name).is_symlink() else _bind(name, name)


def _within(path: Path, places: list[Place]) -> bool:
    name = f"{path}/"
    return any(place.kind == "bind" and name.startswith(f"{place.path}/") for place in places)


def _python() -> list[Path]:
    """Return the folders of the interpreter and its packages, under each name by which they are reached."""
    homes = {Path(p) for p in (sys.prefix, sys.exec_prefix, sys.base_prefix, sys.base_exec_prefix)}
    # `home` in pyvenv.cfg may be a link to the real place; both names are used at a start.
    return list(homes | {path.resolve() for path in homes})


def _package(name: str) -> Path:
    spec = find_spec(name)
    assert spec is not None and spec.submodule_search_locations
    return Path(next(iter(spec.submodule_search_locations))).resolve()
