"""`course show RECORDING`: look at a run in the Rerun viewer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer


def command(
    recording: Annotated[Path, typer.Argument(help="The .rrd file a grading wrote.")],
    *,
    web: Annotated[bool, typer.Option("--web", help="In a browser; the page is of this machine only.")] = False,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="With --web: print the address only.")] = False,
) -> None:
    """Open a recording in the Rerun viewer; the command ends when its window is closed, or with Ctrl-C."""
    from gz_course.grader.errors import UsageError
    from gz_course.grader.record.reading import Recording
    from gz_course.sim.show.rviz2.viewer import ViewerError, binary, has_display

    Recording(recording)
    if web:
        _serve(recording, not no_browser)
        return
    if not has_display():
        raise UsageError(
            f"there is no display to open a window on; `course show {recording} --web` shows it in a browser"
        )
    try:
        viewer = binary()
    except ViewerError as error:
        raise UsageError(str(error)) from None
    # CI=1 is the only switch that keeps the viewer from collecting usage data.
    os.execve(viewer, [str(viewer), str(recording)], os.environ | {"CI": "1"})


def _serve(recording: Path, browser: bool) -> None:
    from gz_course.grader.errors import UsageError
    from gz_course.sim.show.rviz2.page import open_browser, until_ctrl_c
    from gz_course.sim.show.rviz2.viewer import FileServer, Viewer, ViewerError

    try:
        with Viewer(web=True) as viewer, FileServer(recording) as server:
            open_browser(viewer.address_of(server.url), wanted=browser)
            until_ctrl_c(viewer)
    except ViewerError as error:
        raise UsageError(str(error)) from None
