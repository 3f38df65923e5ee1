"""The versions of everything that grades: part of a job's key, and equal on all Dask workers."""

from __future__ import annotations

import sys
from importlib.metadata import PackageNotFoundError, version

PACKAGES = ("gz-ros2-course", "mujoco", "ros-jazzy-rclpy", "rerun-sdk")


def versions() -> dict[str, str]:
    """Return package -> version of everything that could change a score."""
    found = {"python": ".".join(map(str, sys.version_info[:2]))}
    for package in PACKAGES:
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "missing"
    return found
