"""The machines that the course runs on: Linux on x86-64 with glibc, and the CPythons that rclpy has wheels for.

On any other machine `pip install` installs this package without its dependencies (the marker in `pyproject.toml`), and
the commands print one sentence. `make` runs this file as a script before it makes an environment. So this file, and
`public/gz_course/__init__.py`, use only what Python 3.6 has.

Source: PEP 600, manylinux_2_28 (the tag of the wheels of rclpy, pyarrow and rerun-sdk)
"""

import os
import platform
import sys

OLDEST, NEWEST = (3, 11), (3, 14)
GLIBC = (2, 28)
WANTED = "Linux on x86-64 with glibc 2.28 or newer, and CPython 3.11 to 3.14"
GUIDE = "docs/windows_and_mac.md"
USAGE_ERROR = 2


def what_is_wrong(system: str, machine: str, glibc: tuple, python: str, version: tuple) -> str:
    """Return what the course does not run on, in words; empty if it runs.

    `system`, `machine` and `python` are as `platform` names them, `glibc` is empty for another C library.
    """
    if system != "Linux":
        return "macOS" if system == "Darwin" else system
    if machine != "x86_64":
        return f"Linux on {machine}"
    if glibc < GLIBC:
        return f"Linux with glibc {glibc[0]}.{glibc[1]}" if glibc else "Linux without glibc (musl)"
    if python != "CPython" or not OLDEST <= version <= NEWEST:
        return f"{python.replace('CPython', 'Python')} {version[0]}.{version[1]}"
    return ""


def require(command: str) -> None:
    """End this process with one sentence and exit code 2 if the course does not run on this machine."""
    python = platform.python_implementation()
    if "t" in getattr(sys, "abiflags", ""):
        python = "free-threaded " + python
    wrong = what_is_wrong(platform.system(), platform.machine(), _glibc(), python, sys.version_info[:2])
    if wrong:
        sys.stderr.write(f"{command}: the course does not run on {wrong}: it needs {WANTED}; see {_guide()}\n")
        sys.exit(USAGE_ERROR)


def _glibc() -> tuple:
    try:
        number = (os.confstr("CS_GNU_LIBC_VERSION") or "").split()[-1]
        return tuple(int(part) for part in number.split(".")[:2])
    except (AttributeError, IndexError, OSError, ValueError):  # another system or C library
        return ()


def _guide() -> str:
    """Return the path of the page that says where to go: in a checkout, or in the installed package."""
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))  # noqa: PTH100, PTH120
    return os.path.join(root, *GUIDE.split("/"))  # noqa: PTH118


def gz() -> int:
    """Run `gz`."""
    require("gz")
    from gz_course.sim.gz.command import main

    return main()


def ros2() -> int:
    """Run `ros2`."""
    require("ros2")
    from gz_course.sim.ros.ros2.command_line import main

    return main()


if __name__ == "__main__":
    require("make")
