"""Run a package specific executable."""

from __future__ import annotations

import argparse
import shlex
import signal

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.child import ChildError, run_child
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.packages import executables


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--prefix", help="Command (may hold arguments) to start the executable with, e.g. --prefix 'gdb --args'"
    )
    parser.add_argument("package_name", help="Name of the ROS package")
    parser.add_argument("executable_name", help="Name of the executable")
    rest = parser.add_argument("argv", nargs=argparse.REMAINDER, help="Pass arbitrary arguments to the executable")
    rest.required = False


def main(arguments: argparse.Namespace) -> int:
    """Return the exit code of the executable, or 256 - n after signal n."""
    package, name = arguments.package_name, arguments.executable_name
    known = executables(package, unknown=f"Package '{package}' not found")
    paths = [path for path in known if path.name == name]
    if not paths:
        raise CommandError("No executable found" + did_you_mean(name, (path.name for path in known)))
    if len(paths) > 1:
        raise CommandError("\n- ".join(["Multiple executables found:", *map(str, paths)]))
    try:
        code = run_child([*shlex.split(arguments.prefix or ""), str(paths[0]), *arguments.argv])
    except ChildError as error:
        raise CommandError(f"[ros2run]: {error}") from None
    if code < 0:
        print(f"[ros2run]: {signal.strsignal(-code)}")
    elif code > 0:
        print(f"[ros2run]: Process exited with failure {code}")
    return code % 256
