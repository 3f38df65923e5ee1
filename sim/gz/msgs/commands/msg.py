"""Look at message types: `gz msg --list`, `gz msg --info gz.msgs.Twist`.

Names come from the registry of gz.msgs, definitions from its descriptors. The exit code is 1 for an unknown type.

Source: https://github.com/gazebosim/gz-msgs/blob/gz-msgs10/core/cmd/cmdmsgs.rb.in
"""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from gz_course.sim.gz.msgs import message_class, type_names

if TYPE_CHECKING:
    from gz_course.sim.gz.command_line import Parser


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-l", "--list", action="store_true", help="the names of all message types")
    parser.add_argument("-i", "--info", nargs="+", metavar="TYPE", help="name, file and definition of types")
    parser.commands("--list", "--info")


def run(values: argparse.Namespace) -> int:
    """Run `gz msg`; return the exit code. Raises UnknownTypeError with the nearest names."""
    if values.list:
        for name in type_names():
            print(name)
    if values.info:
        from gz_course.sim.gz.msgs.descriptor_text import describe

        for each in [message_class(name) for name in values.info]:
            sys.stdout.write(describe(each))
    return 0
