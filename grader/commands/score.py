"""`course score RECORDING...`: compute the score again from the recording alone.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.report.format import with_report_files


@with_report_files
def command(
    recordings: Annotated[
        list[Path], typer.Argument(metavar="RECORDING...", help="The .rrd files a grading wrote, or their folder.")
    ],
    *,
    reports: dict[str, Path],
) -> None:
    """Score recordings again; nothing is run. Exit codes as for `course grade`."""
    from gz_course.grader.grade import grade_again, recordings_in
    from gz_course.grader.report.outputs import Outputs
    from gz_course.grader.report.terminal import print_report

    outputs = Outputs(reports)
    outputs.check(inputs=[path for given in recordings for path in recordings_in(given)])
    report = grade_again(recordings)
    try:
        print_report(report)
    finally:  # also if the terminal has been closed
        outputs.write(report)
    raise typer.Exit(0 if report.full_marks else 1)
