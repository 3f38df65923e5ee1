"""`course init FOLDER`: lay the course out in a folder to work in."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.course_folder.layout import lay_out


def command(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="A folder that is new or empty.")],
    with_solutions: Annotated[
        bool, typer.Option("--with-solutions", help="For instructors, from a checkout of the course.")
    ] = False,
) -> None:
    """Lay out chapters, exercises and a README in a folder of your own."""
    names = lay_out(folder, solutions=with_solutions)
    print(
        f"{folder}: {len(names)} exercises and their chapters. Read its README.md; there, run: course grade {names[0]}"
    )
