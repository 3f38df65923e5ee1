"""The action that starts the bridge: `RosGzBridge`, `<ros_gz_bridge>`.

Source: ros_gz_bridge/ros_gz_bridge/actions/ros_gz_bridge.py, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch_ros.launch_file_action import LaunchFileAction


@expose_action("ros_gz_bridge")
class RosGzBridge(LaunchFileAction):
    """Starts the bridge `bridge_name` with the YAML file `config_file`."""

    package, file = "ros_gz_bridge", "ros_gz_bridge.launch.py"
    arguments: ClassVar[Mapping[str, str | None]] = {
        "bridge_name": None,
        "config_file": None,
        "container_name": "ros_gz_container",
        "create_own_container": "False",
        "namespace": "",
        "use_composition": "False",
        "use_respawn": "False",
        "log_level": "info",
    }
