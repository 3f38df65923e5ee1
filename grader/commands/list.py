"""`course list [EXERCISE]`: the exercises with the best score in each so far, or the rubric of one."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from gz_course.grader.console import GuardedConsole, print_wrong
from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise import CheckSpec, Exercise, course_root, exercise_names, find_exercise
from gz_course.grader.lessons.kept import Kept
from gz_course.grader.lessons.lesson import number_of_steps
from gz_course.grader.report.best import best_scores, runs_folder


def command(
    exercise: Annotated[str | None, typer.Argument(help="Show what this exercise asks for and its rubric.")] = None,
    runs: Annotated[
        Path | None,
        typer.Option(help="Folder whose reports (JSON) hold the best scores. Default: runs in the course's folder."),
    ] = None,
) -> None:
    """List the exercises with points, best score so far and the expected file, or show the rubric of one."""
    if runs is not None and not runs.is_dir():
        raise UsageError(
            f"there is no folder {runs} with runs; leave --runs out, or give one that `course grade` wrote"
        )
    root = course_root()
    names = exercise_names(root) if exercise is None else [exercise]
    exercises = [find_exercise(name, root) for name in names]
    best = best_scores(runs or runs_folder(), {each.name: each.max_score for each in exercises})
    told = {each.name: f"{best.scores[each.name]:g}" if each.name in best.scores else "-" for each in exercises}
    console = GuardedConsole()
    if exercise is not None:
        print_rubric(exercises[0], console, told[exercises[0].name])
    else:
        table = plain_table("exercise", "points", "best", "steps", "file", "title")
        begin = next((e.name for e in exercises if best.scores.get(e.name, 0.0) < e.max_score), "")
        for each in exercises:
            table.add_row(each.name, f"{each.max_score:g}", told[each.name], _steps(each, root), each.file, each.title)
        console.print(table)
        console.print(f"\nNext: {begin}" if begin else "\nEvery exercise has full marks.", highlight=False)
    if (root / "solutions").is_dir():  # a students' copy has no manifests to repair
        _refuse(_found_elsewhere(root, names))
    for name in sorted(best.stale - best.scores.keys()):
        console.print(f"\n{name} had other points when it was graded; grade it again.", highlight=False)


def _found_elsewhere(root: Path, names: list[str]) -> list[str]:
    """Return the mistakes in manifests, found by a process of its own: it loads what this command does without."""
    command = [sys.executable, "-P", "-m", "gz_course.grader.verify.manifest_faults", str(root), *names]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if done.returncode:
        return [f"the manifests cannot be examined: {(done.stderr.splitlines() or ['no reason'])[-1]}"]
    found: list[str] = json.loads(done.stdout)
    return found


def refuse_mistakes(exercises: list[Exercise]) -> None:
    """Print the mistakes in manifests, if there are any, and exit."""
    from gz_course.grader.verify.manifest_faults import manifest_faults

    _refuse([fault for each in exercises for fault in manifest_faults(each)])


def _refuse(faults: list[str]) -> None:
    if faults:
        print_wrong(faults)
        raise typer.Exit(ManifestError.exit_code)


def _steps(exercise: Exercise, root: Path) -> str:
    """Return how many of the cells to write of its chapter are done; nothing if it has none."""
    if not (count := number_of_steps(exercise.grading)):
        return ""
    done = Kept(root / "chapters" / exercise.name).steps()
    return f"{min(len(done), count)}/{count}"


def print_rubric(exercise: Exercise, console: Console, best: str) -> None:
    """Print what an exercise asks for, the best score so far and a line for each check in its manifest."""
    summary = "\n\n".join(" ".join(part.split()) for part in exercise.summary.split("\n\n"))
    console.print(f"[bold]{exercise.name}[/bold]  {escape(exercise.title)}\n\n{escape(summary)}\n")
    console.print(f"file: {escape(', '.join(exercise.parts))}", highlight=False)
    names = ", ".join(trial.name for trial in exercise.trials)
    console.print(f"trials: {names}; a check passes if it passes in each of them\n", highlight=False)
    table = plain_table("points", "check", "counts only if")
    for check in exercise.checks:
        table.add_row(f"{check.points:g}", escape(check.title), escape("; ".join(_gates(exercise, check))))
    table.add_section()
    table.add_row(f"{exercise.max_score:g}", "in all")
    console.print(table)
    console.print(f"\nbest score so far: {best}", highlight=False)


def _gates(exercise: Exercise, check: CheckSpec) -> list[str]:
    """Return the gates of a check in words; errors of the manifest are reported by scoring, not here."""
    titles = {each.id: each.title for each in exercise.checks}
    given = check.parameters.get("gate", [])
    gates = [gate for gate in (given if isinstance(given, list) else [given]) if isinstance(gate, dict)]
    words = []
    for gate in gates:
        if "check" in gate:
            words.append(f'"{titles.get(gate["check"], gate["check"])}" passes')
        elif "falls_to" in gate:
            words.append(f"{gate.get('signal')} falls to {gate['falls_to']}")
        else:
            words.append(f"{gate.get('signal')} reaches {gate.get('reaches')}")
    return words


def plain_table(*headings: str) -> Table:
    """Return a table without rules."""
    table = Table(show_edge=False, box=None, padding=(0, 2, 0, 0))
    for heading in headings:
        table.add_column(heading, overflow="fold")
    return table
