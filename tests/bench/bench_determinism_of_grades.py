"""Whether a submission gets the same grade whenever it is graded: one score, one hash of the truth for each exercise.

`python -m tests.bench bench_determinism_of_grades` grades every solution some ten times, half of them beside busy
processes; GRADINGS=200 in the environment grades it so often.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row

ROOT = Path(__file__).parents[2]
COURSE = Path(sys.executable).parent / "course"
GRADINGS = int(os.environ.get("GRADINGS", "10"))
BUSY = 8


def grade(exercise: str, out: Path) -> tuple[float, tuple[object, ...]]:
    """Grade the solution in every trial there is; return the wall time [s] and what must always be the same."""
    report, start = out / "report.json", time.monotonic()
    command = [COURSE, "grade", exercise, "--submission", ROOT / "solutions" / exercise, "--trials", "all"]
    done = subprocess.run([*command, "--out", out, "--json", report], cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return time.monotonic() - start, ("no grade", done.stderr.strip()[-200:])
    found = json.loads(report.read_text())
    trials = tuple((trial["name"], trial["truth_sha256"]) for trial in found["trials"])
    return time.monotonic() - start, (found["score"], found["truth_sha256"], trials)


def rows() -> Iterator[Row]:
    for folder in sorted((ROOT / "exercises").glob("*/grading/exercise.toml")):
        yield row(folder.parent.name)


def row(exercise: str) -> Row:
    """Grade one exercise's solution again and again, alone and beside busy processes."""
    results: Counter[tuple[object, ...]] = Counter()
    walls: dict[str, list[float]] = {"alone": [], "beside": []}
    with tempfile.TemporaryDirectory() as folder:
        for name, wall in walls.items():
            beside = name == "beside"
            busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(BUSY if beside else 0)]
            try:
                for _ in range(GRADINGS // 2 if beside else GRADINGS - GRADINGS // 2):
                    seconds, result = grade(exercise, Path(folder))
                    wall.append(seconds)
                    results[result] += 1
            finally:
                for process in busy:
                    process.kill()
                    process.wait()
    scores = sorted({str(result[0]) for result in results})
    quick, slow = (min(wall, default=0.0) for wall in walls.values())
    return Row(
        f"{GRADINGS} gradings of the solution of {exercise}, half of them beside {BUSY} busy processes",
        f"score {', '.join(scores)}; {len(results)} result{'s' if len(results) > 1 else ''}",
        f"{quick:.1f} s alone, {slow:.1f} s beside",
        f"{slow / quick:.1f} x slower" if quick else "-",
        "100, 1 result",
    )
