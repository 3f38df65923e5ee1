"""A class whose results are invented, for what cannot be graded for real in a test: the gradebook of ten thousand.

    python -m gz_course.tests.filled_class SUBMISSIONS OUT [STUDENTS_LEFT]

`course grade-all 03_teleop SUBMISSIONS --out OUT` finds them done. They are written by the functions that write real
results; each report says `invented`, and so do the diagnoses.
"""

import json
import random
import sys
from concurrent.futures import Executor, Future
from contextlib import ExitStack
from pathlib import Path

from gz_course.grader.exercise import Exercise, find_exercise
from gz_course.grader.whole_class.class_run import ClassRun
from gz_course.grader.whole_class.found import find_submissions
from gz_course.grader.whole_class.grading import Graded, Job, Setup

INVENTED = "invented by a test: "
TOLD = ("", "the robot turns right", "the robot never stops", "nothing was published on /cmd_vel")


class Inventor(Executor):
    """Stands for the threads in which submissions are graded; answers at once."""

    def __init__(self, exercise: Exercise) -> None:
        self.exercise = exercise

    def submit(self, _, setup: Setup, job: Job, /, *args, **kwargs) -> Future[Graded]:
        chance = random.Random(job.key)
        share = chance.choice((0, 0.25, 0.5, 1, 1, 1))
        checks = [{"id": each.id, "points": each.points * share} for each in self.exercise.checks]
        report = {
            "exercise": self.exercise.name,
            "submission": job.source,
            "score": sum(each["points"] for each in checks),
            "max_score": self.exercise.max_score,
            "outcome": "graded" if share else chance.choice(("graded", "student_error", "timeout")),
            "diagnosis": INVENTED + chance.choice(TOLD[1:]) if share < 1 else "",
            "truth_sha256": job.key,
            "checks": checks,
            "recording": "03_teleop.rrd",
            "trials": [],
            "wall_seconds": 2.5,
            "invented": True,
        }
        future: Future[Graded] = Future()
        future.set_result(Graded(report, {"report.json": json.dumps(report).encode(), "03_teleop.rrd": b"invented"}))
        return future


def fill(submissions: Path, out: Path, left: int = 0, **options) -> ClassRun:
    """Write results for all submissions but the last `left`; `options` are those of `ClassRun`."""
    exercise = find_exercise("03_teleop")
    run = ClassRun(exercise, out, **({"demand": "B"} | options))
    run._here = lambda jobs, stack: (Inventor(exercise), lambda: 2, lambda: False)
    with ExitStack() as stack:
        found, _ = find_submissions(submissions, exercise, stack)
        run.grade(found[: len(found) - left], lambda *_: None)
    return run


if __name__ == "__main__":
    fill(Path(sys.argv[1]), Path(sys.argv[2]), *map(int, sys.argv[3:]))
