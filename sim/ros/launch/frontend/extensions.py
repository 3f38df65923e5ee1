"""The packages that bring actions and substitutions of launch files."""

from __future__ import annotations

import contextlib

# Ours, loaded when a file is.
EXTENSIONS = {
    "launch_ros": "gz_course.sim.ros.launch_ros",
    "ros_gz_sim": "gz_course.sim.bridge.ros_gz_sim.actions",
    "ros_gz_bridge": "gz_course.sim.bridge.ros_gz_bridge.actions",
}


def load_foreign_extensions() -> None:
    """Load what other installed packages bring, as ROS 2's launch does at every start."""
    from importlib.metadata import entry_points

    for each in entry_points(group="launch.frontend.launch_extension"):
        if each.name not in EXTENSIONS:
            with contextlib.suppress(ImportError):
                each.load()
