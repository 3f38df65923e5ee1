"""Does for every Python of this environment what `source setup.bash` does on a full install.

This folder is an ament prefix: `share/ament_index` names the packages, `share/<package>` holds their files,
`lib/<package>` their executables. `gz_ros2_course_prefix.pth` calls `main` whenever Python starts, so that
`ros2 run`, `get_package_share_directory` and launch files find them in scripts, kernels and tests alike. What
the user has set comes first: a sourced workspace wins. Only `os` and `sys` are imported: every start pays for it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import MutableMapping

PREFIX = os.path.dirname(os.path.abspath(__file__))  # noqa: PTH100, PTH120 - pathlib would slow every start
WHEELS_GUARD = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
LIBRARY_PATH = "LD_LIBRARY_PATH"


def main() -> None:
    """Set up this process and its children, and leave no trace among the imported modules."""
    source(os.environ)
    # A student's own module of these names must be found, not this one.
    for name in (__name__, __name__.rpartition(".")[0]):
        sys.modules.pop(name, None)


def source(environment: MutableMapping[str, str]) -> None:
    """Add the course's prefix, that of the ROS wheels and the commands behind what is there; repeatable.

    AMENT_PREFIX_PATH and PATH only grow at their end. COURSE_PYTHON is the Python that runs this: the
    executables in `lib` start with it.
    """
    _append(environment, "AMENT_PREFIX_PATH", PREFIX)
    _append(environment, "AMENT_PREFIX_PATH", sys.prefix)
    if sys.executable:
        environment["COURSE_PYTHON"] = sys.executable
        _append(environment, "PATH", os.path.dirname(sys.executable), unset=os.defpath)  # noqa: PTH120
    drop_stale_guard(environment)


def drop_stale_guard(environment: MutableMapping[str, str]) -> None:
    """Forget that the ROS wheels have set LD_LIBRARY_PATH when it does not hold their libraries any more.

    The wheels restart Python once to set it and leave a guard variable behind. Where only the guard survives (a
    cleaned environment, another environment's Python), `import rclpy` fails; without the guard the wheels,
    whose `.pth` file comes after this one, set it again.
    """
    libraries = environment.get(LIBRARY_PATH, "").split(os.pathsep)
    if WHEELS_GUARD in environment and os.path.join(sys.prefix, "lib") not in libraries:  # noqa: PTH118
        del environment[WHEELS_GUARD]


def _append(environment: MutableMapping[str, str], name: str, folder: str, unset: str = "") -> None:
    value = environment.get(name, unset)
    if folder not in value.split(os.pathsep):
        environment[name] = f"{value}{os.pathsep}{folder}" if value else folder
