"""The action that creates a model in a running world: `GzSpawnModel`, `<gz_spawn_model>`.

Source: ros_gz_sim/ros_gz_sim/actions/gz_spawn_model.py, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch_ros.launch_file_action import LaunchFileAction

_TEXTS = ("world", "file", "model_string", "topic", "entity_name")
_POSE = ("x", "y", "z", "roll", "pitch", "yaw")


@expose_action("gz_spawn_model")
class GzSpawnModel(LaunchFileAction):
    """Creates the model of a `file`, of the text `model_string`, or of a `topic`, at a pose [m, rad]."""

    package, file = "ros_gz_sim", "gz_spawn_model.launch.py"
    arguments: ClassVar[Mapping[str, str | None]] = {
        **dict.fromkeys(_TEXTS, ""),
        "allow_renaming": "False",
        **dict.fromkeys(_POSE, "0.0"),
    }
    called: ClassVar[Mapping[str, str]] = {"roll": "R", "pitch": "P", "yaw": "Y"}
