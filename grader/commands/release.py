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
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="A folder that is new, empty, or an earlier copy.")],
    only: Annotated[str, typer.Option(help="Only these exercises, such as 00-05 or 03,07. Default: all.")] = "",
) -> None:
    """Write what students get: exercises, chapters, programs and a README for students; no solutions, no drafts.

    An earlier copy keeps its exercises, gets those that are new, and is brought up to date.
    """
    names, changes = release(course_root(), folder, only)
    if changes is not None:
        for line in changes.lines:
            print(line)
    files = sum(path.is_file() for path in folder.rglob("*"))
    print(f"{folder}: {', '.join(names)}; {files} files, without solutions. Its README.md tells students how to begin.")
