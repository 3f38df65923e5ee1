"""A ROS message as text: block YAML as in `ros2 topic echo`, or one line of CSV.

Fields are in the order of the message definition. Values longer than the limit are cut and end in `...`.

Source: ros2/rosidl_runtime_py, rosidl_runtime_py/convert.py
"""

from __future__ import annotations

import argparse
import array
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import yaml

from gz_course.sim.ros.ros2.option_values import whole_number

_SEQUENCES = (list, tuple, array.array, np.ndarray)


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
    found: dict[str, Any] = _plain(message, "", form)
    return found


def plain_to_yaml(fields: dict[str, Any], form: TextFormat) -> str:
    """Return what `to_plain` returned as YAML, ending in a line break."""
    return yaml.dump(
        fields,
        Dumper=_Dumper,
        sort_keys=False,
        allow_unicode=True,
        width=sys.maxsize,
        default_flow_style=None if form.flow_style else False,
    )


def to_line(message: Any) -> str:
    """Return the whole message as YAML in one line."""
    whole = _plain(message, "", TextFormat(limit=None))
    text = yaml.dump(whole, Dumper=_LineDumper, sort_keys=False, width=sys.maxsize, default_flow_style=True)
    return text.rstrip("\n")


def to_csv(message: Any, form: TextFormat) -> str:
    """Return all values of the message in one line, separated by commas."""
    return ",".join(_values(_plain(message, "", form)))


class _Dumper(yaml.SafeDumper):
    """A dumper that writes shared values in full instead of as aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def _text(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    # YAML folds these line breaks, unless they are escaped in double quotes.
    style = '"' if any(mark in text for mark in "\x85\u2028\u2029") else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


_Dumper.add_representer(str, _text)


class _LineDumper(_Dumper):
    """A dumper that writes everything in one line."""


def _line(dumper: yaml.SafeDumper, text: str) -> yaml.ScalarNode:
    style = '"' if text.splitlines() != [text] else None
    return dumper.represent_scalar("tag:yaml.org,2002:str", text, style=style)


_LineDumper.add_representer(str, _line)


def _plain(value: Any, kind: str, form: TextFormat) -> Any:
    """Return the value in Python's own types; `kind` is its type in the message definition."""
    if is_message(value):
        fields = value.get_fields_and_field_types()
        return {name: _plain(getattr(value, name), field, form) for name, field in fields.items()}
    if isinstance(value, bytes):
        value = value.decode("latin-1")
        return value if form.limit is None or len(value) <= form.limit else value[: form.limit] + "..."
    if isinstance(value, str):
        if not form.strings:
            return f"<string length: <{len(value)}>>"
        return value if form.limit is None or len(value) <= form.limit else value[: form.limit] + "..."
    if isinstance(value, _SEQUENCES):
        return _sequence(value, kind, form)
    return value.item() if isinstance(value, np.generic) else value


def _sequence(value: Any, kind: str, form: TextFormat) -> Any:
    # "sequence<float>", "sequence<float, 3>" or "double[9]"
    if not form.arrays:
        if kind.startswith("sequence<"):
            return f"<sequence type: {kind[9:].rstrip('>').partition(',')[0]}, length: {len(value)}>"
        return f"<array type: {kind}>"
    item_kind = kind[9:].rstrip(">").partition(",")[0] if kind.startswith("sequence<") else kind.partition("[")[0]
    shown = value if form.limit is None else value[: form.limit]
    items = [_plain(item, item_kind, form) for item in shown]
    return items if len(shown) == len(value) else [*items, "..."]


def _values(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        for item in value.values():
            yield from _values(item)
    elif isinstance(value, list):
        for item in value:
            yield from _values(item)
    else:
        yield str(value)
