"""`course release DIR`: the students' copy of the course, without solutions.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.exercise import course_root
from gz_course.grader.release.student_copy import release


def command(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder that is new or empty.")],
) -> None:
    """Write what students get: exercises, chapters, programs and a README for students; no solutions."""
    names = release(course_root(), folder)
    files = sum(path.is_file() for path in folder.rglob("*"))
    print(f"{folder}: {', '.join(names)}; {files} files, without solutions. Its README.md tells students how to begin.")
