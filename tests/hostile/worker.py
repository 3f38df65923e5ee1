"""Grades one submission after the other in one process, as a worker of a whole class does.

Started as a program with the level of the sandbox. Reads the folder of a submission and one for recordings on each line
of its input, answers each with a line of JSON, and ends with its input.
"""

import json
import os
import sys
import time
from pathlib import Path

from gz_course.grader.run.sandbox import enter_early

LEVEL = sys.argv[1]
enter_early(LEVEL)

from gz_course.grader.exercise import find_exercise  # noqa: E402
from gz_course.grader.grade import grade  # noqa: E402
from gz_course.grader.record.reading import Recording  # noqa: E402
from gz_course.grader.run.sandbox.resource_monitor import descendants  # noqa: E402

EXERCISE = find_exercise("03_teleop")


def graded(submission, out):
    began = time.monotonic()
    report = grade(EXERCISE, Path(submission), Path(out), sandbox=LEVEL)
    seconds = time.monotonic() - began
    recording = Recording(report.recording)
    return {
        "report": report.as_dict(),
        "seconds": seconds,
        "log": [line.text for line in recording.lines("log/student")],
        "children": descendants(os.getpid()),
        "descriptors": len(list(Path("/proc/self/fd").iterdir())),
        "network": str(Path("/proc/thread-self/ns/net").readlink()),
        "mounts": Path("/proc/self/mountinfo").read_text(),
    }


for line in sys.stdin:
    submission, out = json.loads(line)
    print("\n" + json.dumps(graded(submission, out)), flush=True)
