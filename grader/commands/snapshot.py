"""`course snapshot RECORDING --at T --out FILE.png`: a picture of a moment of a run, without a display.

For instructors.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def command(
    recording: Annotated[Path, typer.Argument(help="The .rrd file a grading wrote.")],
    *,
    out: Annotated[Path, typer.Option("--out", help="The picture: .png or .jpg.")],
    at: Annotated[float, typer.Option("--at", help="Simulated time [s].")] = 0.0,
    size: Annotated[str, typer.Option("--size", help="Width and height [px].")] = "1280x720",
) -> None:
    """Write a picture of a moment of a recorded run: the world from outside, scan, path, verdicts so far."""
    from gz_course.grader.film.film import size_of, snapshot
    from gz_course.grader.record.reading import Recording

    snapshot(Recording(recording), at, out, size_of(size))
    print(f"written: {out}")
