"""The packages that bring actions and substitutions of launch files."""

from __future__ import annotations

import contextlib

EXTENSIONS = ("launch_ros",)  # ours, loaded when a file is


def load_foreign_extensions() -> None:
    """Load what other installed packages bring, as ROS 2's launch does at every start."""
    from importlib.metadata import entry_points

    for each in entry_points(group="launch.frontend.launch_extension"):
        if each.name not in EXTENSIONS:
            with contextlib.suppress(ImportError):
                each.load()
