"""Output the interface definition."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterator

from gz_course.sim.ros.ros2.interface import add_interface_type, interface_file

_FIELD = re.compile(r"\s*(?:@\w+.*\s)?(?P<type>[A-Za-z][\w/]*)(?:<=\d+)?(?:\[[<=\d]*\])?\s+\w+")
_PRIMITIVE = {
    *("bool", "byte", "char", "float32", "float64", "string", "wstring"),
    *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_interface_type(parser, "; - reads it")
    comments = parser.add_mutually_exclusive_group()
    comments.add_argument("--all-comments", action="store_true", help="Show all comments, those of nested types too")
    comments.add_argument("--no-comments", action="store_true", help="Show no comments and no empty lines")


def main(arguments: argparse.Namespace) -> None:
    """Print the definition, with that of each field's type indented below the field."""
    name = sys.stdin.readline().strip() if arguments.type == "-" else arguments.type
    for line in _lines(name, not arguments.no_comments, arguments.all_comments):
        print(line)


def _lines(name: str, comments: bool, nested_comments: bool) -> Iterator[str]:
    package = name.partition("/")[0]
    for raw in interface_file(name).read_text(encoding="utf-8").splitlines():
        code = _without_comment(raw)
        if comments:
            yield raw.rstrip()
        elif code:
            yield code
        if inner := _nested_type(code, package):
            for line in _lines(inner, nested_comments, nested_comments):
                yield f"\t{line}"


def _without_comment(line: str) -> str:
    """Return the line up to its #, unless that is inside the quotes of a default text."""
    code = re.match(r"""(?:[^#"']|"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'|["'])*""", line)
    return code.group().rstrip() if code else line.rstrip()


def _nested_type(code: str, package: str) -> str | None:
    """Return `package/msg/Name` of a field's message; None for a plain field, a constant or anything else."""
    field = _FIELD.match(code)
    if field is None or field["type"] in _PRIMITIVE:
        return None
    parts = field["type"].split("/")
    return f"{parts[0] if len(parts) > 1 else package}/msg/{parts[-1]}"
