"""The run of a grading in a notebook: its animation in a frame that works offline, a picture and words beside it."""

from __future__ import annotations

from typing import Any

from markupsafe import Markup, escape

from gz_course.grader.report.html.page import replay_of
from gz_course.grader.report.report import Report

CONTROLS = 190  # [pixels] of height below the drawing
WIDTH = 660  # [pixels]


class Replay:
    """Shown by a notebook as a frame; where frames are not shown, as a picture or in words."""

    def __init__(self, report: Report) -> None:
        self._page, self.words, self._picture = replay_of(report)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, str]:
        bundle = {"text/plain": self.words, "text/html": self._frame()}
        return bundle | ({"image/svg+xml": str(self._picture)} if self._picture else {})

    def _frame(self) -> str:
        tall = CONTROLS + (_aspect(self._picture) * WIDTH if self._picture else 0)
        frame = Markup(
            '<iframe sandbox="allow-scripts" srcdoc="{page}" title="{words}" width="{width}" height="{tall:.0f}" '
            'style="border: 0; max-width: 100%"></iframe><p>{words}</p>'
        ).format(page=escape(self._page), words=self.words, width=WIDTH, tall=tall)
        return str(frame)

    def __repr__(self) -> str:
        return self.words


def _aspect(picture: str) -> float:
    """Return height / width of an SVG drawing."""
    left, top, width, height = picture.partition('viewBox="')[2].partition('"')[0].split()
    return (float(height) - float(top)) / (float(width) - float(left))
