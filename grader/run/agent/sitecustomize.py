"""Start of the agent: Python imports this module at every start, so that the grader can follow processes with rclpy.

The sandbox puts this folder first on PYTHONPATH, so it works in every Python process, whoever started it. Without the
grader's socket in the environment it does nothing.
"""

import os

if os.environ.get("COURSE_SOCKET"):
    from course_agent import import_hooks  # type: ignore[import-not-found, unused-ignore]

    import_hooks.install()
