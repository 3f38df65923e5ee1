"""Live frames in a notebook: the world of a running simulator, and what ROS says, each an address of this machine.

Used by `playground.py`. A frame is empty in what is saved or printed; the words beside it say what it showed.
"""

from __future__ import annotations

import importlib
from typing import Any

from markupsafe import Markup

HEIGHT = 520  # [pixels]


class LiveFrame:
    """A page of this machine in a notebook; without an address there are only the words."""

    def __init__(self, words: str, address: str = "") -> None:
        self.words, self.address = words, address

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        if not self.address:
            return {"text/plain": self.words}
        frame = Markup(
            '<iframe src="{address}" title="{words}" width="100%" height="{height}" style="border: 0"></iframe>'
            '<p>{words} <a href="{address}" target="_blank" rel="noopener">In a page of its own</a></p>'
        )
        return {
            "text/plain": self.words,
            "text/html": str(frame.format(address=self.address, words=self.words, height=HEIGHT)),
        }

    def __repr__(self) -> str:
        return self.words


class WorldView:
    """The view of the world that runs in this environment, in a process of its own, until `close`."""

    def __init__(self, world: str = "") -> None:
        """Start it; `frame` shows it, or says in one sentence why there is none."""
        self._view: Any = None
        try:
            room = importlib.import_module("gz_course.sim.gz.view")
        except ModuleNotFoundError:
            self.frame = LiveFrame("There is no live view in this copy of the course; a recording can be replayed.")
            return
        self._view = room.View(world, search=not world)
        try:
            self._view.wait()
        except room.ViewError as error:
            self.close()
            self.frame = LiveFrame(f"There is no live view: {error}.")
        else:
            self.frame = LiveFrame(f"The world {world}, live.".replace(" ,", ","), self._view.address)

    def close(self) -> None:
        if self._view is not None:
            self._view.close()
            self._view = None
