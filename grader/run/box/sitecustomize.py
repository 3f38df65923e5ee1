"""Python imports this at every start in the box: it lets the grader follow each process that uses rclpy.

The sandbox puts this folder first on PYTHONPATH, so it works in every Python process, whoever started it. Without the
grader's socket in the environment it does nothing.
"""

import os

if os.environ.get("COURSE_SOCKET"):
    from course_box import hooks  # type: ignore[import-not-found, unused-ignore]

    hooks.install()
