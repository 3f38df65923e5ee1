"""The `course` command: finds its sub-commands, runs one, turns every error into one sentence and an exit code.

Exit codes: 0 full marks or done, 1 less than full marks, 2 a usage error or an unreadable submission, 3 our own fault.
"""

from __future__ import annotations

import importlib
import pkgutil
import sys

import typer

from grader import commands
from grader.errors import CourseError

app = typer.Typer(
    name="course",
    help="Learn how Gazebo and ROS 2 work together: run, grade and look at the exercises.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def main() -> None:
    """Run the `course` command."""
    for module in pkgutil.iter_modules(commands.__path__):
        importlib.import_module(f"{commands.__name__}.{module.name}").register(app)
    try:
        app()
    except CourseError as error:
        print(f"course: {error}", file=sys.stderr)
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        print("course: interrupted", file=sys.stderr)
        sys.exit(130)
    except Exception as error:
        # Ours, never the student's: one sentence, and how to see the rest.
        if "--debug" in sys.argv:
            raise
        print(f"course: internal error: {type(error).__name__}: {error}", file=sys.stderr)
        sys.exit(3)
