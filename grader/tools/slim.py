"""Removes from this environment what grading never opens: `python -m gz_course.grader.tools.slim`.

rerun-sdk and pyarrow are one wheel each, and pip installs a wheel whole: Rerun's viewer alone has 290 MB. For images in
which classes are graded. What is left grades, scores and writes all reports; `course show`, `course watch` and `ros2
run rviz2 rviz2` say that there is no viewer. `pip install --force-reinstall rerun-sdk pyarrow` brings all back.
"""

from __future__ import annotations

import importlib.util
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path

UNUSED = {
    "rerun_cli": ("rerun",),  # the viewer
    "pyarrow": (
        "libarrow_flight*",  # Arrow over the network
        "_flight*",
        "_substrait*",  # plans of queries
        "libarrow_s3*",  # files in the cloud
        "_s3fs*",
        "_gcsfs*",
        "_azurefs*",
        "include",  # for programs in C++
        "tests",
    ),
    "zstandard": ("_cffi*",),  # for Pythons that cannot use backend_c
    "mujoco": ("studio",),  # the live view
    "numpy": ("**/tests",),
    "OpenGL": ("*",),  # MuJoCo's renderer; pictures of recordings come from the course's own ray caster
}


def unused() -> Iterator[Path]:
    """Yield the files and folders that can go, as far as they are installed."""
    for package, patterns in UNUSED.items():
        spec = importlib.util.find_spec(package)
        for folder in (spec.submodule_search_locations or []) if spec else []:
            for pattern in patterns:
                yield from Path(folder).glob(pattern)
    if sys.prefix != sys.base_prefix:  # a virtual environment: its headers are those of the ROS wheels, for C++
        yield from (path for path in Path(sys.prefix).glob("include/*") if not path.name.startswith("python"))


def main() -> None:
    """Remove them, and print how much that was."""
    freed = 0
    for path in list(unused()):
        files = [each for each in path.rglob("*") if each.is_file()] if path.is_dir() else [path]
        freed += sum(each.stat().st_size for each in files)
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    print(f"{freed / 1e6:.0f} MB removed; grading needs none of it.")


if __name__ == "__main__":
    main()
