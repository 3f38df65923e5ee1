"""`course list`: the exercises there are."""

from __future__ import annotations

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(name="list")(list_command)


def list_command() -> None:
    """List the exercises with their points and the file each asks for."""
    from rich.console import Console
    from rich.table import Table

    from grader.exercise import course_root, exercise_names, find_exercise

    root = course_root()
    table = Table(show_edge=False, box=None, padding=(0, 2, 0, 0))
    for heading in ("exercise", "points", "file", "title"):
        table.add_column(heading, overflow="fold")
    for name in exercise_names(root):
        exercise = find_exercise(name, root)
        table.add_row(name, f"{exercise.max_score:g}", exercise.file, exercise.title)
    Console().print(table)
