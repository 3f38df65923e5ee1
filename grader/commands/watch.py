"""`course watch [TOPIC...]`: what ROS says, live, in the Rerun viewer.

For a running system.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def command(
    topics: Annotated[list[str] | None, typer.Argument(metavar="[TOPIC]...", help="Topics or patterns.")] = None,
    *,
    plot: Annotated[list[str] | None, typer.Option("--plot", help="A field to plot, /odom/twist/linear/x.")] = None,
    fixed_frame: Annotated[str, typer.Option("--fixed-frame", help="The frame to look from.")] = "",
    web: Annotated[bool, typer.Option("--web", help="In a browser; the page is of this machine only.")] = False,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="With --web: print the address only.")] = False,
    save: Annotated[Path | None, typer.Option("--save", help="Write an .rrd file instead of showing anything.")] = None,
) -> None:
    """Show scans, pictures, clouds, paths, /tf, markers, plots and /rosout as they come; Ctrl-C ends it."""
    from gz_course.sim.show.rviz2.rviz2 import main

    words = [*(topics or []), *(f"--plot={each}" for each in plot or []), f"--fixed-frame={fixed_frame}"]
    words += ["--web"] * web + ["--no-browser"] * no_browser + ([f"--save={save}"] if save is not None else [])
    raise typer.Exit(main(words, "course watch"))
