"""What a class of ten thousand costs beside its gradings, in processor time: to go on after a kill, and to compare.

The reference reads the same submissions and the same journal with nothing but Python's own functions.
"""

import hashlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row
from gz_course.tests.filled_class import fill
from gz_course.tests.generated_class import hand_in

COURSE = Path(sys.executable).parent / "course"
STUDENTS, FEW = 10_000, 1_000
READING = 2.0  # [s] of processor time, in which a class that is done is read again and its gradebook written
MEMORY = Path("/dev/shm")  # so that no disk is measured, where there is one


def spent(work: Callable[[], object]) -> float:
    """Processor time [s] of some work and of the processes it waits for."""
    before = os.times()
    work()
    return sum(os.times()[:4]) - sum(before[:4])


def course(*words: object) -> None:
    subprocess.run([COURSE, *map(str, words)], check=True, capture_output=True)


def read_plainly(submissions: Path, out: Path) -> None:
    for folder in sorted(submissions.iterdir()):
        for file in sorted(folder.iterdir()):
            hashlib.sha256(file.read_bytes()).hexdigest()
    for line in (out / "journal.jsonl").read_bytes().splitlines():
        (out / json.loads(line)["result"]["folder"] / "report.json").stat()


def rows() -> Iterator[Row]:
    with tempfile.TemporaryDirectory(prefix="bench-large-", dir=MEMORY if MEMORY.is_dir() else None) as name:
        folder = Path(name)
        classes = {
            count: (hand_in(folder / f"class{count}", count), folder / f"out{count}") for count in (STUDENTS, FEW)
        }
        for submissions, out in classes.values():
            fill(submissions, out)
        all_of_them, out = classes[STUDENTS]
        plain = min(spent(lambda: read_plainly(all_of_them, out)) for _ in range(2))
        again = min(spent(lambda: fill(all_of_them, out)) for _ in range(2))
        told = f"read plainly: {plain:.2f} s"
        yield Row(
            f"{STUDENTS} done, gone on with",
            f"{again:.2f} s",
            told,
            f"{again / READING:.2f}x of {READING:g} s",
            "<= 1x",
        )
        size = (out / "index.html").stat().st_size
        yield Row(f"page of {STUDENTS}", f"{size / 1e6:.1f} MB", "a photo: 5 MB", f"{size / 5e6:.2f}x", "< 1x")
        took = {
            count: spent(lambda place=place: course("similar", "03", place, "--out", folder / "similar"))
            for count, (place, _) in classes.items()
        }
        growth = took[STUDENTS] / took[FEW]
        told = f"{FEW}: {took[FEW]:.2f} s"
        yield Row(f"{STUDENTS} compared", f"{took[STUDENTS]:.2f} s", told, f"{growth:.1f}x", "<= 10x")


if __name__ == "__main__":
    for row in rows():
        print(row)
