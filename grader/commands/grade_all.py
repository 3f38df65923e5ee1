"""`course grade-all EXERCISE DIR_OR_ZIP --out DIR`: grade a class; the same command resumes a run that was killed.

For instructors.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape

from gz_course.grader.console import GuardedConsole
from gz_course.grader.errors import Interrupted, UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.printable import shown
from gz_course.grader.report.format import with_report_flags
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from gz_course.grader.learning_platforms.submission_times import Submitted
    from gz_course.grader.whole_class.class_run import ClassRun
    from gz_course.grader.whole_class.found import Found

ESTIMATED_AFTER = 20  # gradings of this run


@with_report_flags
def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    submissions: Annotated[
        Path, typer.Argument(metavar="DIR_OR_ZIP", help="A folder, file or archive for each student, or a zip of them.")
    ],
    out: Annotated[Path, typer.Option(help="Folder for the gradebook, and a folder with reports for each student.")],
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Gradings at the same time. Default: one a core, at level C and D one.")
    ] = None,
    dask: Annotated[
        str | None, typer.Option(help="Grade on Dask's workers: tcp://HOST:PORT of a scheduler, or local:N.")
    ] = None,
    seed: Annotated[int, typer.Option(help="As for course grade.")] = 0,
    trials: Annotated[str, typer.Option(help="As for course grade: public, hidden, all, or a file.")] = "public",
    sandbox: Annotated[str, typer.Option(help="As for course grade: auto, A, B, C or D.")] = "auto",
    demand: Annotated[
        str | None,
        typer.Option(help="As for course grade: the least level. Default: B, unless --sandbox names a level."),
    ] = None,
    keep: Annotated[
        str, typer.Option(help="Whose recordings stay: all, failing (those without full marks) or none.")
    ] = "all",
    explain: Annotated[
        bool,
        typer.Option("--explain", help="Then search what would help each, as course explain does, and group them."),
    ] = False,
    map_file: Annotated[
        Path | None,
        typer.Option("--map", metavar="FILE", help="Whose a GitHub login is: a CSV file with login, student."),
    ] = None,
    plan: Annotated[bool, typer.Option("--plan", help="Print what it will take, and grade nothing.")] = False,
    *,
    reports: dict[str, bool],
) -> None:
    """Grade a class. Exit code 0: all are graded, 2: usage, 3: some could not be, which is not the students' fault."""
    from gz_course.grader.learning_platforms.login_map import read_login_map
    from gz_course.grader.learning_platforms.submission_times import times_in
    from gz_course.grader.process.command_line import blot_out
    from gz_course.grader.run.sandbox import AUTO, OFFICIAL
    from gz_course.grader.whole_class.attempts import UNGRADED
    from gz_course.grader.whole_class.class_run import ClassRun
    from gz_course.grader.whole_class.found import find_submissions
    from gz_course.grader.whole_class.kept import KEEP
    from gz_course.grader.whole_class.platforms import GITHUB

    blot_out()
    if keep not in KEEP:
        near = did_you_mean(keep, KEEP)
        raise UsageError(f"--keep {shown(keep, 40)}: expected {', '.join(KEEP[:-1])} or {KEEP[-1]}{near}")
    if jobs is not None and dask is not None:
        raise UsageError("--jobs is for this machine and --dask for Dask's workers; give one of them")
    if demand is None and sandbox == AUTO:
        demand = OFFICIAL
    chosen = find_exercise(exercise)
    _check_places(submissions, out)
    people = read_login_map(map_file) if map_file is not None else None
    console = GuardedConsole(stderr=True)
    run = ClassRun(chosen, out, seed, trials, tuple(reports), sandbox, demand, keep)
    with ExitStack() as stack:
        found, left_out = find_submissions(submissions, chosen, stack, people)
        run.submitted = _said_by_others(times_in(submissions, stack))
        if left_out:
            console.print(f"left out, because they are no submissions: {', '.join(left_out)}", markup=False)
        if people and (unknown := [each.entry for each in found if each.platform != GITHUB]):
            console.print(f"not in the map: {shown(', '.join(unknown))}", markup=False, highlight=False)
        if plan:
            _print_plan(run, found, jobs, dask, GuardedConsole())
            raise typer.Exit(0)
        results = _graded(run, found, jobs, dask, console)
        if explain:
            _explain(run, found, results, console)
    failed = [result for result in results if result["outcome"] == "infra" or result.get(UNGRADED)]
    _print_summary(results, failed, chosen.max_score, out)
    raise typer.Exit(3 if failed else 0)


def _print_plan(run: ClassRun, found: list[Found], jobs: int | None, dask: str | None, console: Console) -> None:
    at_once = run.level_and_jobs(jobs)[1] if dask is None else None
    for line in run.plan(found, at_once).lines():
        console.print(line, markup=False, highlight=False, soft_wrap=True)


def _check_places(submissions: Path, out: Path) -> None:
    """Raise UsageError if `out` lies among the submissions: a second run would grade the reports of the first."""
    if not submissions.exists():
        raise UsageError(f"there is no {submissions}; give a folder or a zip with the submissions")
    source, target = submissions.resolve(), out.resolve()
    if target == source or target.is_relative_to(source):
        raise UsageError(f"--out {out} lies among the submissions in {submissions}; give a folder elsewhere")


