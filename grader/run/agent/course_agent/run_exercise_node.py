"""The only process of the sandbox beside the submission's: runs the exercise's own node.

Started as `python -P -m course_agent.run_exercise_node FILE FOLDER`. It builds the packages of interfaces in `FOLDER`,
which the submission has brought, and runs `FILE` as `run_node.py` runs a student's. A package is nothing but texts
here: the message classes are made from them. The exit code is `BUILD_FAILED` if one cannot be built.
"""

from __future__ import annotations

import ctypes
import sys
from pathlib import Path

from . import run_node
from .run_package import BUILD_FAILED, SIMULATED_TIME, built

PR_SET_DUMPABLE = 4


def main() -> None:
    """Keep everybody else out of this process, build, and run the file."""
    ctypes.CDLL(None).prctl(PR_SET_DUMPABLE, 0)  # also a process of the same user, where no sandbox divides them
    file, folder = sys.argv[1:]
    if built(Path(folder)):
        sys.exit(BUILD_FAILED)
    sys.argv = [sys.argv[0], file, *SIMULATED_TIME]
    run_node.main()


if __name__ == "__main__":
    main()
