"""`course feedback GRADES --for moodle|canvas|zip|mail-merge --out FILE`: what students get back of a class.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.errors import UsageError

SHOWN = 20  # students that are listed on the terminal


def command(
    grades: Annotated[Path, typer.Argument(metavar="GRADES", help="The folder that course grade-all wrote.")],
    target: Annotated[str, typer.Option("--for", help="moodle, canvas, zip, or mail-merge.")],
    out: Annotated[Path, typer.Option(help="The file to write: a zip, or for mail-merge a CSV file.")],
    hidden: Annotated[
        str, typer.Option(help="What is told of trials that students do not see: summary, none or all.")
    ] = "summary",
    roster: Annotated[
        Path | None, typer.Option(help="Moodle's grading worksheet, or for mail-merge a list with email addresses.")
    ] = None,
) -> None:
    """Write the feedback for a class as its platform takes it. Exit code 1: some students are not in the file."""
    from gz_course.grader.learning_platforms.export import write_bytes
    from gz_course.grader.learning_platforms.feedback import TARGETS, make_feedback
    from gz_course.grader.learning_platforms.roster import read_roster
    from gz_course.grader.printable import shown
    from gz_course.grader.report.seen import HIDDEN
    from gz_course.sim.did_you_mean import did_you_mean

    for name, value, known in (("--for", target, TARGETS), ("--hidden", hidden, HIDDEN)):
        if value not in known:
            near = did_you_mean(value, known)
            raise UsageError(f"{name} {shown(value, 40)}: expected {', '.join(known[:-1])} or {known[-1]}{near}")
    people = read_roster(roster) if roster is not None else None
    given = {path.resolve() for path in (roster, grades / "gradebook.csv") if path is not None}
    if out.resolve() in given:
        raise UsageError(f"--out {out} would overwrite what is read; give another file")
    made = make_feedback(grades, target, hidden, people)
    write_bytes(out, made.data)
    print(f"{out}: {made.count} students. {made.advice}")
    for student, why in list(made.left_out.items())[:SHOWN]:
        print(f"not in it: {shown(student, 60)}: {shown(why)}")
    if len(made.left_out) > SHOWN:
        print(f"... and {len(made.left_out) - SHOWN} more")
    raise typer.Exit(1 if made.left_out else 0)
