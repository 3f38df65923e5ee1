"""The program of one grading in a class: `course`, which ends when the process that started it has ended.

`grading.py` starts it as `python -m grader.whole_class.start PARENT grade ...`; PARENT is the starter's process id.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys

PR_SET_PDEATHSIG = 1


def main() -> None:
    """Request SIGTERM at the parent's end, exit if it has ended already, then run `course`."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)  # `course` closes everything on SIGTERM
    if os.getppid() != int(sys.argv.pop(1)):
        sys.exit(3)
    from gz_course.grader.course import main as course

    course()


if __name__ == "__main__":
    main()
