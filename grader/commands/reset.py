"""`course reset EXERCISE`: begin an exercise anew."""

from __future__ import annotations

from typing import Annotated

import typer

from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.pristine import put_back
from gz_course.grader.report.best import runs_folder


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
) -> None:
    """Put the starter of an exercise back. Your own file is kept, and the command says where."""
    chosen = find_exercise(exercise)
    kept = put_back(chosen, runs_folder() / chosen.name)
    for name in chosen.parts:
        print(f"{chosen.folder / name} is the starter again.")
    if kept is not None:
        print(f"Your work is kept: {kept}\nGrade it with `course grade {chosen.name} --submission {kept}`.")
