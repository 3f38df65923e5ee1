"""`course ci`: grade your repository on GitHub Actions.

For instructors.
"""

from __future__ import annotations

from typing import Annotated

import typer

from gz_course.grader.course_folder.workflow import begun, write_workflow
from gz_course.grader.exercise import course_root, find_exercise


def command(
    exercises: Annotated[
        list[str] | None, typer.Argument(metavar="[EXERCISE]...", help="Default: those that you have begun.")
    ] = None,
    wheel: Annotated[
        str | None, typer.Option(help="The course's wheel in your repository, if it is to be installed from that file.")
    ] = None,
) -> None:
    """Write a GitHub Actions workflow that grades your exercises on every push, with pip alone."""
    root = course_root()
    names = [find_exercise(name, root).name for name in exercises] if exercises else begun(root)
    path = write_workflow(root, names, wheel)
    print(f"{path}: {', '.join(names)}. Commit it, and push.")
