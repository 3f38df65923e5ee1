"""`course diff EXERCISE`: the differences between starter and solution.

For instructors.
"""

from __future__ import annotations

from typing import Annotated

import typer
from rich.text import Text

from gz_course.grader.console import GuardedConsole
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.solution_diff import solution_diff
from gz_course.grader.printable import shown


def command(
    exercise: Annotated[str, typer.Argument(help="Exercise, such as 03_teleop or 03.")],
) -> None:
    """Show the differences between starter and solution as a unified diff, coloured in a terminal."""
    chosen = find_exercise(exercise)
    lines = list(solution_diff(chosen))
    if not lines:
        print(f"The starter of {chosen.name} is its solution: nothing changes.")
        return
    console = GuardedConsole(soft_wrap=True, highlight=False)
    if not console.is_terminal:
        print("\n".join(lines))
        return
    for line in lines:
        console.print(Text(shown(line, len(line) + 1), style=style_of(line)))


def style_of(line: str) -> str:
    for start, style in (("---", "bold"), ("+++", "bold"), ("@@", "cyan"), ("+", "green"), ("-", "red")):
        if line.startswith(start):
            return style
    return ""
