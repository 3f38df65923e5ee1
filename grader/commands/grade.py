"""`course grade EXERCISE`: grade one submission and print its report."""

from __future__ import annotations

import errno
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from grader.errors import UsageError, nearest
from grader.exercise import find_exercise
from grader.trial import chosen_trials, numbered

if TYPE_CHECKING:
    from grader.report.report import Report

STARTED = time.monotonic()


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(name="grade")(grade_command)


def grade_command(
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
    out: Annotated[Path | None, typer.Option(help="Folder for the recordings. Default: runs/EXERCISE.")] = None,
    json: Annotated[Path | None, typer.Option(help="Write the report as JSON to this file.")] = None,
) -> None:
    """Grade one submission. Exit code 0: full marks, 1: less, 2: nothing to grade, 3: the grader's fault."""
    from rich.console import Console

    from grader.grade import PACES, grade, recording_path
    from grader.report.terminal import print_report

    if pace not in PACES:
        raise UsageError(f"there is no pace {pace!r}{nearest(pace, PACES)}")
    chosen = find_exercise(exercise)
    out = out or Path("runs") / chosen.name
    asked = numbered(chosen_trials(chosen, trials))
    for target in (json, *(recording_path(chosen, trial, out) for trial in asked)):
        if target is not None:
            check_writable(target)
    report = grade(chosen, submission, out, seed=seed, pace=pace, trials=asked, started=STARTED)
    print_report(report, Console())
    if json is not None:
        write_json(json, report)
    raise typer.Exit(0 if report.full_marks else 1)


def check_writable(path: Path) -> None:
    """Find out before anything runs whether a file can be written. Raises UsageError if not."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        existed = path.exists()
        with path.open("ab"):
            pass
        if not existed:
            path.unlink()
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}") from None


def write_json(path: Path, report: Report) -> None:
    """Write a report as JSON. Raises UsageError if the file cannot be written."""
    check_writable(path)
    path.write_text(report.as_json())
