"""The console that commands print to: coloured in a terminal, where it writes no control codes but its own."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from typing import Any

from rich.console import Console, ConsoleOptions, RenderableType
from rich.segment import Segment

from gz_course.sim.terminal_text import printable, unguarded


class GuardedConsole(Console):
    """As rich's, on standard output or, with `stderr`, standard error, whatever names stand in what is printed."""

    def __init__(self, *, stderr: bool = False, **options: Any) -> None:
        super().__init__(**{"file": unguarded(sys.stderr if stderr else sys.stdout), **options})

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """Yield the pieces of something to print; control codes in its text are replaced."""
        for piece in super().render(renderable, options):
            yield piece if piece.control else Segment(printable(piece.text), piece.style)


def print_wrong(sentences: Iterable[str]) -> None:
    """Print what is wrong in an author's files, one line each, on standard error."""
    console = GuardedConsole(stderr=True)
    for sentence in sentences:
        console.print(f"WRONG  {sentence}", markup=False, highlight=False, soft_wrap=True)
