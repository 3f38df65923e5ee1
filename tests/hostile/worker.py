"""Grades one submission after the other in one process, as a worker of a whole class does.

Started as a program with the level of the sandbox. Reads the folder of a submission, one for recordings and the name of
the exercise on each line of its input, answers each with a line of JSON, and ends with its input.
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


def graded(submission, out, exercise):
    began = time.monotonic()
    report = grade(find_exercise(exercise), Path(submission), Path(out), sandbox=LEVEL)
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
    print("\n" + json.dumps(graded(*json.loads(line))), flush=True)
