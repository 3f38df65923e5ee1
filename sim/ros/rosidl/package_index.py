"""Enters packages of interfaces into the ament index of their prefix, so that ROS tools and the import hook find them.

`python -m gz_course.sim.ros.rosidl.package_index PREFIX` does it for all packages in `PREFIX/share`.

Source: https://github.com/ament/ament_cmake/blob/jazzy/ament_cmake_core/doc/resource_index.md
"""

from __future__ import annotations

import sys
from pathlib import Path

from gz_course.sim.ros.rosidl.interface_text import KINDS
from gz_course.sim.ros.rosidl.packages import ALL, INDEX, MARKS


def interface_files(package: Path) -> list[str]:
    """Return the texts of a package as in the index: `msg/Name.msg`, sorted by kind and name."""
    return [f"{kind}/{path.name}" for kind in KINDS for path in sorted((package / kind).glob(f"*.{kind}"))]


def index_files(prefix: Path) -> dict[Path, str]:
    """Return the files of the index for all packages of a prefix that have interfaces: path -> content."""
    made: dict[Path, str] = {}
    for package in sorted((prefix / "share").iterdir()):
        if files := interface_files(package):
            content = {"packages": "", MARKS: "", ALL: "".join(f"{file}\n" for file in files)}
            made |= {prefix / INDEX / index / package.name: text for index, text in content.items()}
    return made


def write_index(prefix: Path) -> None:
    for path, text in index_files(prefix).items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write_index(Path(sys.argv[1]))
