"""The box a submission runs in, at one of four levels; the level stands in every report.

`sandbox.py` is the box as the grader uses it, `level.py` the best level a machine offers, `levels/` how each is built;
`view.py` says what a box shows, `network.py` gives a grading a network of its own. What happens inside is in
`grader/run/sandbox/init/`.
"""

from gz_course.grader.run.sandbox.environment import WHEEL_VARIABLES, ros_environment
from gz_course.grader.run.sandbox.level import AUTO, LEVELS, choose, level_module
from gz_course.grader.run.sandbox.sandbox import Sandbox, enter_early
from gz_course.grader.run.sandbox.spec import LIMITS

__all__ = [
    "AUTO",
    "LEVELS",
    "LIMITS",
    "WHEEL_VARIABLES",
    "Sandbox",
    "choose",
    "enter_early",
    "level_module",
    "ros_environment",
]
