"""Check or print a description: `gz sdf -k world.sdf`, `gz sdf -p robot.urdf`, `gz sdf -g pose world.sdf`.

`-k` reads a world or model as `gz sim` would and prints `Valid.`, or the first fault (exit code 255, as in Gazebo);
warnings go to stderr. `-p` prints it as SDF: a URDF or xacro file is converted, and includes are replaced by what they
name, unless `-i` keeps them. `-d` prints all elements and attributes of SDF, without their texts. `--inertial-stats`
prints mass, centre of mass and inertia of a model. `-g` prints the graph of its frames: which poses are relative to
which (`pose`), or which frames are attached to which (`frame`).

Source: https://github.com/gazebosim/sdformat/blob/sdf14/src/cmd/cmdsdformat.rb.in
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.command_line import Parser, positive_number, whole_number
from gz_course.sim.gz.sim.errors import Diagnostics, SimError
from gz_course.sim.gz.sim.sdf.description import Model
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frame_graph import KINDS, FrameGraph
from gz_course.sim.gz.sim.sdf.includes import Includes, Opened, read_root, sdf_version
from gz_course.sim.gz.sim.sdf.printing import Numbers, inertia_lines, state_inertia
from gz_course.sim.gz.sim.sdf.reader import read_model, read_world
from gz_course.sim.gz.sim.sdf.resources import FILES, read_text
from gz_course.sim.gz.sim.sdf.vocabulary import described
from gz_course.sim.gz.sim.sdf.writer import to_xml
from gz_course.sim.gz.sim.sdf_generator import absolute_copy

_NOT_VALID = 255
_FRAMES_CHANGED = (1, 7)
_OF_PRINT = ("--preserve-includes", "--degrees", "--snap-to-degrees", "--snap-tolerance", "--precision")


def add_arguments(parser: Parser) -> None:
    parser.add_argument("-k", "--check", metavar="FILE", help="read the file and say whether it is valid")
    parser.add_argument("-p", "--print", metavar="FILE", help="print the file as SDF, with what its includes name")
    parser.add_argument("-i", "--preserve-includes", action="store_true", help="keep the includes")
    parser.add_argument("--degrees", action="store_true", help="angles of poses in degrees")
    parser.add_argument(
        "--snap-to-degrees", type=whole_number, default=0, metavar="N", help="angles near multiples of N become those"
    )
    parser.add_argument(
        "--snap-tolerance", type=positive_number, default=0.01, metavar="DEGREES", help="how near (default: 0.01)"
    )
    parser.add_argument(
        "--precision", type=whole_number, default=0, metavar="N", help="write numbers with N digits (default: all)"
    )
    parser.add_argument("--expand-auto-inertials", action="store_true", help="write automatic inertias as numbers")
    parser.add_argument("--inertial-stats", metavar="FILE", help="mass, centre of mass and inertia of a model file")
    parser.add_argument(
        "-g", "--graph", nargs=2, metavar=("{pose,frame}", "FILE"), help="print the graph of frames in the DOT language"
    )
    parser.add_argument("-d", "--describe", action="store_true", help="print the elements and attributes of SDF")
    parser.commands("--check", "--print", "--inertial-stats", "--graph", "--describe")
    for option in (*_OF_PRINT, "--expand-auto-inertials"):
        parser.needs(option, "--print")
    parser.needs("--snap-tolerance", "--snap-to-degrees")


def run(values: argparse.Namespace) -> int:
    """Run `gz sdf`; return the exit code. Raises ValueError for angles that cannot be snapped to."""
    if values.snap_to_degrees and not values.snap_tolerance < values.snap_to_degrees <= 360:
        raise ValueError("--snap-to-degrees must be above its tolerance and at most 360")
    if values.describe:
        print("\n".join(described()))
        return 0
    kind, graphed = values.graph or ("", "")
    if kind and kind not in KINDS:
        raise ValueError(f"--graph takes {' or '.join(KINDS)} and a file, got '{kind}'{did_you_mean(kind, KINDS)}")
    path = Path(values.check or values.print or values.inertial_stats or graphed)
    diagnostics = Diagnostics(quiet=True)
    try:
        if not path.is_file():
            raise SimError(f"there is no file '{path}'")
        root = read_root(read_text(path), str(path), diagnostics)
        if values.check:
            read = read_model if root.find("world") is None else read_world
            read(read_text(path), str(path), diagnostics)
            printed = "Valid."
        elif kind:
            printed = str(FrameGraph(_replaced(root, diagnostics), kind))
        elif values.inertial_stats:
            printed = "\n".join(inertia_lines(_only_model(path, root, diagnostics)))
        else:
            printed = _printed(root, path, values, diagnostics)
    except SimError as error:
        print(f"gz sdf: {error}", file=sys.stderr)
        return _NOT_VALID
    finally:
        for warning in diagnostics.warnings:
            print(f"Warning: {warning}", file=sys.stderr)
    print(printed)
    return 0


def _only_model(path: Path, root: Element, diagnostics: Diagnostics) -> Model:
    if root.find("world") is not None:
        raise SimError(f"'{path}' is a world file; --inertial-stats takes the file of a model")
    model = read_model(read_text(path), str(path), diagnostics)
    if not isinstance(model, Model):
        raise SimError(f"there is no model in '{path}'")
    return model


def _printed(root: Element, path: Path, values: argparse.Namespace, diagnostics: Diagnostics) -> str:
    if not values.preserve_includes:
        root = _replaced(root, diagnostics)
    root = absolute_copy(root)
    if values.expand_auto_inertials:
        root = _with_inertia(root, path)
    Numbers(values.degrees, values.snap_to_degrees, values.snap_tolerance, values.precision).rewrite(root)
    return f'<?xml version="1.0" ?>\n{to_xml(root)}'


def _with_inertia(root: Element, path: Path) -> Element:
    """Return the root with numbers in place of automatic inertias, but for models that are still included."""
    text, quiet = to_xml(root), Diagnostics(quiet=True)
    if root.find("world") is not None:
        world = read_world(text, str(path), quiet)
        for model in world.models:
            state_inertia(model)
        return Element(root.tag, root.attributes, children=[world.element])
    model_or_light = read_model(text, str(path), quiet)
    if isinstance(model_or_light, Model):
        state_inertia(model_or_light)
    return Element(root.tag, root.attributes, children=[model_or_light.element])


def _replaced(root: Element, diagnostics: Diagnostics) -> Element:
    """Return the root with what its includes name."""
    return _expanded(Opened(root, sdf_version(root), root), Includes(diagnostics, FILES), diagnostics)


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
