"""A search in the terminal: a bar that shows what is tried."""

from __future__ import annotations

from pathlib import Path

from rich.progress import BarColumn, Progress, TextColumn

from gz_course.grader.console import GuardedConsole
from gz_course.grader.exercise import Exercise
from gz_course.grader.explain import BUDGET
from gz_course.grader.explain.explanation import Explanation, explain
from gz_course.grader.report.best import runs_folder
from gz_course.grader.whole_class.grading import gradings_end_here

KEPT = "explained.json"  # in the exercise's folder of runs


def explained(
    exercise: Exercise, submission: Path | None, budget: float = BUDGET, sandbox: str = "auto"
) -> Explanation:
    """Search for what helps a submission, with a bar. Raises what `explain` raises."""
    columns = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed:.0f} of {task.total:.0f} s")
    with gradings_end_here(), Progress(*columns, console=GuardedConsole(), transient=True) as bar:
        row = bar.add_task("the program as it is", total=budget)

        def told(text: str, spent: float) -> None:
            bar.update(row, description=text, completed=min(spent, budget))

        return explain(exercise, submission, budget, sandbox, runs_folder() / exercise.name / KEPT, told)
