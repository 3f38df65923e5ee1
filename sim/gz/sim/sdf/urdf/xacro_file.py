"""Expands a `.xacro` file and keeps the file and line of every element.

xacro can loop without end, so it runs in a separate process (`expand_xacro`) with limits of time and memory. In the
expanded XML every element has an attribute `PLACE`; `restore_places` removes it after parsing.

Source: https://wiki.ros.org/xacro
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.errors import LOG, SdfError

if TYPE_CHECKING:  # the child process imports this module too, without numpy
    from gz_course.sim.gz.sim.sdf.element import Element

PLACE = "_place_"
"""The attribute of every element in an expanded text: `INDEX:LINE`, with the index of the file in `FILES`."""
FILES = "_files_"
"""The attribute of the root element: a JSON list of the files."""

_SECONDS = 20.0
_PLACE = re.compile("([0-9]{1,6}):([0-9]{1,9})")
_COLOURS = re.compile("\x1b\\[[0-9;]*m")


def expand(path: Path, arguments: dict[str, str] | None = None) -> str:
    """Return the expanded text of a file; `arguments` are xacro's `name:=value`. Raises SdfError with one sentence."""
    pairs = [f"{name}:={value}" for name, value in (arguments or {}).items()]
    command = [sys.executable, "-m", "gz_course.sim.gz.sim.sdf.urdf.expand_xacro", str(path), *pairs]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "PYTHONIOENCODING": "utf-8"}
    try:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=_SECONDS,
            start_new_session=True,
            env=environment,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise SdfError(
            f"{path}: xacro did not end within {_SECONDS:g} s; a macro may call itself without end"
        ) from None
    notes = done.stderr.decode("utf-8", "replace").strip().splitlines()
    if done.returncode != 0:
        try:
            sentence = json.loads(notes[-1])["error"]
        except (IndexError, ValueError, KeyError, TypeError):
            sentence = f"{path}: xacro did not come to an end; a macro or an expression of it may grow without limit"
        raise SdfError(sentence)
    for note in filter(None, (_COLOURS.sub("", note).strip() for note in notes)):
        LOG.warning("%s: xacro says: %s", path, note)
    return done.stdout.decode("utf-8")


def restore_places(root: Element) -> None:
    """Set the original file and line of every element of an expanded text."""
    if FILES not in root.attributes:
        return
    try:
        files = [str(file) for file in json.loads(root.attributes.pop(FILES))]
    except (ValueError, TypeError, RecursionError):  # the file itself uses an attribute of this name
        files = []
    waiting = [(root, root.file, root.line)]
    while waiting:
        element, file, line = waiting.pop()
        place = _PLACE.fullmatch(element.attributes.pop(PLACE, ""))
        if place and int(place[1]) < len(files):
            file, line = files[int(place[1])], int(place[2])
        element.file, element.line = file, line
        waiting.extend((child, file, line) for child in element.children)
