"""Hands over to a real `ros2` if a ROS 2 installation is set up in this shell.

A sourced ROS 2 is in AMENT_PREFIX_PATH; its `ros2` replaces this process. One that is installed in this Python
environment is called as a library.
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

# Both or none: the guard without the libraries, or libraries of two installations, break rclpy.
_WHEELS_GUARD = "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
_LIBRARY_PATH = "LD_LIBRARY_PATH"


def hand_over(arguments: Sequence[str]) -> int | None:
    """Run a real `ros2` with these arguments; return its exit code, or None if there is none.

    Does not return if a sourced ROS 2 takes over.
    """
    program = sourced_ros2(os.environ)
    if program is not None:
        os.execve(program, [str(program), *arguments], environment_without_wheels(os.environ))
    entry_point = installed_ros2()
    return None if entry_point is None else entry_point(list(arguments))


def sourced_ros2(environment: Mapping[str, str]) -> Path | None:
    """Return the `ros2` of the first ament prefix outside this environment that has the package ros2cli."""
    own = Path(sys.prefix).resolve()
    for folder in environment.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        prefix = Path(folder)
        program = prefix / "bin" / "ros2"
        marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / "ros2cli"
        if folder and prefix.resolve() != own and marker.exists() and os.access(program, os.X_OK):
            return program
    return None


def installed_ros2() -> Callable[[list[str]], int] | None:
    """Return the entry point of a real `ros2` in this Python environment, None if there is none."""
    if importlib.util.find_spec("ros2cli") is None:
        return None
    main = importlib.import_module("ros2cli.cli").main

    def run(arguments: list[str]) -> int:
        return main(argv=arguments) or 0

    return run


def environment_without_wheels(environment: Mapping[str, str]) -> dict[str, str]:
    """Return a copy without the libraries of this environment's ROS wheels, and without their guard."""
    copy = dict(environment)
    copy.pop(_WHEELS_GUARD, None)
    own = Path(sys.prefix).resolve()
    libraries = [
        part
        for part in copy.pop(_LIBRARY_PATH, "").split(os.pathsep)
        if part and not Path(part).resolve().is_relative_to(own)
    ]
    if libraries:
        copy[_LIBRARY_PATH] = os.pathsep.join(libraries)
    return copy
