"""What grades an exercise: the folder `grading/` of it, a package that nothing else of the course imports.

It holds the manifest, the checks and what they say about mistakes. It comes with the course: a student's folder lacks
it, and grades by that of the installed course, `gz_course.exercises.NN_name.grading`. The folder of an exercise that is
not the installed course's is a package of a name of its own, which changes with its text.
"""

from __future__ import annotations

import functools
import hashlib
import importlib
import sys
from pathlib import Path
from types import ModuleType

from gz_course.grader.course_folder.material import GRADING

MANIFEST = "exercise.toml"
README = "README.md"
INSTALLED = "gz_course.exercises"


def grading_folder(exercise: Path) -> Path | None:
    """Return what grades the exercise in this folder: its own `grading/`, else the installed course's; None: neither.

    Only a folder with a manifest counts.
    """
    homes = (exercise, *(place / exercise.name for place in _installed()))
    return next((home / GRADING for home in homes if (home / GRADING / MANIFEST).is_file()), None)


def grading_module(grading: Path, stem: str) -> ModuleType:
    """Import a file of the folder `grading`, by its name without `.py`. Raises whatever its code raises."""
    if (name := _installed_name(grading)) is not None:
        return importlib.import_module(f"{name}.{stem}")
    package = ModuleType(f"_grading_{_digest(grading)}")
    package.__path__ = [str(grading)]
    package = sys.modules.setdefault(package.__name__, package)
    importlib.invalidate_caches()
    writes_nothing, sys.dont_write_bytecode = sys.dont_write_bytecode, True  # an author's folder stays as it is
    try:
        return importlib.import_module(f"{package.__name__}.{stem}")
    finally:
        sys.dont_write_bytecode = writes_nothing


def grading_files(grading: Path) -> list[Path]:
    """Return the Python files of the folder `grading`, sorted."""
    return sorted(path for path in grading.glob("*.py") if path.is_file())


@functools.cache
def _installed() -> tuple[Path, ...]:
    """Return the folders of the installed course's exercises."""
    try:
        return tuple(map(Path, importlib.import_module(INSTALLED).__path__))
    except ModuleNotFoundError:  # a course of programs only
        return ()


def _installed_name(grading: Path) -> str | None:
    """Return the name by which the installed course imports this folder; None if it is another's."""
    name = grading.parent.name
    theirs = (place / name / GRADING for place in _installed())
    same = any(folder.is_dir() and folder.samefile(grading) for folder in theirs)
    return f"{INSTALLED}.{name}.{GRADING}" if same else None


def _digest(grading: Path) -> str:
    """Return a digest of the place and the Python files of a folder, so that changed checks are loaded again."""
    total = hashlib.sha256(str(grading.absolute()).encode())
    for path in grading_files(grading):
        total.update(path.name.encode() + b"\0" + path.read_bytes())
    return total.hexdigest()[:16]
