"""`course verify [EXERCISE]`: the instructor's proof that an exercise grades as it says."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader.errors import ManifestError, nearest
from grader.exercise import course_root, exercise_names, find_exercise

if TYPE_CHECKING:
    from rich.console import Console

    from grader.verify import Verification


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(name="verify")(verify_command)


def verify_command(
    exercise: Annotated[str | None, typer.Argument(help="Exercise; all of them if left out.")] = None,
    out: Annotated[Path | None, typer.Option(help="Keep the recordings in this folder.")] = None,
) -> None:
    """Prove that solutions earn full marks, starters nothing, and rejected variants lose what they declare."""
    from rich.console import Console

    from grader.verify import orphans, verify

    console = Console()
    root = course_root()
    known = exercise_names(root)
    if strays := orphans(root, known):
        named = ", ".join(f"solutions/{path.name}{nearest(path.name, known)}" for path in strays)
        raise ManifestError(f"no public half in exercises/: {named}")
    names = [find_exercise(exercise).name] if exercise else known
    proven = True
    with tempfile.TemporaryDirectory(prefix="course-verify-") as folder:
        for name in names:
            result = None
            for result in verify(find_exercise(name), (out or Path(folder)) / name):
                proof = result.proofs[-1]
                verdict = "[red]WRONG[/red]" if proof.faults else "[green]ok[/green]"
                console.print(f"{verdict}  {name}  {proof.variant.name}", highlight=False)
            if result is not None:
                print_matrix(result, console)
                proven = proven and result.proven
    raise typer.Exit(0 if proven else 1)


def print_matrix(result: Verification, console: Console) -> None:
    """Print which variant fails which check, and everything that is wrong."""
    from rich.markup import escape
    from rich.table import Table

    checks = result.exercise.checks
    table = Table(title=f"{result.exercise.name}: x = fails", box=None, padding=(0, 2, 0, 0), title_justify="left")
    table.add_column("variant")
    for number, _ in enumerate(checks, 1):
        table.add_column(str(number), justify="center")
    table.add_column("points", justify="right")
    for proof in result.proofs:
        marks = ["x" if check.id in proof.failed else "." for check in checks]
        table.add_row(proof.variant.name, *marks, f"{proof.report.score.points:g}/{result.exercise.max_score:g}")
    console.print(table)
    for number, check in enumerate(checks, 1):
        console.print(f"  {number}  {check.id} ({check.points:g} points)", highlight=False)
    for fault in result.faults:
        console.print(f"[red]WRONG[/red]  {result.exercise.name}: {escape(fault)}", highlight=False)
    for proof in result.proofs:
        for fault in proof.faults:
            console.print(f"[red]WRONG[/red]  {proof.variant.name}: {escape(fault)}", highlight=False)
