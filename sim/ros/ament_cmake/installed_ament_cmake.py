"""Whether the real ament_cmake can build packages here.

Source: find_package, https://cmake.org/cmake/help/latest/command/find_package.html
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path

from gz_course.sim.ros.rosidl.packages import prefixes

_CONFIG = "share/ament_cmake/cmake/ament_cmakeConfig.cmake"


def ament_cmake_is_installed() -> bool:
    """Whether CMake is on the path, and ament_cmake in a prefix of AMENT_PREFIX_PATH or CMAKE_PREFIX_PATH."""
    if not cmake_is_installed():
        return False
    more = os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep)
    return any(Path(prefix, _CONFIG).is_file() for prefix in (*prefixes(), *more) if prefix)


def cmake_is_installed() -> bool:
    """Whether CMake is on the path."""
    return shutil.which(os.environ.get("CMAKE_COMMAND") or "cmake") is not None
