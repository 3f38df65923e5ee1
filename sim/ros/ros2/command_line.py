"""The `ros2` command: finds the command and its verb, reads their options and runs them.

`ros2 topic echo /scan` calls `main` of `command/topic/echo.py`, `ros2 run …` that of `command/run.py`. Such a file has
`add_arguments(parser)` and `main(arguments)`; the first line of its docstring is its help. Commands are found by
listing the folder; only the file of the command is imported.

Source: https://github.com/ros2/ros2cli (commands, options and printed words)
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.error_text import named
from gz_course.sim.foreign_variables import set_aside
from gz_course.sim.ros.prefix import local_setup
from gz_course.sim.ros.ros2 import completion, interruption
from gz_course.sim.ros.ros2.command_files import COMMANDS, found, load
from gz_course.sim.ros.ros2.errors import CommandError, UsageError
from gz_course.sim.ros.ros2.hand_over import hand_over
from gz_course.sim.terminal_text import guard, printable

_INTERRUPTED = 2
_GRAPH = "gz_course.sim.ros.ros2.graph"  # imported by verbs that have a node


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `ros2` with these arguments (default: those of the process); return the exit code.

    0 on success, 1 if the command failed, 2 for wrong usage or after SIGINT or SIGTERM.
    """
    is_program = arguments is None
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    if is_program and arguments[:1] != ["launch"]:  # which passes on what programs print, with their colours
        guard()
    local_setup.source(os.environ)
    code = hand_over(arguments)
    if code is not None:
        return code
    set_aside("ros2")
    if "_ARGCOMPLETE" in os.environ:
        completion.complete()
    code = _explained(arguments)
    if graph := sys.modules.get(_GRAPH):
        if is_program:
            interruption.ignore()
        graph.destroy_ended(code if is_program else None)
        if is_program:
            # What is left of DDS can block at exit, too.
            with contextlib.suppress(OSError, ValueError):
                sys.stdout.flush()
                sys.stderr.flush()
            os._exit(code)
    return code


def _explained(arguments: list[str]) -> int:
    """Run `ros2`; report every error as one sentence, and return the exit code."""
    # A shell's '&' starts programs with SIGINT ignored, but a node must announce its end. Both signals arrive as
    # KeyboardInterrupt.
    interruption.listen()
    try:
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
        return run(COMMANDS, "ros2", arguments)
    except CommandError as error:
        print(printable(str(error)), file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return _INTERRUPTED
    except BrokenPipeError:
        # `ros2 topic echo /scan | head`: the reader has closed the pipe.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        if interruption.received():  # pybind11 turns a KeyboardInterrupt into an error of a conversion
            return _INTERRUPTED
        if sys.flags.dev_mode:  # `python -X dev -m gz_course.sim.ros.ros2 …` shows the traceback
            raise
        print(f"ros2: internal error: {named(error)}", file=sys.stderr)
        return 1


def run(folder: Path, program: str, words: list[str]) -> int:
    """Run one of the commands in `folder`; `program` is what the user has typed so far."""
    known = found(folder)
    first = words[0] if words else "--help"
    if first not in known:  # the menu reads every file of the folder
        menu = _menu(folder, program, known)
        if first in ("-h", "--help"):
            menu.print_help()
            return 0
        if first.startswith("-"):
            menu.error(_unrecognized(menu, [first]))
        menu.error(f"invalid choice: {first!r} (choose from {', '.join(map(repr, known))}){did_you_mean(first, known)}")
    if known[first].is_dir():
        return run(known[first], f"{program} {first}", words[1:])
    module = load(known[first])
    parser = argparse.ArgumentParser(prog=f"{program} {first}", description=_summary(known[first]))
    module.add_arguments(parser)
    arguments, unknown = parser.parse_known_args(words[1:])
    if unknown:
        parser.error(_unrecognized(parser, unknown))
    try:
        return module.main(arguments) or 0
    except UsageError as error:
        parser.error(str(error))


def _unrecognized(parser: argparse.ArgumentParser, words: list[str]) -> str:
    options = [option for action in parser._actions for option in action.option_strings]
    hint = did_you_mean(words[0].partition("=")[0], options) if words[0].startswith("-") else ""
    return f"unrecognized arguments: {' '.join(words)}{hint}"


def _menu(folder: Path, program: str, known: dict[str, Path]) -> argparse.ArgumentParser:
    width = max(len(name) for name in known)
    kind = "Commands" if folder == COMMANDS else "Verbs"
    word = kind.lower().rstrip("s")
    lines = [f"  {name:<{width}}  {_summary(path)}".rstrip() for name, path in known.items()]
    return argparse.ArgumentParser(
        prog=program,
        usage=f"{program} [-h] <{word}> ...",
        description=_summary(folder),
        epilog="\n".join([f"{kind}:", *lines, "", f"  Call `{program} <{word}> -h` for more detailed usage."]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def _summary(path: Path) -> str:
    """Return the first line of the docstring of a file (of `__init__.py` for a folder), without importing it."""
    source = path / "__init__.py" if path.is_dir() else path
    text = ast.get_docstring(ast.parse(source.read_text(encoding="utf-8")))
    return (text or "").partition("\n")[0]
