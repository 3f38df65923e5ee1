"""The known ROS packages and their executables, read from the ament index.

A package is in the first prefix of AMENT_PREFIX_PATH that contains it; its executables are all executable files below
`<prefix>/lib/<package>`.
"""

from __future__ import annotations

import os
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_prefix, get_packages_with_prefixes

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError


def package_names() -> list[str]:
    return sorted(get_packages_with_prefixes())


def package_prefix(package: str, unknown: str = "Package not found") -> Path:
    """Return the prefix of a package. Raises CommandError with the sentence `unknown` if it is not installed."""
    try:
        return Path(get_package_prefix(package))
    except (PackageNotFoundError, ValueError):
        raise CommandError(unknown + did_you_mean(package, package_names())) from None


def package_share(package: str) -> Path:
    """Return the folder with a package's shared files (package.xml, launch files)."""
    return package_prefix(package) / "share" / package


def executables(package: str, unknown: str = "Package not found") -> list[Path]:
    """Return the executable files of a package, sorted by path."""
    folder = package_prefix(package, unknown) / "lib" / package
    found = []
    for root, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        paths = [Path(root, name) for name in sorted(names)]
        found += [path for path in paths if path.is_file() and os.access(path, os.X_OK)]
    return found
