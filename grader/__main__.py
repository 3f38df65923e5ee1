"""The command `course`, on any machine: one that the course does not run on gets one sentence.

Nothing else may be imported before: its dependencies may not be installed.
"""

import sys

from gz_course.sim.machine import require


def main() -> None:
    """Run `course`."""
    require("course")
    from gz_course.grader.warm.client import run, wants_helper

    arguments = sys.argv[1:]
    if wants_helper(arguments):
        run(arguments, _course)
    else:
        _course()


def _course() -> None:
    from gz_course.grader.course import main as course

    course()


if __name__ == "__main__":
    main()
