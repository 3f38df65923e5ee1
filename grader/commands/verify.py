"""`course verify [EXERCISE]`: the instructor's proof that an exercise grades as it declares.

For instructors.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import course_root, exercise_names, find_exercise
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from gz_course.grader.verify.proof import Verification


def command(
    exercise: Annotated[str | None, typer.Argument(help="Exercise; all of them if left out.")] = None,
    out: Annotated[Path | None, typer.Option(help="Keep the recordings in this folder.")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Grade so many variants at once. Default: one for each core.")] = len(
        os.sched_getaffinity(0)
    ),
    mutants: Annotated[bool, typer.Option(help="Also spoil each solution in one place at a time.")] = True,
) -> None:
    """Prove that solutions earn full marks, starters nothing, and rejected variants lose what they declare."""
    from gz_course.grader.process.temporary_folder import TemporaryFolder, sweep
    from gz_course.grader.run.sandbox import choose, enter_early

    enter_early(choose())  # before any thread exists

    from gz_course.grader.verify import orphans
    from gz_course.grader.verify.jobs import pool
    from gz_course.grader.verify.mutants import MOST
    from gz_course.grader.verify.proof import verify

    console = Console()
    root = course_root()
    known = exercise_names(root)
    if not (root / "solutions").is_dir():
        raise UsageError(f"there is no folder {root / 'solutions'}: a student's copy has no solutions to prove")
    if strays := orphans(root, known):
        named = ", ".join(f"solutions/{path.name}{did_you_mean(path.name, known, listing='known')}" for path in strays)
        raise ManifestError(f"no public half in exercises/: {named}")
    names = [find_exercise(exercise).name] if exercise else known
    sweep()
    graded, wrong = 0, list[str]()
    with TemporaryFolder("course-verify-") as folder, pool(jobs) as workers:
        for name in names:
            result = None
            for result in verify(find_exercise(name), (out or folder) / name, workers, MOST if mutants else 0):
                print_last(result, console)
            if result is not None:
                print_matrix(result, console)
                print_mutants(result, console)
                print_faults(result.fault_lines, console)
                graded, wrong = graded + len(result.proofs), wrong + result.fault_lines
    print_summary(graded, len(names), wrong, console)
    raise typer.Exit(1 if wrong else 0)


def print_last(result: Verification, console: Console) -> None:
    """Print the verdict on the variant or mutant graded last."""
    name = result.exercise.name
    if not result.mutants:
        proof = result.proofs[-1]
        verdict = "[red]WRONG[/red]" if proof.faults else "[green]ok[/green]"
        console.print(f"{verdict}  {name}  {proof.variant.name}", highlight=False)
    else:
        last = result.mutants[-1]
        verdict = "[green]killed[/green]" if last.failed else "[yellow]SURVIVED[/yellow]"
        console.print(f"{verdict}  {name}  mutant {escape(last.mutant.change)}", highlight=False, soft_wrap=True)


def print_matrix(result: Verification, console: Console) -> None:
    """Print which variant fails which check, and how many variants each check fails."""
    checks = result.exercise.checks
    table = Table(title=f"{result.exercise.name}: x = fails", box=None, padding=(0, 2, 0, 0), title_justify="left")
    table.add_column("variant", no_wrap=True, min_width=max(len(proof.variant.name) for proof in result.proofs))
    for number, _ in enumerate(checks, 1):
        table.add_column(str(number), justify="center")
    table.add_column("points", justify="right")
    table.add_column("only in trial")
    for proof in result.proofs:
        marks = ["x" if check.id in proof.failed else "." for check in checks]
        points = f"{proof.report.score.points:g}/{result.exercise.max_score:g}"
        trials = [t.name for t in proof.report.trials if t.score.points < result.exercise.max_score]
        every = len(trials) == len(proof.report.trials)
        table.add_row(proof.variant.name, *marks, points, "" if every or not trials else ", ".join(trials))
    kills = [result.killed_by(check.id) for check in checks]
    table.add_section()
    table.add_row("rejected that fail it", *(str(variants) for variants, _ in kills))
    if result.mutants:
        table.add_row(f"mutants that fail it (of {len(result.mutants)})", *(str(mutants) for _, mutants in kills))
    console.print(table)
    for number, check in enumerate(checks, 1):
        console.print(f"  {number}  {check.id} ({check.points:g} points)", highlight=False)


def print_mutants(result: Verification, console: Console) -> None:
    """Print the mutants that no check failed, with file and line."""
    if not result.mutants:
        return
    dead = len(result.mutants) - len(result.survivors)
    console.print(f"  {dead} of {len(result.mutants)} mutants of the solution were found out", highlight=False)
    for mutant in result.survivors:
        place = f"solutions/{result.exercise.name}/{mutant.file}:{mutant.line}"
        console.print(
            f"[yellow]survivor[/yellow]  {escape(place)}  {mutant.operator}: {escape(mutant.change)}",
            highlight=False,
            soft_wrap=True,
        )
    if result.survivors:
        console.print(
            "  A survivor earns full marks: sharpen a check, or declare it in expect.toml as \\[mutants] equivalent.",
            highlight=False,
        )


def print_faults(found: list[str], console: Console) -> None:
    for fault in found:
        console.print(f"[red]WRONG[/red]  {escape(fault)}", highlight=False, soft_wrap=True)


def print_summary(graded: int, exercises: int, wrong: list[str], console: Console) -> None:
    """Print the result of several exercises; their faults stand far above and are repeated."""
    if exercises == 1:
        return
    if wrong:
        console.print()
        print_faults(wrong, console)
    said = f"[red]{len(wrong)} wrong[/red]" if wrong else "all as declared"
    console.print(f"{graded} variants of {exercises} exercises: {said}", highlight=False)
