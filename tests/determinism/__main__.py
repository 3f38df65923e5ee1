"""Grades each exercise's solution and each awkward right node many times: one score and one truth hash each.

    python -m gz_course.tests.determinism [GRADINGS] [NAME ...]

The nodes are the folders of `tests/grader/run/styles/`. Half of the gradings run beside busy processes. Prints a table
and ends with exit code 1 if a name has more than one score or more than one hash, or was not graded.
"""

import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.run.sandbox import choose, level_module

ROOT = Path(__file__).parents[2]
STYLES = ROOT / "tests/grader/run/styles"
GRADINGS, BUSY = 200, 8
# A grading that never ends is a fault, too; on a busy machine one may take minutes.
LONGEST = 3600.0  # [s]


@dataclass
class Row:
    """One submission and what its gradings came to."""

    name: str
    exercise: str
    folder: Path
    scores: Counter[str] = field(default_factory=Counter)
    hashes: Counter[str] = field(default_factory=Counter)
    seconds: dict[bool, list[float]] = field(default_factory=lambda: {False: [], True: []})
    faults: list[str] = field(default_factory=list)

    @property
    def same(self) -> bool:
        return len(self.scores) == len(self.hashes) == 1 and not self.faults

    def take(self, told: str | dict, busy: bool, seconds: float) -> None:
        """Take over a report, or the reason why there is none."""
        self.seconds[busy].append(seconds)
        if isinstance(told, str):
            self.faults.append(told)
            return
        self.scores[f"{told['score']:g}"] += 1
        self.hashes[" ".join(trial["truth_sha256"][:12] for trial in told["trials"])] += 1


def rows() -> list[Row]:
    """Return the solutions of all exercises, and the nodes of `styles/` under the exercise whose file they hold."""
    exercises: list[Exercise] = [find_exercise(name, ROOT) for name in exercise_names(ROOT)]
    found = [Row(f"solution of {each.name}", each.name, each.twin) for each in exercises]
    for folder in sorted(path for path in STYLES.iterdir() if path.is_dir()):
        of = next(each for each in exercises if (folder / each.file).is_file())
        found.append(Row(f"{folder.name} ({of.name})", of.name, folder))
    return found


def graded(row: Row, level: str) -> tuple[str | dict, float]:
    """Grade once, as a program of its own; return the report or why there is none, and the wall time [s]."""
    with tempfile.TemporaryDirectory(prefix="determinism-") as place:
        report = Path(place, "report.json")
        # Of a solution's folder the file alone: its variants have files of the same name.
        file = row.folder / find_exercise(row.exercise, ROOT).file
        submission = row.folder if row.folder.is_relative_to(STYLES) else file
        command = [sys.executable, "-m", "gz_course.grader.course", "grade", row.exercise]
        command += [
            "--submission",
            str(submission),
            "--out",
            str(Path(place, "out")),
            "--json",
            str(report),
            "--no-page",
        ]
        began = time.monotonic()
        done = subprocess.run(
            [*command, "--sandbox", level], cwd=ROOT, capture_output=True, text=True, timeout=LONGEST, check=False
        )
        seconds = time.monotonic() - began
        if done.returncode not in (0, 1):
            return f"exit code {done.returncode}: {done.stderr.strip()[-300:]}", seconds
        return json.loads(report.read_text()), seconds


@contextlib.contextmanager
def busy_machine(count: int) -> Iterator[None]:
    """Keep processors busy with processes that only count."""
    running = [subprocess.Popen([sys.executable, "-I", "-S", "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for each in running:
            each.kill()
        for each in running:
            each.wait()


def grade_all(found: list[Row], gradings: int, busy: bool, level: str, jobs: int) -> None:
    todo = [row for _ in range(gradings) for row in found]
    with ThreadPoolExecutor(jobs) as pool:
        for row, (told, seconds) in zip(todo, pool.map(lambda row: graded(row, level), todo), strict=True):
            row.take(told, busy, seconds)


def print_table(found: list[Row]) -> None:
    width = max(len(row.name) for row in found)
    print(f"{'name':<{width}}  gradings  scores      hashes  quiet [s]  busy [s]")
    for row in found:
        quiet, busy = (f"{median(values):.1f}" if values else "-" for values in row.seconds.values())
        scores = ", ".join(f"{score} x{count}" if len(row.scores) > 1 else score for score, count in row.scores.items())
        gradings = sum(map(len, row.seconds.values()))
        told = "" if row.same else "  NOT THE SAME"
        print(f"{row.name:<{width}}  {gradings:<8}  {scores:<10}  {len(row.hashes):<6}  {quiet:<9}  {busy}{told}")
    for row in found:
        for fault, count in Counter(row.faults).items():
            print(f"{row.name}: {count} times not graded: {fault}")


def main() -> int:
    """Grade, print the table, return the exit code."""
    arguments = sys.argv[1:]
    gradings = int(arguments.pop(0)) if arguments and arguments[0].isdecimal() else GRADINGS
    found = [row for row in rows() if not arguments or any(name in row.name for name in arguments)]
    level = choose()
    jobs = len(os.sched_getaffinity(0)) if level_module(level).PRIVATE_NETWORK else 1
    print(f"{len(found)} submissions, {gradings} gradings each, {jobs} at a time at level {level}", flush=True)
    grade_all(found, gradings - gradings // 2, False, level, jobs)
    with busy_machine(BUSY):
        grade_all(found, gradings // 2, True, level, jobs)
    print_table(found)
    return 0 if all(row.same for row in found) else 1


if __name__ == "__main__":
    sys.exit(main())
