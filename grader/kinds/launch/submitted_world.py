"""Descriptions of worlds and models that come out of the box: taken in piece by piece, with limits, as data.

A program in the box has opened, expanded and checked the files (`agent/course_agent/handing_over.py`). What comes is
untrusted all the same: it is kept under the hash of its content and read with resources that know nothing else
(`gz.sim.sdf.assets`), so no path of a submission is opened here and nothing of it is evaluated.
"""

from __future__ import annotations

import base64
from typing import Any

from gz_course.sim.gz.sim.errors import Diagnostics, ResourceError
from gz_course.sim.gz.sim.sdf.assets import MOST_BYTES, Assets
from gz_course.sim.gz.sim.sdf.description import WorldDescription
from gz_course.sim.gz.sim.sdf.reader import read_world

WORLD_FILE = "<world>"  # stands for the file of an element that does not say where it comes from


class SubmittedWorld:
    """What a submission has passed so far. `fault` says what could not be taken in, empty if all could."""

    def __init__(self) -> None:
        self.assets = Assets()
        self.fault = ""
        self._parts: dict[tuple[int, str], bytearray] = {}
        self._waiting = 0  # [bytes] in parts that are not complete

    def take(self, number: int, part: dict[str, Any]) -> None:
        """Take a part of an asset from the process `number`; parts come in order."""
        name, size = str(part["name"]), int(part["size"])
        data = base64.b64decode(str(part["data"]))
        key = (number, name)
        held = self._parts.setdefault(key, bytearray())
        self._waiting += len(data)
        if self._waiting > MOST_BYTES:
            self.fault = f"more than {MOST_BYTES >> 20} MiB of models, meshes and images were passed"
            self._parts.clear()
            self._waiting = 0
            return
        held += data
        if len(held) < size:
            return
        del self._parts[key]
        self._waiting -= len(held)
        try:
            self.assets.add(name, bytes(held))
        except ResourceError as error:
            self.fault = str(error)

    def read(self, address: str, diagnostics: Diagnostics) -> WorldDescription:
        """Read the world at an address. Raises `SdfError`."""
        return read_world(self.text(address), WORLD_FILE, diagnostics, self.assets)

    def text(self, address: str) -> str:
        """Return the text at an address; raise `ResourceError` with the reason it is not there."""
        try:
            return self.assets.text(address)
        except ResourceError as error:
            raise ResourceError(self.fault or str(error)) from None
