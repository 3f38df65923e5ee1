"""`course grade EXERCISE`: grade one submission and print its report."""

from __future__ import annotations

import importlib
import time
from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.trial import chosen_trials, numbered
from gz_course.grader.report.format import with_report_files
from gz_course.sim.did_you_mean import did_you_mean

STARTED = time.monotonic()


@with_report_files
def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    submission: Annotated[
        Path | None,
        typer.Option(help="File to grade, or a folder with it. Default: your copy in exercises/."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Seed of sensor noise and of the grader's own commands.")] = 0,
    pace: Annotated[
        str,
        typer.Option(help="lockstep (as fast as it goes, always the same) or realtime (paced to the wall clock)."),
    ] = "lockstep",
    trials: Annotated[
        str,
        typer.Option(
            help="public (those of the exercise), hidden (those of its solution's trials.toml), all, or a file."
        ),
    ] = "public",
    sandbox: Annotated[
        str,
        typer.Option(help="Sandbox level: auto (the best that works here), A, B, C or D."),
    ] = "auto",
    demand: Annotated[
        str | None, typer.Option(help="Refuse to grade in a sandbox below this level, such as B for official grading.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder for recordings and page. Default: runs/EXERCISE in the course's folder, and best.json."
        ),
    ] = None,
    page: Annotated[
        bool, typer.Option("--page/--no-page", help="Write the HTML page beside the recording, unless --html names it.")
    ] = True,
    explained: Annotated[
        bool, typer.Option("--explained/--points-only", hidden=True, help="Read the files for likely mistakes.")
    ] = True,
    details: Annotated[
        bool, typer.Option("--details", help="Print what each check expected and measured; the page has it, too.")
    ] = False,
    explain: Annotated[
        bool, typer.Option("--explain", help="Also try which line decides, as `course explain` does.")
    ] = False,
    no_helper: Annotated[
        bool,
        typer.Option(
            "--no-helper",
            help="In a terminal, a process with all imports done is kept for ten minutes, so that the next grading "
            "begins at once. With this option none is used or kept.",
        ),
    ] = False,
    *,
    reports: dict[str, Path],
) -> None:
    """Grade one submission. Exit code 0: full marks, 1: less, 2: nothing to grade, 3: the grader's fault."""
    from gz_course.grader.process.command_line import blot_out
    from gz_course.grader.process.many_imports import many_imports
    from gz_course.grader.run.sandbox import choose, enter_early

    blot_out()
    level = choose(sandbox, demand)
    enter_early(level)  # before any thread exists

    with many_imports():
        from gz_course.grader.grade import PACES, grade, recording_path
        from gz_course.grader.report.best import BEST, keep_best, runs_folder
        from gz_course.grader.report.outputs import Outputs, check_writable

    def meanwhile() -> None:
        """Import what shows the report, and make it ready, while the submission runs."""
        with many_imports():
            importlib.import_module("gz_course.grader.report.terminal")
            importlib.import_module("pyarrow")  # which the recording needs that comes from there
            outputs.prepare()

    if pace not in PACES:
        raise UsageError(f"there is no pace {pace!r}{did_you_mean(pace, PACES, listing='known')}")
    chosen = find_exercise(exercise)
    own = out is None  # best.json is kept only in the default folder
    out = out or runs_folder() / chosen.name
    asked = numbered(chosen_trials(chosen, trials))
    beside = out / f"{chosen.name}.html" if page and "html" not in reports else None
    outputs = Outputs(reports | ({"html": beside} if beside else {}))
    graded = submission or chosen.starter
    outputs.check(
        [recording_path(chosen, trial, out) for trial in asked], [graded, *(graded / name for name in chosen.parts)]
    )
    if own:
        check_writable(out / BEST)
    report = grade(
        chosen,
        submission,
        out,
        seed=seed,
        pace=pace,
        trials=asked,
        sandbox=level,
        explained=explained,
        started=STARTED,
        meanwhile=meanwhile,
    )

    if explain and not report.full_marks and report.measured and not report.untouched:
        from gz_course.grader.explain.progress import explained as searched
        from gz_course.grader.explain.tried import with_trial

        report = with_trial(report, searched(chosen, submission, sandbox=level))

    from gz_course.grader.report.terminal import print_report

    try:
        print_report(report, page=beside, details=details)
    finally:  # also if the terminal has been closed
        outputs.write(report)
        if own:
            keep_best(report, out)
    raise typer.Exit(0 if report.full_marks else 1)
