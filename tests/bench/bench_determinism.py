"""Whether a world gives the same bytes on every topic in every process, alone and beside busy ones."""

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row

PROGRAM = Path(__file__).parents[1] / "sim" / "gz" / "sim" / "world_digest.py"
RUNS = 4


def run() -> tuple[float, str]:
    """Run the program once; return its wall time [s] and what it prints."""
    start = time.monotonic()
    done = subprocess.run([sys.executable, PROGRAM, "7"], check=True, capture_output=True, text=True)
    return time.monotonic() - start, done.stdout


def rows() -> Iterator[Row]:
    alone = [run() for _ in range(RUNS)]
    for count in (1, 8):
        busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
        try:
            beside = [run() for _ in range(RUNS)]
        finally:
            for process in busy:
                process.kill()
                process.wait()
        results = {text for _, text in alone + beside}
        quick, slow = (min(wall for wall, _ in part) for part in (alone, beside))
        yield Row(
            f"{2 * RUNS} runs of one world, half of them beside {count} busy process{'es' if count > 1 else ''}",
            f"{len(results)} result over {len(json.loads(alone[0][1]))} topics",
            f"{quick:.1f} s alone, {slow:.1f} s beside",
            f"{slow / quick:.1f} x slower",
            "1 result",
        )
