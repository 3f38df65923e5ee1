"""Check or print a description: `gz sdf -k world.sdf`, `gz sdf -p robot.urdf`.

`-k` reads a world or model as `gz sim` would and prints `Valid.`, or the first fault (exit code 255, as in Gazebo);
warnings go to stderr. `-p` prints it as SDF: a URDF or xacro file is converted, and includes are replaced by what they
name, unless `-i` keeps them.

Source: https://github.com/gazebosim/sdformat/blob/sdf14/src/cmd/cmdsdformat.rb.in
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gz_course.sim.gz.command_line import Parser
from gz_course.sim.gz.sim.errors import Diagnostics, SimError
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.includes import Includes, Opened, read_root, sdf_version
from gz_course.sim.gz.sim.sdf.reader import read_model, read_world
from gz_course.sim.gz.sim.sdf.resources import FILES, read_text
from gz_course.sim.gz.sim.sdf.writer import to_xml
from gz_course.sim.gz.sim.sdf_generator import absolute_copy

_NOT_VALID = 255
_FRAMES_CHANGED = (1, 7)


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-k", "--check", metavar="FILE", help="read the file and say whether it is valid")
    parser.add_argument("-p", "--print", metavar="FILE", help="print the file as SDF, with what its includes name")
    parser.add_argument("-i", "--preserve-includes", action="store_true", help="keep the includes")
    parser.commands("--check", "--print")
    parser.needs("--preserve-includes", "--print")


def run(values: argparse.Namespace) -> int:
    """Run `gz sdf`; return the exit code."""
    path, diagnostics = Path(values.check or values.print), Diagnostics(quiet=True)
    try:
        if not path.is_file():
            raise SimError(f"there is no file '{path}'")
        text = read_text(path)
        root = read_root(text, str(path), diagnostics)
        if values.check:
            read = read_model if root.find("world") is None else read_world
            read(text, str(path), diagnostics)
            printed = "Valid."
        else:
            if not values.preserve_includes:
                root = _expanded(Opened(root, sdf_version(root), root), Includes(diagnostics, FILES), diagnostics)
            printed = f'<?xml version="1.0" ?>\n{to_xml(absolute_copy(root))}'
    except SimError as error:
        print(f"gz sdf: {error}", file=sys.stderr)
        return _NOT_VALID
    finally:
        for warning in diagnostics.warnings:
            print(f"Warning: {warning}", file=sys.stderr)
    print(printed)
    return 0


def _expanded(opened: Opened, includes: Includes, diagnostics: Diagnostics) -> Element:
    """Return a copy of an element whose includes are replaced; one that cannot be replaced stays, with a warning."""
    element = opened.element
    made = Element(element.tag, dict(element.attributes), element.text, file=element.file, line=element.line)
    for child in element.children:
        if child.tag not in ("world", "model", "include"):
            made.children.append(child)
            continue
        found = includes.open(child, opened.version, opened.chain)
        if found is None:
            made.children.append(child)
        elif found.merged or min(found.version, opened.version) < _FRAMES_CHANGED <= max(found.version, opened.version):
            why = 'merge="true"' if found.merged else "other rules for frames, those before SDF 1.7"
            diagnostics.warn(child.where, f"the include is kept, because it has {why}")
            made.children.append(child)
        else:
            made.children.append(_expanded(found, includes, diagnostics))
    return made
