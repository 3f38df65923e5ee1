"""The `gz` command: finds the sub-command and runs it.

Sub-command `x` is the file `gz/*/commands/x.py`; it is found by listing the folders and imported only when it is
called. `gz.command_line` reads its options (`gz topic -l` is gz/transport/commands/topic.py).
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from gz_course.sim import gz
from gz_course.sim.foreign_variables import set_aside
from gz_course.sim.terminal_text import guard

_DISTRIBUTION = "gz-ros2-course"
_ENGINES = ("mujoco", "pyzmq", "protobuf")


def find_commands(folders: Iterable[str | Path] | None = None) -> dict[str, Path]:
    """Return the file of each sub-command, sorted by name; by default from all folders of the `gz` package."""
    found: dict[str, Path] = {}
    for folder in folders or gz.__path__:
        for path in Path(folder).glob("*/commands/*.py"):
            if not path.stem.startswith("_"):
                found.setdefault(path.stem, path)
    return dict(sorted(found.items()))


def summary(path: Path) -> str:
    """Return the first line of the docstring of a file, without importing it."""
    try:
        text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    except (OSError, SyntaxError, ValueError):
        return ""
    return (text or "").partition("\n")[0]


def _help(commands: dict[str, Path]) -> str:
    width = max((len(name) for name in commands), default=0)
    lines = [f"  {name:<{width}}  {summary(path)}".rstrip() for name, path in commands.items()]
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
            "`gz COMMAND --help` prints the options of a command.",
        ]
    )


def _versions() -> str:
    from importlib import metadata  # slow to import, and needed only here

    lines = []
    for name in (_DISTRIBUTION, *_ENGINES):
        try:
            lines.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            lines.append(f"{name} (not installed)")
    return "\n".join(lines)


def main(argv: Sequence[str] | None = None) -> int:
    """Run `gz` with these arguments (default: those of the process); return the exit code of the sub-command, 2 for an
    unknown command, 109 for an unknown option.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    if argv is None:
        guard()
        set_aside("gz", ros=False)
    commands = find_commands()
    first = arguments[0] if arguments else "--help"
    if first in ("-h", "--help", "help"):
        print(_help(commands))
        return 0
    if first in ("--versions", "--version"):
        print(_versions())
        return 0
    from gz_course.sim.gz import command_line  # slow to import; help and versions do not need it

    if first not in commands:
        is_option = first.startswith("-")
        known = ["--help", "--versions"] if is_option else list(commands)
        sentence = command_line.unknown_option(first, known, "gz", "option" if is_option else "command")
        print(f"gz: {sentence}", file=sys.stderr)
        return command_line.UNKNOWN_OPTION if is_option else 2
    path = commands[first]
    module = f"gz_course.sim.gz.{path.parents[1].name}.commands.{first}"
    code = command_line.run(module, f"gz {first}", arguments[1:], summary(path))
    if argv is None:
        command_line.leave_signals()
    return code


if __name__ == "__main__":
    raise SystemExit(main())
