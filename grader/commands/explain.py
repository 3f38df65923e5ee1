"""`course explain EXERCISE`: the smallest change of a submission that would pass more, found by running it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.explain import BUDGET
from gz_course.grader.printable import shown

LONGEST = 1000  # [characters] of a sentence


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
    submission: Annotated[
        Path | None, typer.Option(help="File, folder or archive; your own copy if left out.", show_default=False)
    ] = None,
    budget: Annotated[float, typer.Option(min=1, help="Processor time [s] to spend on trials.")] = BUDGET,
    sandbox: Annotated[str, typer.Option(help="Sandbox level, as for `course grade`.")] = "auto",
) -> None:
    """Find out by trial which place of a program decides, and what kind of change it needs.

    Exit code 0: a change earns full marks (or nothing is to be done), 1: none was found, 2: nothing to grade.
    """
    from gz_course.grader.explain.progress import explained

    found = explained(find_exercise(exercise), submission, budget, sandbox)
    for line in found.sentences:
        print(shown(line, LONGEST))
    if found.interrupted:
        raise UsageError("interrupted; the outcomes are kept, and the next search begins with them")
    raise typer.Exit(0 if found.solved else 1)
