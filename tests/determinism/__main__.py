"""Grades each exercise's solution and each awkward right node many times: one score and one truth hash each.

    python -m gz_course.tests.determinism [GRADINGS] [NAME ...]

The nodes are the folders of `tests/grader/run/styles/`. Every second round of gradings runs beside busy processes. The
table is printed after each round; exit code 1 says that a name has more than one score or more than one hash, or was
not graded. Each grading is noted in a file below `build/determinism/`; a second call with the same code goes on where
the first one ended.
"""

import contextlib
import hashlib
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
from typing import Any

from gz_course.grader.exercise import Exercise, exercise_names, find_exercise
from gz_course.grader.run.sandbox import choose, level_module

ROOT = Path(__file__).parents[2]
STYLES = ROOT / "tests/grader/run/styles"
DECIDES = ("grader", "sim", "exercises", "solutions", "tests/grader/run/styles")  # what a score depends on
NOTED = ROOT / "build/determinism"
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

    def take(self, noted: dict[str, Any]) -> None:
        """Take over what was noted of a grading (`graded`)."""
        self.seconds[noted["busy"]].append(noted["seconds"])
        if "fault" in noted:
            self.faults.append(noted["fault"])
            return
        self.scores[f"{noted['score']:g}"] += 1
        self.hashes[noted["hash"]] += 1


def rows() -> list[Row]:
    """Return the solutions of all exercises, and the nodes of `styles/` under the exercise whose file they hold."""
    exercises: list[Exercise] = [find_exercise(name, ROOT) for name in exercise_names(ROOT)]
    found = [Row(f"solution of {each.name}", each.name, each.twin) for each in exercises]
    for folder in sorted(path for path in STYLES.iterdir() if path.is_dir()):
        of = next(each for each in exercises if (folder / each.file).is_file())
        found.append(Row(f"{folder.name} ({of.name})", of.name, folder))
    return found


def graded(row: Row, level: str, busy: bool) -> dict[str, Any]:
    """Grade once, as a program of its own; return what is noted of it: score and hash, or why there are none."""
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
        noted = {"name": row.name, "busy": busy, "seconds": round(time.monotonic() - began, 2)}
        if done.returncode not in (0, 1):
            return noted | {"fault": f"exit code {done.returncode}: {done.stderr.strip()[-300:]}"}
        told = json.loads(report.read_text())
        lost = [check["id"] for check in told["checks"] if check["points"] < check["max_points"]]
        return noted | {
            "score": told["score"],
            "hash": " ".join(trial["truth_sha256"][:12] for trial in told["trials"]),
            "outcome": told["outcome"],
            "lost": lost,
            "pace": told["pace"],
        }


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


def note_file(level: str) -> Path:
    """Return the file in which the gradings of this code are noted."""
    code = hashlib.sha256()
    for path in sorted(each for part in DECIDES for each in (ROOT / part).rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            code.update(f"{path.relative_to(ROOT)} {path.stat().st_size}\n".encode() + path.read_bytes())
    return NOTED / f"{level}-{code.hexdigest()[:12]}.jsonl"


def take_noted(found: list[Row], file: Path) -> int:
    """Take over the gradings of an earlier call; return how many."""
    by_name, lines = {row.name: row for row in found}, file.read_bytes().splitlines() if file.exists() else []
    count = 0
    for line in lines:
        with contextlib.suppress(ValueError):  # the last one was not written to its end
            noted = json.loads(line)
            if row := by_name.get(noted["name"]):
                row.take(noted)
                count += 1
    return count


def grade_round(todo: list[Row], busy: bool, level: str, jobs: int, file: Path) -> None:
    """Grade each once, and note it."""
    with ThreadPoolExecutor(jobs) as pool, file.open("a") as notes:
        try:
            for row, noted in zip(todo, pool.map(lambda row: graded(row, level, busy), todo), strict=True):
                row.take(noted)
                print(json.dumps(noted), file=notes, flush=True)
        finally:
            pool.shutdown(cancel_futures=True)


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
    file = note_file(level)
    file.parent.mkdir(parents=True, exist_ok=True)
    before = take_noted(found, file)
    print(f"{len(found)} submissions, {gradings} gradings each, {jobs} at a time at level {level}")
    print(f"noted in {file.relative_to(ROOT)}" + (f", which holds {before}" if before else ""), flush=True)
    for number in range(1, gradings + 1):
        busy = number % 2 == 0
        wanted = number // 2 if busy else (number + 1) // 2
        if todo := [row for row in found if len(row.seconds[busy]) < wanted]:
            with busy_machine(BUSY if busy else 0):
                grade_round(todo, busy, level, jobs, file)
            print(f"\nafter {number} of {gradings} gradings")
            print_table(found)
            sys.stdout.flush()
    if before and not todo:
        print_table(found)
    return 0 if all(row.same for row in found) else 1


if __name__ == "__main__":
    sys.exit(main())
