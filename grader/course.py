"""The `course` command: finds its sub-commands, runs one, and turns every error into one sentence and an exit code.

Exit codes: 0 full marks or done, 1 less than full marks, 2 a usage error or an unreadable submission, 3 a fault of the
grader or the machine.
"""

from __future__ import annotations

import ast
import importlib
import signal
import sys
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperGroup

from gz_course.grader import commands
from gz_course.grader.errors import CourseError, Interrupted, UsageError
from gz_course.grader.process.interruption import end_on
from gz_course.grader.registry import module_names
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.error_text import named
from gz_course.sim.foreign_variables import set_aside
from gz_course.sim.terminal_text import guard

INSTRUCTORS = "For instructors"
SECTIONS = ("Commands", "For a running system", INSTRUCTORS)


class Commands(TyperGroup):
    """The sub-commands, a file of `commands/` each: `course grade-all` runs the function `command` of `grade_all.py`.

    A file is imported when its command is called; the list of commands reads their docstrings without importing them.
    A line of a module's docstring that is the title of one of `SECTIONS`, such as `For instructors.`, puts its command
    there; without one it stands in the first.
    """

    def list_commands(self, _: Any) -> list[str]:
        return [name.replace("_", "-") for name in module_names(commands)]

    def get_command(self, context: Any, name: str) -> Any:
        if name not in (known := self.list_commands(context)):
            raise UsageError(f"there is no command {name!r}; `course --help` shows them all{did_you_mean(name, known)}")
        app = typer.Typer(add_completion=False, rich_markup_mode=None)
        app.command(name)(importlib.import_module(f"{commands.__name__}.{name.replace('-', '_')}").command)
        return typer.main.get_command(app)

    def invoke(self, context: Any) -> Any:
        try:
            return super().invoke(context)
        except KeyboardInterrupt:  # Typer would end without a word
            raise Interrupted("interrupted") from None

    def format_commands(self, context: Any, formatter: Any) -> None:
        folder = Path(commands.__path__[0])
        told: dict[str, list[tuple[str, str]]] = {title: [] for title in SECTIONS}
        for name in self.list_commands(context):
            module = ast.parse((folder / f"{name.replace('-', '_')}.py").read_bytes())
            told[section(module)].append((name, summary(module)))
        for title, lines in told.items():
            with formatter.section(title):
                formatter.write_dl(lines)


def section(module: ast.Module) -> str:
    """Return the section that a line of the docstring of a file of `commands/` names, or the first."""
    lines = (ast.get_docstring(module) or "").splitlines()
    return next((title for title in SECTIONS if f"{title}." in lines), SECTIONS[0])


def summary(module: ast.Module) -> str:
    """Return the first paragraph of the docstring of the function `command` in a file."""
    for node in module.body:
        if isinstance(node, ast.FunctionDef) and node.name == "command":
            return " ".join((ast.get_docstring(node) or "").partition("\n\n")[0].split())
    return ""


def main() -> None:
    """Run the `course` command. With `--debug` before the sub-command, show the traceback of an internal error."""
    debug = "--debug" in sys.argv[1:2]
    if debug:
        del sys.argv[1]
    guard()
    end_on(signal.SIGTERM, signal.SIGHUP)
    if sys.argv[1:2] != ["doctor"]:  # which reports on them
        set_aside("course")
    text = "Learn how Gazebo and ROS 2 work together: run, grade and look at the exercises."
    try:
        Commands(name="course", help=text, no_args_is_help=True, rich_markup_mode=None)(prog_name="course")
    except CourseError as error:
        _say(str(error))
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        _say("interrupted")
        sys.exit(130)
    except Exception as error:  # a fault of the grader, never the student's
        if debug:
            raise
        _say(f"internal error: {named(error)}")
        sys.exit(3)


def _say(sentence: str) -> None:
    text = f"course: {sentence}".encode(sys.stderr.encoding or "utf-8", "replace")
    print(text.decode(sys.stderr.encoding or "utf-8"), file=sys.stderr)


if __name__ == "__main__":
    main()
