"""The `ros2` command: finds the command and its verb, reads their options and runs them.

`ros2 topic echo /scan` calls `main` of `command/topic/echo.py`, `ros2 run …` that of `command/run.py`. Such a
file has `add_arguments(parser)` and `main(arguments)`; the first line of its docstring is its help. Nothing is
listed by hand and only the file in question is imported.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import difflib
import importlib
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from gz_course.sim.prefix import local_setup
from gz_course.sim.ros2 import completion, interruption
from gz_course.sim.ros2.errors import CommandError
from gz_course.sim.ros2.hand_over import hand_over

COMMANDS = Path(__file__).parent / "command"
_INTERRUPTED = 2
_GRAPH = "ros2.graph"  # loaded by verbs that have a node


def main(arguments: Sequence[str] | None = None) -> int:
    """Run `ros2` with these arguments (default: those of the process); the exit code.

    0 on success, 1 when the command could not do its work, 2 for wrong usage or after SIGINT or SIGTERM.
    """
    is_program = arguments is None
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    local_setup.source(os.environ)
    code = hand_over(arguments)
    if code is not None:
        return code
    code = _explained(arguments)
    if is_program and _GRAPH in sys.modules:
        # The node has said goodbye; what is left of DDS can block at exit, and nobody needs it any more.
        with contextlib.suppress(OSError, ValueError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(code)
    return code


def _explained(arguments: list[str]) -> int:
    """Run `ros2`; every error is one sentence and an exit code."""
    # A shell's '&' starts programs with SIGINT ignored; an ended node must say so to the others: both signals
    # arrive as KeyboardInterrupt.
    interruption.listen()
    try:
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
        return _run(COMMANDS, "ros2", arguments)
    except CommandError as error:
        print(error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return _INTERRUPTED
    except BrokenPipeError:
        # `ros2 topic echo /scan | head`: the reader has seen enough.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        if sys.flags.dev_mode:  # `python -X dev -m ros2 …` shows where
            raise
        sentence = str(error).partition("\n")[0]
        print(f"ros2: internal error: {type(error).__name__}: {sentence}", file=sys.stderr)
        return 1


def found(folder: Path) -> dict[str, Path]:
    """Name -> file or folder of the commands (or of a command's verbs), sorted by name."""
    paths = {path.stem: path for path in folder.iterdir() if path.suffix == ".py" or path.is_dir()}
    return {name: paths[name] for name in sorted(paths) if not name.startswith("_")}


def _run(folder: Path, program: str, arguments: list[str]) -> int:
    """Run one of the commands in `folder`; `program` is what the user has typed so far."""
    known = found(folder)
    parser = _menu(folder, program, known)
    first = arguments[0] if arguments else "--help"
    if folder == COMMANDS and first == completion.PRINT:
        return completion.print_script(arguments[1:])
    if folder == COMMANDS and first == completion.COMPLETE:
        return completion.print_candidates(arguments[1:])
    if first in ("-h", "--help"):
        parser.print_help()
        return 0
    if first.startswith("-"):
        parser.error(f"unrecognized arguments: {first}")
    if first not in known:
        nearest = difflib.get_close_matches(first, known, n=1)
        hint = f"; did you mean '{nearest[0]}'?" if nearest else ""
        parser.error(f"invalid choice: {first!r} (choose from {', '.join(map(repr, known))}){hint}")
    if known[first].is_dir():
        return _run(known[first], f"{program} {first}", arguments[1:])
    module, verb = load(known[first], f"{program} {first}")
    return module.main(verb.parse_args(arguments[1:])) or 0


def load(path: Path, program: str) -> tuple[Any, argparse.ArgumentParser]:
    """The module of a command or verb, and the reader of its options; `program` is what the user has typed for it."""
    module = importlib.import_module(_module_name(path))
    parser = argparse.ArgumentParser(prog=program, description=_summary(path))
    module.add_arguments(parser)
    return module, parser


def _menu(folder: Path, program: str, known: dict[str, Path]) -> argparse.ArgumentParser:
    width = max(len(name) for name in known)
    kind = "Commands" if folder == COMMANDS else "Verbs"
    word = kind.lower().rstrip("s")
    more = ["", *completion.HELP] if folder == COMMANDS else []
    lines = [f"  {name:<{width}}  {_summary(path)}".rstrip() for name, path in known.items()]
    return argparse.ArgumentParser(
        prog=program,
        usage=f"{program} [-h] <{word}> ...",
        description=_summary(folder),
        epilog="\n".join([f"{kind}:", *lines, "", f"  Call `{program} <{word}> -h` for more detailed usage.", *more]),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def _module_name(path: Path) -> str:
    return ".".join([__package__ or "", *path.relative_to(COMMANDS.parent).with_suffix("").parts])


def _summary(path: Path) -> str:
    """The first line of the docstring of a file (of `__init__.py` for a folder), without importing it."""
    source = path / "__init__.py" if path.is_dir() else path
    text = ast.get_docstring(ast.parse(source.read_text(encoding="utf-8")))
    return (text or "").partition("\n")[0]