def _graded(
    run: ClassRun, found: list[Found], jobs: int | None, dask: str | None, console: Console
) -> list[dict[str, Any]]:
    """Run the class with a progress bar in a terminal, elsewhere with a line for each student."""
    import sys
    import time

    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    from gz_course.grader.whole_class.plan import readable_time

    _print_plan(run, found, jobs, dask, console)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    progress = Progress(*columns, console=console, disable=not console.is_terminal)
    bar = progress.add_task("starting", total=len(found))
    count = new = 0
    began = time.monotonic()

    def told(result: dict[str, Any], anew: bool) -> None:
        nonlocal count, new
        count, new = count + 1, new + anew
        progress.update(bar, advance=1, description=_cut(result["student"]))
        line = f"{count}/{len(found)}  {_line(result, run.exercise.max_score)}{'' if anew else '  (done before)'}"
        if not console.is_terminal:
            print(line, file=sys.stderr, flush=anew)  # ten thousand lines of an earlier run: rich would take seconds
        elif result["outcome"] == "infra":
            console.print(line, markup=False, highlight=False, soft_wrap=True)
        if anew and new == ESTIMATED_AFTER < len(found) - count:
            left = readable_time((time.monotonic() - began) / new * (len(found) - count))
            console.print(f"about {left} for the other {len(found) - count}", markup=False, highlight=False)

    try:
        with progress:
            return run.grade(found, told, jobs=jobs, dask=dask)
    except (KeyboardInterrupt, SystemExit) as end:
        console.print(f"stopped: {count} of {len(found)} are done; the same command goes on from there")
        if isinstance(end, SystemExit):
            raise
        raise typer.Exit(Interrupted.exit_code) from None


def _said_by_others(when: Callable[[Found], Submitted | None]) -> Callable[[Found], str | None]:
    """Return what tells the ISO time of a submission; the time of a file is that of its last copy, and says nothing."""

    def told(found: Found) -> str | None:
        submitted = when(found)
        return submitted.time.isoformat() if submitted is not None and submitted.said_by != "file" else None

    return told


def _explain(run: ClassRun, found: list[Found], results: list[dict[str, Any]], console: Console) -> None:
    """Search what would help each student, on this machine, and group them on the page."""
    from gz_course.grader.whole_class.explained import explain_class
    from gz_course.grader.whole_class.index import write_index

    def told(student: str, sentence: str) -> None:
        console.print(f"{shown(student, 40)}: {shown(sentence)}", markup=False, highlight=False, soft_wrap=True)

    try:
        explain_class(run.exercise, run.out, results, found, run.trials, run.level_and_jobs(None)[0], told)
    except KeyboardInterrupt:
        console.print("stopped: what was found is kept; the same command goes on from there")
        raise typer.Exit(Interrupted.exit_code) from None
    finally:
        write_index(run.out, run.exercise, results, run.reports)


def _line(result: dict[str, Any], most: float) -> str:
    points = "not graded" if result["score"] is None else f"{result['score']:g}/{most:g}"
    outcome = "" if result["outcome"] == "graded" else f"  ({result['outcome']})"
    why = f"  {result['diagnosis']}" if result["outcome"] in ("infra", "protocol") else ""
    notes = "".join(f"  {each}" for each in result.get("notes", ()))
    return f"{result['student']}  {points}{outcome}{why}{notes}"


def _cut(student: str) -> str:
    return escape(student if len(student) <= 30 else f"{student[:29]}…")


def _print_summary(results: list[dict[str, Any]], failed: list[dict[str, Any]], most: float, out: Path) -> None:
    from statistics import fmean, median

    from gz_course.grader.whole_class.gradebook import GRADEBOOK
    from gz_course.grader.whole_class.index import INDEX
    from gz_course.grader.whole_class.kept import readable_size, recordings_on_disk

    console = GuardedConsole()
    scores = sorted(result["score"] for result in results if result["score"] is not None)
    outcomes = Counter(result["outcome"] for result in results)
    counted = ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items()))
    console.print(f"{len(results)} submissions: {counted}", markup=False, highlight=False)
    if scores:
        full = sum(score >= most for score in scores)
        text = f"full marks: {full}, median: {median(scores):g} of {most:g}, mean: {fmean(scores):.1f}"
        console.print(text, markup=False, highlight=False)
    for result in failed:
        text = f"not graded, and not the student's fault: {result['student']}: {result['diagnosis']}"
        console.print(text, markup=False, highlight=False, soft_wrap=True)
    if failed:
        console.print("The same command tries these again.", highlight=False)
    students, size = recordings_on_disk(out, results)
    if students:
        text = f"recordings: {students} students, {readable_size(size)} ({readable_size(size / students)} each)"
        console.print(text, markup=False, highlight=False)
    for name, file in (("gradebook", GRADEBOOK), ("page", INDEX)):
        console.print(f"{name}: {out / file}", markup=False, highlight=False, soft_wrap=True)
