"""`course update`: bring the chapters and exercises of the installed course to the folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.course_folder.layout import update, update_from
from gz_course.grader.exercise import course_root


def command(
    folder: Annotated[
        Path | None, typer.Argument(metavar="[FOLDER]", help="A folder that `course init` made. Default: this one.")
    ] = None,
    source: Annotated[
        Path | None, typer.Option("--from", help="A newer copy from your instructor, instead of the installed course.")
    ] = None,
) -> None:
    """Bring newer chapters and exercises to your folder. What you have changed stays as it is."""
    folder = folder or course_root()
    changes = update(folder) if source is None else update_from(folder, source)
    for line in changes.lines:
        print(line)
    if changes == type(changes)():
        print(f"{folder} is up to date.")
