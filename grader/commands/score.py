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
    html: Annotated[Path | None, typer.Option(help="Write the report as one HTML page, with plots.")] = None,
    gradescope: Annotated[Path | None, typer.Option(help="Write the report as Gradescope's results.json.")] = None,
    junit: Annotated[Path | None, typer.Option(help="Write the report as JUnit XML.")] = None,
) -> None:
    """Score recordings again; nothing is run. Exit codes as for `course grade`."""
    from gz_course.grader.grade import grade_again, recordings_in
    from gz_course.grader.report.outputs import Outputs
    from gz_course.grader.report.terminal import print_report

    outputs = Outputs(json, html, gradescope, junit)
    outputs.check(inputs=[path for given in recordings for path in recordings_in(given)])
    report = grade_again(recordings)
    try:
        print_report(report)
    finally:  # also for a terminal that has gone
        outputs.write(report)
    raise typer.Exit(0 if report.full_marks else 1)
