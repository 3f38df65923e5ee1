"""Where the course's chapters and exercises are: in the wheel, or in the checkout that this code belongs to."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from gz_course.grader.errors import ManifestError

PARTS = ("exercises", "chapters")
GRADING = "grading"  # folder of an exercise that students do not get
CHAPTER_RULES = Path("chapters/README.md")
TRACES = ("__pycache__", "*.pyc", "*.rrd", "*.rrd.part", "runs", "recorded_run", "*.egg-info", "*~", "*.orig", "*.bak")
_CODE = Path(__file__).parents[2]  # the checkout, or the installed package


def material() -> Path:
    """Return the folder with `exercises/` and `chapters/` that came with this code."""
    return _CODE


def material_files(root: Path) -> Iterator[tuple[Path, Path]]:
    """Yield each file that students get of a course's folder: its path in there, and its full path.

    These are chapters and exercises without what grades them. Raises ManifestError for a link out of it.
    """
    for part in PARTS:
        for path in plain_files(root / part):
            inside = path.relative_to(root)
            if inside != CHAPTER_RULES and not (part == "exercises" and inside.parts[2:3] == (GRADING,)):
                yield inside, path


def plain_files(folder: Path, *, without_links_of: Path | None = None) -> Iterator[Path]:
    """Yield the files of a folder, sorted, except hidden ones and caches.

    Links that stand in `without_links_of` are left out. Raises ManifestError for another link out of the folder.
    """
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        parents = [inside, *inside.parents][:-1]
        if any(each.name.startswith(".") or any(each.match(trace) for trace in TRACES) for each in parents):
            continue
        if path.is_symlink() and path.parent == without_links_of:
            continue
        if path.is_symlink() and not path.resolve().is_relative_to(folder.resolve()):
            raise ManifestError(f"{path} is a link out of {folder}, which students do not get; copy the file instead")
        if path.is_file():
            yield path
