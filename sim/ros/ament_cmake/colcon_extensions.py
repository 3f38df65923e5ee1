"""Makes `colcon build` build packages of build type `ament_cmake` where the real ament_cmake is not installed.

The first extension gives such packages a type of their own, `ros.ament_cmake_without_cmake`; the others build and test
packages of this type. With CMake and ament_cmake in the environment they keep their type, and colcon-ros builds them.

Source: https://colcon.readthedocs.io/en/released/developer/extension-point.html
Source: colcon-ros 0.5 (`package_identification/ros.py`, `task/ament_cmake/build.py`)
"""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import Any

from colcon_core.environment import create_environment_scripts
from colcon_core.event.output import StderrLine
from colcon_core.shell import create_environment_hook
from colcon_core.task import TaskExtensionPoint
from colcon_ros.package_identification.ros import RosPackageIdentification

from gz_course.sim.ros.ament_cmake.installed_ament_cmake import ament_cmake_is_installed, cmake_is_installed
from gz_course.sim.ros.rosidl.packages import BUILT_IN, prefixes

_TYPE = "ros.ament_cmake"


def _concerns_user(record: logging.LogRecord) -> bool:
    """Whether a warning about AMENT_PREFIX_PATH is not about the prefixes that every Python here finds by itself."""
    return not any(f"'{prefix}'" in record.getMessage() for prefix in (sys.prefix, BUILT_IN))


logging.getLogger("colcon.colcon_ros.prefix_path.ament").addFilter(_concerns_user)


def _cannot_be_built() -> set[str]:
    """Return the types of packages whose build would end in an error of CMake's; ours is one sentence."""
    return {"ros.catkin"} | (set() if cmake_is_installed() else {"ros.cmake"})


class WithoutCMakeIdentification(RosPackageIdentification):
    """Identify ROS packages of build type `ament_cmake`, and those nobody can build here, without ament_cmake."""

    PRIORITY = RosPackageIdentification.PRIORITY + 5

    def identify(self, desc: Any) -> None:
        if desc.type not in (None, "ros", _TYPE) or ament_cmake_is_installed():
            return
        found = type(desc)(desc.path)
        super().identify(found)
        if _TYPE in (found.type, desc.type) or found.type in _cannot_be_built():
            desc.type = f"{_TYPE}_without_cmake"
            desc.name = desc.name or found.name


class WithoutCMakeBuildTask(TaskExtensionPoint):
    """Build packages of build type `ament_cmake` without CMake."""

    async def build(self) -> int:
        from gz_course.sim.ros.ament_cmake.build import Package, build

        args, name = self.context.args, self.context.pkg.name
        base = Path(args.install_base)
        package = Package(Path(args.path), Path(args.build_base), base, args.symlink_install)
        before = [Path(path) for path in self.context.dependencies.values()]
        others = [Path(path) for path in prefixes() if Path(path) != base or base in before]
        built = build(package, [*before, *others])
        for sentence in (*built.remarks, *built.faults):
            # Not `self.print`, which sends `str`: the handler of colcon-output fails at it.
            self.context.put_event_into_queue(StderrLine(f"{sentence}\n".encode()))
        if built.faults:
            return 1
        hooks = create_environment_hook("ament_prefix_path", base, name, "AMENT_PREFIX_PATH", "", mode="prepend")
        create_environment_scripts(self.context.pkg, args, additional_hooks=[*hooks, *built.hooks])
        return 0


class WithoutCMakeTestTask(TaskExtensionPoint):
    """Say that the tests of a package of build type `ament_cmake` need CMake."""

    async def test(self) -> int:
        sentence = f"no test of {self.context.pkg.name} was run: CMake and ament_cmake run them, which are not here"
        self.context.put_event_into_queue(StderrLine(f"{sentence}\n".encode()))
        return 0
