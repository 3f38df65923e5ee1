"""Live frames in a notebook: the world of a running simulator, and what ROS says, each an address of this machine.

Used by `playground.py`. A frame is empty in what is saved or printed; the words beside it say what it showed.
"""

from __future__ import annotations

import contextlib
import importlib
from typing import Any

from markupsafe import Markup

from gz_course.grader.tools.side_panel import SidePanel, in_jupyterlab

HEIGHT = "520px"
BESIDE = "calc(100vh - 9rem)"
"""Height of a frame in a panel of JupyterLab: that of its window without menus and tabs."""
FRAME = '<iframe src="{address}" title="{words}" style="border: 0; width: 100%; height: {height}"></iframe>'
LINK = '<p>{words} <a href="{address}" target="_blank" rel="noopener">In a page of its own</a></p>'


class LiveFrame:
    """A page of this machine in a notebook; without an address there are only the words."""

    def __init__(self, words: str, address: str = "") -> None:
        self.words, self.address = words, address
        self.beside = False

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        if not self.address:
            return {"text/plain": self.words}
        page = LINK if self.beside else FRAME + LINK
        return {"text/plain": self.words, "text/html": self._html(page, HEIGHT)}

    def open_beside(self) -> SidePanel | None:
        """Show the page beside the notebook, and a link in its place; None where that cannot be."""
        if not self.address or not in_jupyterlab():
            return None
        with contextlib.suppress(ModuleNotFoundError):
            panel = SidePanel(self.words, self._html(FRAME, BESIDE))
            self.words = f"{self.words.rstrip('.')}, beside the notebook."
            self.beside = True
            return panel
        return None

    def _html(self, page: str, height: str) -> str:
        return str(Markup(page).format(address=self.address, words=self.words, height=height))

    def __repr__(self) -> str:
        return self.words


class WorldView:
    """The view of the world that runs in this environment, in a process of its own, until `close`."""

    def __init__(self, world: str = "") -> None:
        """Start it; `frame` shows it, or says in one sentence why there is none."""
        self._view: Any = None
        self._panel: SidePanel | None = None
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
            self._panel = self.frame.open_beside()

    def close(self) -> None:
        if self._panel is not None:
            self._panel.close()
            self._panel = None
        if self._view is not None:
            self._view.close()
            self._view = None
