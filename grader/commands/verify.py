"""`course verify [EXERCISE]`: the instructor's proof that an exercise grades as it declares.

For instructors.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Self

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from gz_course.grader.commands.list import refuse_mistakes
from gz_course.grader.console import GuardedConsole
from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import Exercise, course_root, exercise_names, find_exercise
from gz_course.grader.report.best import runs_folder
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from gz_course.grader.verify.jobs import Job
    from gz_course.grader.verify.proof import Verification


def command(
    exercise: Annotated[
        str | None,
        typer.Argument(help="Exercise, or one variant of it, such as 03/rejected/never_stops; all if left out."),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Keep the recordings in this folder.")] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Grade so many variants at once. Default: one for each core.")] = len(
        os.sched_getaffinity(0)
    ),
    mutants: Annotated[bool, typer.Option(help="Also spoil each solution in one place at a time.")] = True,
) -> None:
    """Prove that solutions earn full marks, starters nothing, and rejected variants lose what they declare.

    Interrupted, the same command goes on from there.
    """
    from gz_course.grader.process.temporary_folder import TemporaryFolder, sweep
    from gz_course.grader.run.sandbox import choose, enter_early

    enter_early(choose())  # before any thread exists

    from gz_course.grader.score.check_fault import CheckFault, moved
    from gz_course.grader.verify.jobs import pool
    from gz_course.grader.verify.kept import FOLDER, Kept
    from gz_course.grader.verify.mutants import MOST
    from gz_course.grader.verify.proof import plan, planned_jobs, verify

    console = GuardedConsole()
    exercises, variant = _asked_for(exercise or "")
    plans = [plan(each, MOST if mutants else 0, variant) for each in exercises]
    refuse_mistakes([planned.exercise for planned in plans])
    sweep()
    graded, wrong = 0, list[str]()
    with TemporaryFolder("course-verify-") as folder, pool(jobs) as workers:
        work = []
        for planned in plans:
            kept = Kept(planned.exercise, out)
            work.append((planned, kept, planned_jobs(planned, (out or folder) / planned.exercise.name, kept)))
        all_jobs = [job for _, _, each in work for job in each]
        with _Bar(all_jobs, console) as bar:
            for planned, kept, its_jobs in work:
                result = None
                try:
                    for result, job in zip(verify(planned, its_jobs, workers), its_jobs, strict=True):
                        print_last(result, console)
                        bar.count(job)
                except CheckFault as fault:
                    place = runs_folder() / FOLDER / f"{planned.exercise.name}.faults"
                    raise (moved(fault, place) if out is None else fault) from fault
                kept.forget()
                if result is not None:
                    print_result(result, bool(variant), console)
                    graded, wrong = graded + len(result.proofs), wrong + result.fault_lines
    print_summary(graded, len(plans), wrong, console)
    raise typer.Exit(1 if wrong else 0)


def _asked_for(name: str) -> tuple[list[Exercise], str]:
    """Return the exercises to prove, and the name of the one variant that is asked for, if any.

    Raises UsageError or ManifestError if there is no such exercise, or if the two halves of the course do not fit.
    """
    from gz_course.grader.verify import orphans

    root = course_root()
    known = exercise_names(root)
    if not (root / "solutions").is_dir():
        raise UsageError(f"there is no folder {root / 'solutions'}: a student's copy has no solutions to prove")
    if strays := orphans(root, known):
        named = ", ".join(f"solutions/{path.name}{did_you_mean(path.name, known, listing='known')}" for path in strays)
        raise ManifestError(f"no public half in exercises/: {named}")
    if not name:
        return [find_exercise(each, root) for each in known], ""
    number, _, variant = name.partition("/")
    try:
        return [find_exercise(number, root)], variant
    except UsageError:
        return [find_exercise(name, root)], ""  # a path has a sentence of its own


class _Bar:
    """A bar in a terminal that shows how much is graded and the time left; what was done before is not timed."""

    def __init__(self, jobs: Sequence[Job], console: Console) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

        self._before = {job.kept for job in jobs if job.done}
        columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
        period = 1e4  # [s], for gradings take long
        self._progress = Progress(
            *columns, console=console, disable=not console.is_terminal, transient=True, speed_estimate_period=period
        )
        self._row = self._progress.add_task("", total=len(jobs) - len(self._before))
        if self._before:
            console.print(f"{len(self._before)} of {len(jobs)} were graded before the interruption", highlight=False)

    def count(self, job: Job) -> None:
        if job.kept not in self._before:
            self._progress.update(self._row, advance=1, description=job.exercise.name)

    def __enter__(self) -> Self:
        self._progress.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._progress.stop()


def print_result(result: Verification, of_one: bool, console: Console) -> None:
    """Print the result of an exercise, or what the report on one variant of it says first."""
    if of_one:
        report = result.proofs[-1].report
        console.print(f"  {report.score.points:g} of {report.max_score:g} points", highlight=False)
        if report.score.feedback:
            console.print(f"  {escape(report.score.feedback)}", highlight=False, soft_wrap=True)
        return
    print_matrix(result, console)
    print_mutants(result, console)
    print_faults([f"{result.exercise.name}: {fault}" for fault in result.faults], console)


def print_last(result: Verification, console: Console) -> None:
    """Print the verdict on the variant or mutant graded last, with the reasons if it is wrong."""
    name = result.exercise.name
    if not result.mutants:
        proof = result.proofs[-1]
        if not proof.faults:
            console.print(f"[green]ok[/green]  {name}  {proof.variant.name}", highlight=False)
        print_faults([f"{name}  {proof.variant.name}: {fault}" for fault in proof.faults], console)
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
