"""The action that starts Gazebo's server: `GzServer`, `<gz_server>`.

Source: ros_gz_sim/ros_gz_sim/actions/gzserver.py, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch_ros.launch_file_action import LaunchFileAction


@expose_action("gz_server")
class GzServer(LaunchFileAction):
    """Starts a server with the world `world_sdf_file`, or with that of the text `world_sdf_string`."""

    package, file = "ros_gz_sim", "gz_server.launch.py"
    arguments: ClassVar[Mapping[str, str | None]] = {
        "world_sdf_file": "",
        "world_sdf_string": "",
        "container_name": "ros_gz_container",
        "create_own_container": "False",
        "use_composition": "False",
        "initial_sim_time": "0.0",
        "verbosity_level": "1",
    }
