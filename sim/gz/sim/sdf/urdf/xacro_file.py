"""Runs xacro on a `.xacro` file and keeps the file and line that every element comes from.

Called by `gz.sim.sdf.resources.read_text`. xacro can loop and calculate without end, so it runs in a process of its
own (`expand_xacro`) with limits of time and memory. The text that comes back is plain XML in which every element has an
attribute `PLACE`; `restore_places` takes them off again after parsing.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

from gz.sim.errors import LOG, SdfError
from gz.sim.sdf.element import Element
from gz.sim.sdf.urdf.expand_xacro import FILES, PLACE

_SECONDS = 30.0


def expand(path: Path, arguments: dict[str, str] | None = None) -> str:
    """Return what xacro makes of a file, for `arguments` (xacro's `name:=value`); raise `SdfError` in one sentence."""
    pairs = [f"{name}:={value}" for name, value in (arguments or {}).items()]
    command = [sys.executable, "-m", "gz.sim.sdf.urdf.expand_xacro", str(path), *pairs]
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
            sentence = f"{path}: xacro ended without a result; it may have needed too much memory or time"
        raise SdfError(sentence)
    for note in notes:
        LOG.warning("%s: xacro says: %s", path, note)
    return done.stdout.decode("utf-8")


def restore_places(root: Element) -> None:
    """Give every element of an expanded text the file and line it was written at."""
    if FILES not in root.attributes:
        return
    files = json.loads(root.attributes.pop(FILES))
    waiting = [(root, root.file, root.line)]
    while waiting:
        element, file, line = waiting.pop()
        number, _, at = element.attributes.pop(PLACE, "").partition(":")
        if at:
            file, line = files[int(number)], int(at)
        element.file, element.line = file, line
        waiting.extend((child, file, line) for child in element.children)
