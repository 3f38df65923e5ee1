"""`course show RECORDING`: look at a run in the Rerun viewer."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer


def command(recording: Annotated[Path, typer.Argument(help="The .rrd file a grading wrote.")]) -> None:
    """Open a recording in the Rerun viewer; the command ends when its window is closed."""
    import rerun_cli

    from gz_course.grader.record.reading import Recording

    Recording(recording)
    # Run the binary, not its Python wrapper, which would leave the viewer running when it is killed. CI=1 is the only
    # switch that keeps the viewer from collecting usage data.
    viewer = Path(rerun_cli.__file__).parent / "rerun"
    os.execve(viewer, [str(viewer), str(recording)], os.environ | {"CI": "1"})
