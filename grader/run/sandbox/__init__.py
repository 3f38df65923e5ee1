"""The sandbox ("box") a submission runs in, at one of four levels; every report names the level.

`sandbox.py` is the sandbox as the grader uses it, `level.py` finds the best level a machine offers, `levels/` builds
each; `view.py` lists the files visible in a sandbox, `network.py` gives a grading a private network.
`grader/run/sandbox/init/` runs inside.
"""

from gz_course.grader.run.sandbox.environment import WHEEL_VARIABLES, ros_environment
from gz_course.grader.run.sandbox.level import AUTO, LEVELS, OFFICIAL, check_jobs, choose, level_module
from gz_course.grader.run.sandbox.sandbox import Sandbox, enter_early
from gz_course.grader.run.sandbox.spec import LIMITS

__all__ = [
    "AUTO",
    "LEVELS",
    "LIMITS",
    "OFFICIAL",
    "WHEEL_VARIABLES",
    "Sandbox",
    "check_jobs",
    "choose",
    "enter_early",
    "level_module",
    "ros_environment",
]
