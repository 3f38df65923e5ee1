"""Output a list of package specific executables."""

from __future__ import annotations

import argparse

from gz_course.sim.ros.ros2.packages import executables, package_names


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", nargs="?", help="The package name (default: all packages)")
    parser.add_argument("--full-path", action="store_true", help="Show the full path of the executable")


def main(arguments: argparse.Namespace) -> None:
    packages = [arguments.package_name] if arguments.package_name else package_names()
    for package in packages:
        for path in executables(package, unknown=f"Package '{package}' not found"):
            print(path if arguments.full_path else f"{package} {path.name}")
