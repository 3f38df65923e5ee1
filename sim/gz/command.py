"""The `gz` command: finds the sub-command and hands over to it.

A sub-command `x` is a file and nothing else, found by looking into the folders and imported only when it is
called: `gz/x/command.py`, which reads its arguments itself (`gz sim world.sdf` calls main(["world.sdf"]) of
gz/sim/command.py), or `gz/*/commands/x.py`, for which `gz.command_line` reads them (`gz topic -l` is
gz/transport/commands/topic.py).
"""

from __future__ import annotations

import ast
import difflib
import importlib
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from gz_course.sim import gz

_DISTRIBUTION = "gz-ros2-course"
_ENGINES = ("mujoco", "pyzmq", "protobuf")


def find_commands(folders: Iterable[str | Path] | None = None) -> dict[str, Path]:
    """Sub-command name -> its file, sorted by name; by default from the folders of the package `gz`."""
    found: dict[str, Path] = {}
    for folder in folders or gz.__path__:
        for path in Path(folder).glob("*/command.py"):
            found.setdefault(path.parent.name, path)
        for path in Path(folder).glob("*/commands/*.py"):
            if not path.stem.startswith("_"):
                found.setdefault(path.stem, path)
    return dict(sorted(found.items()))


def _summary(path: Path) -> str:
    """The first line of the docstring of a file, without importing it."""
    try:
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    except (OSError, SyntaxError, ValueError):
        return ""
    return (text or "").partition("\n")[0]


def _help(commands: dict[str, Path]) -> str:
    width = max((len(name) for name in commands), default=0)
    lines = [f"  {name:<{width}}  {_summary(path)}".rstrip() for name, path in commands.items()]
    return "\n".join(
        [
            "The gz command: simulation and messages as in Gazebo.",
            "",
            "usage: gz COMMAND [OPTIONS]",
            "",
            "Commands:",
            *(lines or ["  (none is installed)"]),
            "",
            "Options:",
            "  -h, --help   this text",
            "  --versions   the versions of what is installed",
            "",
            "`gz COMMAND --help` tells more about one of them.",
        ]
    )


def _versions() -> str:
    from importlib import metadata  # slow to load, and needed only here

    lines = []
    for name in (_DISTRIBUTION, *_ENGINES):
        try:
            lines.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            lines.append(f"{name} (not installed)")
    return "\n".join(lines)


def main(argv: Sequence[str] | None = None) -> int:
    """Runs `gz` with the given arguments (default: those of the process); the exit code.

    0 on success, 2 for a command that does not exist, otherwise what the sub-command returns.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    commands = find_commands()
    first = arguments[0] if arguments else "--help"
    if first in ("-h", "--help", "help"):
        print(_help(commands))
        return 0
    if first in ("--versions", "--version"):
        print(_versions())
        return 0
    if first not in commands:
        print(_unknown(first, commands), file=sys.stderr)
        return 2
    code = _run(first, commands[first], arguments[1:])
    if argv is None:
        from gz_course.sim.gz.command_line import leave_signals

        leave_signals()
    return code


def _run(name: str, path: Path, arguments: list[str]) -> int:
    if path.parent.name != "commands":
        return importlib.import_module(f"gz_course.sim.gz.{name}.command").main(arguments) or 0
    from gz_course.sim.gz import command_line

    module = f"gz_course.sim.gz.{path.parents[1].name}.commands.{name}"
    return command_line.run(module, f"gz {name}", arguments, _summary(path))


def _unknown(name: str, commands: dict[str, Path]) -> str:
    known = [*commands, "--help", "--versions"]
    nearest = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"did you mean `gz {nearest[0]}`?" if nearest else "`gz --help` lists what there is."
    kind = "option" if name.startswith("-") else "command"
    return f"gz: there is no {kind} {name!r}; {hint}"
