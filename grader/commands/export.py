"""`course export EXERCISE GRADES --roster FILE --out FILE`: the grades of a class for Moodle or Canvas.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise

SHOWN = 20  # students that are listed on the terminal


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    grades: Annotated[Path, typer.Argument(metavar="GRADES", help="The folder that course grade-all wrote.")],
    roster: Annotated[
        Path, typer.Option(help="The students as Moodle or Canvas export them (docs/learning_platforms.md).")
    ],
    out: Annotated[Path, typer.Option(help="The CSV file to write, for the import; an overview is written beside it.")],
    column: Annotated[
        str | None, typer.Option(help="The assignment in the platform. Default: the name of the exercise.")
    ] = None,
    points: Annotated[
        float | None, typer.Option(min=0, help="What full marks are worth there. Default: as in the exercise.")
    ] = None,
    deadline: Annotated[
        str | None, typer.Option(help="As '2026-11-20 23:59 Europe/Berlin': adds the column LATE, which costs nothing.")
    ] = None,
    submissions: Annotated[
        Path | None, typer.Option(help="What was graded: the folder or zip, for the times of the submissions.")
    ] = None,
    map_file: Annotated[
        Path | None, typer.Option("--map", metavar="FILE", help="As for course grade-all, if it was given there.")
    ] = None,
) -> None:
    """Write the grades of a class as Moodle or Canvas import them. Exit code 1: some students are not in the file."""
    from gz_course.grader.learning_platforms.export import export, write

    chosen = find_exercise(exercise)
    target = out.with_name(f"{out.stem}.overview.csv")
    given = {path.resolve() for path in (roster, grades / "gradebook.csv")}
    if given & {out.resolve(), target.resolve()}:
        raise UsageError(f"--out {out} would overwrite what is read; give another file")
    told = export(chosen, grades, roster, column, points, deadline, submissions, map_file)
    write(out, told.grades.text)
    write(target, told.overview)
    print(f"{out}: {len(told.grades.written)} of {told.students} students, for {told.system}. {told.grades.advice}")
    for match, why in told.grades.left_out[:SHOWN]:
        print(f"not in it: {match.member.row.student} ({match.member.row.submission}): {why}")
    if len(told.grades.left_out) > SHOWN:
        print(f"... and {len(told.grades.left_out) - SHOWN} more")
    if told.without:
        print(f"{told.without} students of the roster have no submission; their grades stay as they are")
    if told.late:
        print(f"late: {told.late}; no points are taken off")
    print(f"{target}: what became of each submission")
    raise typer.Exit(1 if told.grades.left_out else 0)
