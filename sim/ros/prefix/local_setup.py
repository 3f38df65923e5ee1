"""The environment that `source setup.bash` sets up on a full install, for every Python of this environment.

This folder is an ament prefix: `share/ament_index` names the packages, `share/<package>` holds their files,
`lib/<package>` their executables. `sim/ros/interfaces` is another one, of packages with interfaces only.
`gz_ros2_course_prefix.pth` calls `main` whenever Python starts, so that `ros2 run`, `get_package_share_directory` and
launch files find them, and interfaces can be imported. A workspace that the user has sourced comes first. Only `os` and
`sys` are imported, because this runs at every start of Python.

Source: README.md of ament_index_python, https://github.com/ament/ament_index
Source: REP-122, https://www.ros.org/reps/rep-0122.html
"""

from __future__ import annotations

import os
import sys
from collections.abc import MutableMapping

from gz_course.sim.ros.prefix import missing_packages
from gz_course.sim.ros.rosidl import import_hook
from gz_course.sim.ros.rosidl.packages import BUILT_IN

PREFIX = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120 - pathlib would slow every start
WHEELS_GUARD = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
LIBRARY_PATH = "LD_LIBRARY_PATH"


def main() -> None:
    """Set up the environment of this process, which its children inherit."""
    source(os.environ)
    import_hook.install()
    missing_packages.install()
    # The user may have modules of these names.
    for name in (__name__, __name__.rpartition(".")[0]):
        sys.modules.pop(name, None)


def source(environment: MutableMapping[str, str]) -> None:
    """Append the prefix of the course, that of the ROS wheels, that of the interfaces and the folder of the commands;
    calling it again adds nothing.

    They are appended to AMENT_PREFIX_PATH and PATH. COURSE_PYTHON is set to the running Python, which the executables
    in `lib` start.
    """
    _append(environment, "AMENT_PREFIX_PATH", PREFIX)
    _append(environment, "AMENT_PREFIX_PATH", sys.prefix)
    _append(environment, "AMENT_PREFIX_PATH", BUILT_IN)
    if sys.executable:
        environment["COURSE_PYTHON"] = sys.executable
        _append(environment, "PATH", os.path.dirname(sys.executable), unset=os.defpath)  # noqa: PTH120
    drop_stale_guard(environment)


def drop_stale_guard(environment: MutableMapping[str, str]) -> None:
    """Delete the guard variable of the ROS wheels if LD_LIBRARY_PATH does not hold their libraries.

    The wheels restart Python once to set LD_LIBRARY_PATH, and set the guard. If only the guard is left (a cleaned
    environment, another environment's Python), `import rclpy` fails. Without the guard the wheels, whose `.pth` file
    comes after this one, set LD_LIBRARY_PATH again.
    """
    libraries = environment.get(LIBRARY_PATH, "").split(os.pathsep)
    if WHEELS_GUARD in environment and os.path.join(sys.prefix, "lib") not in libraries:  # noqa: PTH118
        del environment[WHEELS_GUARD]


def _append(environment: MutableMapping[str, str], name: str, folder: str, unset: str = "") -> None:
    value = environment.get(name, unset)
    if folder not in value.split(os.pathsep):
        environment[name] = f"{value}{os.pathsep}{folder}" if value else folder
