"""`course package EXERCISE --out FILE.zip`: an autograder for Gradescope."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.exercise import find_exercise
from gz_course.grader.package.gradescope import package
from gz_course.grader.run.sandbox import OFFICIAL


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    out: Annotated[Path, typer.Option(help="The zip to write.")],
    trials: Annotated[
        str | None, typer.Option(help="As for course grade: public, hidden, all, or a file. Default: all there are.")
    ] = None,
    demand: Annotated[
        str, typer.Option(help="The least sandbox level. C where the platform cannot do B (docs/instructors.md).")
    ] = OFFICIAL,
) -> None:
    """Package an exercise as a Gradescope autograder: setup.sh, run_autograder, the course, the hidden trials."""
    names = package(find_exercise(exercise), out, trials, demand)
    size = out.stat().st_size
    print(f"{out}: {len(names)} files, {size / 1e6:.1f} MB. Upload it as the autograder of a programming assignment.")
