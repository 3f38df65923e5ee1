"""`course score RECORDING...`: the score again, from the recording alone."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command(name="score")(score_command)


def score_command(
    recordings: Annotated[
        list[Path], typer.Argument(metavar="RECORDING...", help="The .rrd files a grading wrote, or their folder.")
    ],
    json: Annotated[Path | None, typer.Option(help="Write the report as JSON to this file.")] = None,
) -> None:
    """Score recordings again; nothing is run. Exit codes as for `course grade`."""
    from rich.console import Console

    from grader.commands.grade import write_json
    from grader.grade import grade_again
    from grader.report.terminal import print_report

    report = grade_again(recordings)
    print_report(report, Console())
    if json is not None:
        write_json(json, report)
    raise typer.Exit(0 if report.full_marks else 1)
