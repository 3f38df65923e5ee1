"""`course video RECORDING --out FILE.mp4|.gif`: a film of a run, without a display.

For instructors.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from gz_course.sim.terminal_text import unguarded


def command(
    recording: Annotated[Path, typer.Argument(help="The .rrd file a grading wrote.")],
    *,
    out: Annotated[Path, typer.Option("--out", help="The film: .gif, or .mp4 (needs the extra `video`).")],
    size: Annotated[str, typer.Option("--size", help="Width and height [px].")] = "640x400",
    fps: Annotated[float, typer.Option("--fps", help="Pictures per second.")] = 10.0,
    start: Annotated[float, typer.Option("--from", help="Begin at this simulated time [s].")] = 0.0,
    end: Annotated[float | None, typer.Option("--to", help="End at this simulated time [s].")] = None,
) -> None:
    """Write a film of a recorded run, at the speed of simulated time: what `course snapshot` shows, again and again."""
    from gz_course.grader.film.film import film, size_of
    from gz_course.grader.record.reading import Recording

    def progress(share: float) -> None:
        if sys.stderr.isatty():
            print(f"\r{share:4.0%}", end="\n" if share == 1.0 else "", file=unguarded(sys.stderr), flush=True)

    count = film(Recording(recording), out, size_of(size), fps, start, end, progress)
    print(f"written: {out} ({count} pictures)")
