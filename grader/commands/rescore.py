"""`course rescore EXERCISE GRADES`: score a class again after a changed check; nothing is run.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.exercise import find_exercise


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    grades: Annotated[Path, typer.Argument(metavar="GRADES", help="The folder that course grade-all wrote.")],
    student: Annotated[str | None, typer.Option(help="Only this student, named as in the gradebook.")] = None,
    check: Annotated[str | None, typer.Option(help="Only where no other check than this one (its id) changes.")] = None,
) -> None:
    """Score the recordings of a class again. Exit code 1: some could not be, and keep their points."""
    from gz_course.grader.printable import shown
    from gz_course.grader.whole_class.rescore import rescore

    done = rescore(find_exercise(exercise), grades, student, check)
    for name, what in done.changed.items():
        print(f"{shown(name, 60)}: {what}")
    for name, why in done.left.items():
        print(f"left as it was: {shown(name, 60)}: {shown(why)}")
    print(f"{len(done.changed)} changed, {done.same} did not, {len(done.left)} left")
    raise typer.Exit(1 if done.left else 0)
