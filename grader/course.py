"""The `course` command: finds its sub-commands, runs one, turns every error into one sentence and an exit code.

Exit codes: 0 full marks or done, 1 less than full marks, 2 a usage error or an unreadable submission, 3 our own fault.
"""

from __future__ import annotations

import importlib
import pkgutil
import signal
import sys

import typer

from gz_course.grader import commands
from gz_course.grader.errors import CourseError
from gz_course.grader.interruption import end_on

app = typer.Typer(
    name="course",
    help="Learn how Gazebo and ROS 2 work together: run, grade and look at the exercises.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def main() -> None:
    """Run the `course` command. With `--debug` before the sub-command an internal error shows where it is."""
    for module in pkgutil.iter_modules(commands.__path__):
        importlib.import_module(f"{commands.__name__}.{module.name}").register(app)
    debug = "--debug" in sys.argv[1:2]
    if debug:
        del sys.argv[1]
    end_on(signal.SIGTERM, signal.SIGHUP)
    try:
        app()
    except CourseError as error:
        _say(str(error))
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        _say("interrupted")
        sys.exit(130)
    except Exception as error:  # ours, never the student's
        if debug:
            raise
        _say(f"internal error: {type(error).__name__}: {error}")
        sys.exit(3)


def _say(sentence: str) -> None:
    text = f"course: {sentence}".encode(sys.stderr.encoding or "utf-8", "replace")
    print(text.decode(sys.stderr.encoding or "utf-8"), file=sys.stderr)


if __name__ == "__main__":
    main()
