"""Whether a submission of several processes gets the same grade whenever it is graded.

The launch file of 02_launch is in `bench_determinism_of_grades`; here two nodes of one submission drive the robot
together, which would be a race without the grader's order.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row

ROOT = Path(__file__).parents[2]
COURSE = Path(sys.executable).parent / "course"
SUBMISSION = ROOT / "tests" / "grader" / "cases" / "two_processes"
GRADINGS = int(os.environ.get("GRADINGS", "20"))
BUSY = 4


def rows() -> Iterator[Row]:
    results, walls = set(), {}
    with tempfile.TemporaryDirectory() as folder:
        for count in (0, BUSY):
            busy = [subprocess.Popen([sys.executable, "-S", "-c", "while True: pass"]) for _ in range(count)]
            try:
                start = time.monotonic()
                results |= {grade(Path(folder)) for _ in range(GRADINGS // 2)}
                walls[count] = (time.monotonic() - start) / (GRADINGS // 2)
            finally:
                for process in busy:
                    process.kill()
                    process.wait()
    yield Row(
        f"{GRADINGS} gradings of a submission of two processes, half of them beside {BUSY} busy ones",
        f"{len(results)} result{'s' if len(results) > 1 else ''}: {sorted(results)[0][:3]}",
        f"{walls[0]:.1f} s alone, {walls[BUSY]:.1f} s beside",
        f"{walls[BUSY] / walls[0]:.1f} x slower",
        "1 result, lockstep",
    )


def grade(out: Path) -> tuple[str, str, str]:
    """Return what must always be the same: score, pace, hash of the truth."""
    command = [COURSE, "grade", "03_teleop", "--submission", SUBMISSION, "--out", out, "--json", out / "report.json"]
    done = subprocess.run([*map(str, command)], cwd=ROOT, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return "no grade", done.stderr.strip()[-200:], ""
    found = json.loads((out / "report.json").read_text())
    return str(found["score"]), found["pace"], found["truth_sha256"]
