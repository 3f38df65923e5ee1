"""Live views inside a notebook: a frame around a page of the viewer, with words and a still picture beside it.

    watch_frame(room.start, "/scan", "/odom", plot=["/odom/twist/linear/x"])   # `room` is a Playground

Works offline: the page comes from this machine. Where no page can be shown (nbclient, print, a screen reader) there are
the words, and the picture if there is one.
"""

from __future__ import annotations

import base64
import html
import re
import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

from gz_course.sim import jupyter_proxy

NOT_HERE = "a frame that moves needs a browser on the machine where the notebook runs"
READY = "Ctrl-C ends it"


class Started(Protocol):
    """A program that was started, such as that of a `Playground`."""

    def wait_for(self, text: str) -> str:
        """Wait until it has printed a text; return its output so far."""


@dataclass(frozen=True)
class Frame:
    """A page at `address` as the value of a notebook's cell; `still` is a PNG file, or empty."""

    address: str
    words: str
    still: bytes = b""
    height: int = 560

    def _repr_html_(self) -> str:
        words, address = html.escape(self.words), html.escape(self.address)
        picture = image = ""
        if self.still:
            data = base64.b64encode(self.still).decode()
            image = f'<img alt="{words}" style="max-width:100%" src="data:image/png;base64,{data}">'
        if jupyter_proxy.is_between():  # Rerun's page asks for its data at an address of this machine
            return f"<figure style='margin:0'>{image}<figcaption>{words} ({NOT_HERE})</figcaption></figure>"
        if image:
            picture = f"<details><summary>as a still picture</summary>{image}</details>"
        return (
            f'<figure style="margin:0"><iframe src="{address}" title="{words}" width="100%" height="{self.height}" '
            f'style="border:1px solid #999"></iframe><figcaption>{words} (<a href="{address}" target="_blank" '
            f'rel="noopener">in a tab of its own</a>)</figcaption>{picture}</figure>'
        )

    def __repr__(self) -> str:
        return f"{self.words}: {self.address}"


def watch_frame(
    start: Callable[[str, str], Started],
    *topics: str,
    plot: Sequence[str] = (),
    fixed_frame: str = "",
    height: int = 560,
) -> Frame:
    """Start `course watch` with `start(command, instead_of)` and return the frame that shows it.

    `topics` are names or patterns (none: all), `plot` the fields to plot (none: all).
    """
    words = ["course", "watch", "--web", "--no-browser", *(f"--plot={each}" for each in plot), *topics]
    if fixed_frame:
        words.append(f"--fixed-frame={fixed_frame}")
    said = start(shlex.join(words), "course watch").wait_for(READY)
    found = re.search(r"http://\S+", said)
    assert found is not None, said
    shown = ", ".join(topics) if topics else "all topics"
    return Frame(found.group(), f"Live, what ROS says: {shown}", height=height)
