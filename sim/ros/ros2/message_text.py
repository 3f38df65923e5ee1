"""A ROS message as text: block YAML as in `ros2 topic echo`, or one line of CSV.

Fields are in the order of the message definition. Values longer than the limit are cut and end in `...`.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import dataclass
from typing import Any

import yaml

from gz_course.sim.ros.ros2.option_values import whole_number
from gz_course.sim.ros.rosidl_runtime_py.convert import MessageDumper, message_to_csv, message_to_ordereddict


@dataclass(frozen=True)
class TextFormat:
    """The format of a message: `limit` items or characters (None: all), with or without arrays and strings."""

    limit: int | None = 128
    arrays: bool = True
    strings: bool = True
    flow_style: bool = False


def add_text_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of every verb that prints messages as they arrive."""
    parser.add_argument("-f", "--full-length", action="store_true", help="Output all elements and characters")
    parser.add_argument(
        "-l", "--truncate-length", type=whole_number, default=128, metavar="N", help="Cut at N items (default: 128)"
    )
    parser.add_argument("--no-arr", action="store_true", help="Don't print array fields of messages")
    parser.add_argument("--no-str", action="store_true", help="Don't print string fields of messages")
    parser.add_argument("--flow-style", action="store_true", help="Print collections in the block style inline")
    parser.add_argument("--csv", action="store_true", help="Output all recursive fields separated by commas")


def chosen_text(arguments: argparse.Namespace) -> TextFormat:
    """Return the format of the options of `add_text_options`."""
    return TextFormat(
        limit=None if arguments.full_length else arguments.truncate_length,
        arrays=not arguments.no_arr,
        strings=not arguments.no_str,
        flow_style=arguments.flow_style,
    )


def is_message(value: Any) -> bool:
    """Return whether a value is a message and not a plain field."""
    return hasattr(value, "get_fields_and_field_types")


def to_yaml(message: Any, form: TextFormat) -> str:
    """Return the message as YAML, ending in a line break."""
    return plain_to_yaml(to_plain(message, form), form)


def to_plain(message: Any, form: TextFormat) -> dict[str, Any]:
    """Return the fields of a message as dictionaries, lists and plain values."""
    return message_to_ordereddict(message, truncate_length=form.limit, no_arr=not form.arrays, no_str=not form.strings)


def plain_to_yaml(fields: dict[str, Any], form: TextFormat) -> str:
    """Return what `to_plain` returned as YAML, ending in a line break."""
    return yaml.dump(
        fields,
        Dumper=MessageDumper,
        sort_keys=False,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=None if form.flow_style else False,
    )


def to_line(message: Any) -> str:
    """Return the whole message as YAML in one line."""
    text = yaml.dump(
        message_to_ordereddict(message), Dumper=_LineDumper, sort_keys=False, width=sys.maxsize, default_flow_style=True
    )
    return text.rstrip("\n")


def to_csv(message: Any, form: TextFormat) -> str:
    """Return all values of the message in one line, separated by commas."""
    return message_to_csv(message, truncate_length=form.limit, no_arr=not form.arrays, no_str=not form.strings)


class _LineDumper(MessageDumper):
    """A dumper that writes everything in one line."""


def _line(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    style = '"' if text.splitlines() != [text] else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


_LineDumper.add_representer(str, _line)
