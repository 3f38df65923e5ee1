"""A class that is graded, with its own process and all that live as long as it."""

import contextlib
import csv
import os
import subprocess
import sys
from collections import Counter
from pathlib import Path

import psutil

from gz_course.tests.generated_class import hand_in
from gz_course.tests.soak.watched import FEWEST, Outcome, Watched, end, entries, left_behind, shared_names, watch

COURSE = Path(sys.executable).parent / "course"
PART = 0.5  # of the run's samples, from which a process counts as one that lasts


def run(folder: Path, students: int, jobs: int) -> Outcome:
    """Grade a generated class; return what the processes held that lived through most of it."""
    submissions, out = hand_in(folder / "class", students), folder / "out"
    temporary = folder / "tmp"
    before = shared_names()
    command = [str(COURSE), "grade-all", "03_teleop", str(submissions), "--out", str(out), "--jobs", str(jobs)]
    with (folder / "told").open("wb") as told:
        process = psutil.Popen(
            command, env=os.environ | {"TMPDIR": str(temporary)}, stdin=subprocess.DEVNULL, stdout=told, stderr=told,
            start_new_session=True,
        )  # fmt: skip
    most = 0

    def found() -> list[Watched]:
        nonlocal most
        most = max(most, entries(temporary))
        some = [Watched("course grade-all", process.pid)]
        with contextlib.suppress(psutil.Error):
            for child in process.children(recursive=True):
                some.append(Watched(" ".join(child.cmdline()[1:4])[:40] or child.name(), child.pid))
        return some

    try:
        everything = watch(found, lambda: process.poll() is not None)
    finally:
        stubborn = end([process])
    lasting = [each for each in everything if len(each.samples) >= max(FEWEST, PART * len(everything[0].samples))]
    wrong = [f"{name} had to be killed" for name in stubborn] + left_behind(everything, temporary, before)
    if process.returncode != 0:
        wrong.append(f"exit code {process.returncode}: {(folder / 'told').read_text()[-400:]}")
        return Outcome(lasting, [], wrong)
    with (out / "gradebook.csv").open(newline="", encoding="utf-8-sig") as stream:
        outcomes = Counter(row["outcome"] for row in csv.DictReader(stream))
    counted = ", ".join(f"{count} {name}" for name, count in sorted(outcomes.items()))
    return Outcome(lasting, [f"{counted}; at most {most} temporary files and folders while it ran"], wrong)
