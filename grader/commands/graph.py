"""`course graph`: nodes, topics, bridges and Gazebo's side as one picture.

For a running system.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def command(
    *,
    svg: Annotated[Path | None, typer.Option("--svg", help="Write one picture into this file and end.")] = None,
    all_topics: Annotated[bool, typer.Option("--all", help="Also /rosout and topics of Gazebo with one end.")] = False,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only.")] = False,
) -> None:
    """Draw nodes, topics, bridges and Gazebo's side, live in the browser or once with --svg; Ctrl-C ends it."""
    from gz_course.sim.show.rqt_graph.rqt_graph import main

    words = ["--all"] * all_topics + ["--no-browser"] * no_browser + ([f"--svg={svg}"] if svg is not None else [])
    raise typer.Exit(main(words, "course graph"))
