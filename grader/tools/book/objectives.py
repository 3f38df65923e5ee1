"""The map of the course: the objectives of each chapter, its exercise, the checks, and what proves each check.

Generated from the notebooks, the manifests and the instructor's half.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from gz_course.grader.exercise import CheckSpec, Exercise, find_exercise
from gz_course.grader.tools.book.chapter import Chapter, chapters
from gz_course.grader.verify import variants


@dataclass(frozen=True)
class Proven:
    """A check and the names of the rejected variants that must fail it."""

    check: CheckSpec
    rejected: tuple[str, ...]


@dataclass(frozen=True)
class Lesson:
    """A chapter with its exercise. `proven` is empty in a students' copy, which has no rejected variants."""

    chapter: Chapter
    exercise: Exercise
    proven: tuple[Proven, ...]


def lessons(root: Path) -> list[Lesson]:
    """Return all lessons of a course folder in order. Raises CourseError for a chapter without its exercise."""
    return [_lesson(root, chapter) for chapter in chapters(root)]


def _lesson(root: Path, chapter: Chapter) -> Lesson:
    exercise = find_exercise(chapter.name, root)
    if not exercise.twin.is_dir():
        return Lesson(chapter, exercise, ())
    rejected = [each for each in variants(exercise) if each.name.startswith("rejected/")]
    proven = [
        Proven(check, tuple(each.name.partition("/")[2] for each in rejected if check.id in each.fails))
        for check in exercise.checks
    ]
    return Lesson(chapter, exercise, tuple(proven))
