"""What being locked in costs: how long a Python takes until it says a word, in a box of each level and without one."""

import statistics
import sys
import time
from collections.abc import Iterator

from gz_course.grader.run.sandbox import LEVELS, Sandbox, level_module
from gz_course.grader.run.sandbox.probe import try_level
from gz_course.tests.bench.row import Row

RUNS = 20
# Bare: what is measured is the box, not the libraries of the environment.
WORD = [sys.executable, "-I", "-S", "-c", "print(1)"]
DOMAIN = 101


def start(level: str) -> float:
    """Return how long a process takes in a new box of a level, from its start to its first word [s]."""
    sandbox = Sandbox(DOMAIN, level)
    try:
        begun = time.monotonic()
        boxed = sandbox.start(WORD, {})
        said = boxed.stdout.readline()
        seconds = time.monotonic() - begun
        assert (boxed.wait(30), said) == (0, b"1\n"), boxed.stderr.read()
        return seconds
    finally:
        for pipe in (boxed.stdout, boxed.stderr):
            pipe.close()
        sandbox.close()


def rows() -> Iterator[Row]:
    works = [level for level in LEVELS if level == "D" or not try_level(level)]
    taken: dict[str, list[float]] = {level: [] for level in works}
    for _ in range(RUNS):  # the levels take turns: what else the machine does falls on all
        for level in works:
            taken[level].append(start(level))
    outside = statistics.median(taken.pop("D"))
    for level, seconds in taken.items():
        inside = statistics.median(seconds)
        yield Row(
            f"sandbox level {level}: {level_module(level).ABOUT}",
            f"{(inside - outside) * 1e3:.1f} ms more",
            f"without a box: {outside * 1e3:.1f} ms",
            f"{inside / outside:.1f}",
            "at most 30 ms more",
        )
