"""Run a launch file."""

from __future__ import annotations

import argparse
import os
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.error_text import named
from gz_course.sim.ros.ros2.errors import CommandError, UsageError
from gz_course.sim.ros.ros2.packages import package_names

if TYPE_CHECKING:
    from gz_course.sim.ros.launch import LaunchDescription

_LAUNCH_FILE = re.compile(r".*[._-]?launch\.(py|xml|yaml|yml)$|.*\.launch$")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-n", "--noninteractive", action="store_true", help="Nobody is at a terminal")
    parser.add_argument("-d", "--debug", action="store_true", help="Log what happens in detail, with tracebacks")
    what = parser.add_mutually_exclusive_group()
    what.add_argument(
        "-p", "--print", "--print-description", dest="print_description", action="store_true",
        help="Print what the launch file holds instead of running it",
    )  # fmt: skip
    what.add_argument(
        "-s", "--show-args", "--show-arguments", dest="show_arguments", action="store_true",
        help="Show the arguments of the launch file instead of running it",
    )  # fmt: skip
    parser.add_argument(
        "-a", "--show-all-subprocesses-output", dest="show_all", action="store_true",
        help="Show everything that processes print, whatever the launch file says",
    )  # fmt: skip
    parser.add_argument("--launch-prefix", help="Command (may hold arguments) to start every process with")
    parser.add_argument(
        "--launch-prefix-filter", metavar="REGEX", help="Use --launch-prefix only for executables whose name matches"
    )
    parser.add_argument("package_name", help="Name of the ROS package which contains the launch file, or its path")
    parser.add_argument("launch_file_name", nargs="?", help="Name of the launch file; omit after a path")
    parser.add_argument(
        "launch_arguments", nargs="*", default=[], help="Arguments to the launch file; '<name>:=<value>'"
    )


def main(arguments: argparse.Namespace) -> int:
    """Return 0 at the end of the launch, regardless of the exit codes of its processes; 1 if the launch itself
    failed.
    """
    path, words = launch_file(arguments)
    pairs = _pairs(words)
    if arguments.launch_prefix_filter and not arguments.launch_prefix:
        raise UsageError(
            "the following arguments are required: --launch-prefix, which --launch-prefix-filter restricts"
        )
    if arguments.show_arguments:
        return _show_arguments(path)
    if arguments.print_description:
        return _print_description(path)
    if arguments.show_all:
        os.environ["OVERRIDE_LAUNCH_PROCESS_OUTPUT"] = "both"
    # Python programs would buffer their output, which goes into a pipe.
    os.environ.setdefault("PYTHONUNBUFFERED", "1")
    return _run(path, pairs, arguments)


def launch_file(arguments: argparse.Namespace) -> tuple[str, list[str]]:
    """Return the path of the launch file, and the words that are its arguments."""
    package, name = arguments.package_name, arguments.launch_file_name
    words = list(arguments.launch_arguments)
    if Path(package).is_file():
        return package, [*([name] if name is not None else []), *words]
    if name is None or ":=" in name:
        if "/" in package or package.endswith((".py", ".xml", ".yaml", ".yml", ".launch")):
            raise CommandError(f"there is no launch file '{package}'{_nearest_file(Path(package))}")
        files = launch_files_of(package) if package in package_names() else {}
        known = f"; '{package}' has {', '.join(sorted(files))}" if files else did_you_mean(package, package_names())
        raise UsageError(f"the following arguments are required: launch_file_name{known}")
    return _file_of_package(package, name), words


def _file_of_package(package: str, name: str) -> str:
    from ament_index_python.packages import PackageNotFoundError, get_package_prefix

    try:
        share = Path(get_package_prefix(package)) / "share" / package
    except (PackageNotFoundError, ValueError) as error:
        raise CommandError(
            f"Package '{package}' not found: \"{error.args[0]}\"{did_you_mean(package, package_names())}"
        ) from None
    found = [path for path in sorted(share.rglob(name)) if path.is_file()] if _is_plain(name) else []
    if not found and (share / name).is_file():
        found = [share / name]
    if not found:
        hint = did_you_mean(name, launch_files_of(package))
        raise CommandError(
            f"file '{name}' was not found in the share directory of package '{package}' which is at '{share}'{hint}"
        )
    if len(found) > 1:
        raise CommandError(
            f"file '{name}' was found more than once in the share directory of package '{package}': "
            f"{[str(path) for path in found]}"
        )
    return str(found[0])


def _is_plain(name: str) -> bool:
    return not re.search(r"[/*?\[\]]", name) and name not in ("", ".", "..")


def launch_files_of(package: str) -> dict[str, Path]:
    """Return the paths of the launch files of an existing package, by file name."""
    from ament_index_python.packages import get_package_prefix

    share = Path(get_package_prefix(package)) / "share" / package
    return {path.name: path for path in share.rglob("*") if path.is_file() and _LAUNCH_FILE.fullmatch(path.name)}


def _nearest_file(path: Path) -> str:
    return did_you_mean(path.name, [each.name for each in path.parent.iterdir()]) if path.parent.is_dir() else ""


def _pairs(words: Sequence[str]) -> list[tuple[str, str]]:
    """Parse `name:=value` words into pairs; the last one of a name takes precedence."""
    pairs: dict[str, str] = {}
    for word in words:
        name, mark, value = word.partition(":=")
        # `a:=` is refused, but not `a:=b:=`: as ROS 2 counts the marks.
        if not mark or not name or (not value and word.count(":=") == 1):
            raise CommandError(f"malformed launch argument '{word}', expected format '<name>:=<value>'")
        pairs.pop(name, None)
        pairs[name] = value
    return list(pairs.items())


def load(path: str) -> LaunchDescription:
    """Return the launch description of a file. Raises CommandError if it cannot be loaded."""
    from gz_course.sim.ros.launch.launch_description_sources import get_launch_description_from_any_launch_file

    try:
        return get_launch_description_from_any_launch_file(path)
    except Exception as error:
        raise CommandError(_sentence(error)) from None


def _sentence(error: Exception) -> str:
    try:
        from gz_course.sim.ros.launch.errors import sentence
    except ImportError:  # a real launch
        return named(error)
    return sentence(error)


def _show_arguments(path: str) -> int:
    from gz_course.sim.ros.launch.launch_introspector import arguments_text

    print(arguments_text(load(path)))
    return 0


def _print_description(path: str) -> int:
    from gz_course.sim.ros.launch import LaunchIntrospector

    print(LaunchIntrospector().format_launch_description(load(path)))
    return 0


def _run(path: str, pairs: list[tuple[str, str]], arguments: argparse.Namespace) -> int:
    from gz_course.sim.ros import launch
    from gz_course.sim.ros.launch.actions import IncludeLaunchDescription, SetLaunchConfiguration
    from gz_course.sim.ros.launch.launch_description_sources import AnyLaunchDescriptionSource

    service = launch.LaunchService(
        argv=[f"{name}:={value}" for name, value in pairs],
        noninteractive=arguments.noninteractive or not _at_terminal(),
        debug=arguments.debug,
    )
    entities: list[Any] = []
    if arguments.launch_prefix:
        entities.append(SetLaunchConfiguration("launch-prefix", arguments.launch_prefix))
    if arguments.launch_prefix_filter:
        entities.append(SetLaunchConfiguration("launch-prefix-filter", arguments.launch_prefix_filter))
    entities.append(IncludeLaunchDescription(AnyLaunchDescriptionSource(path), launch_arguments=pairs))
    service.include_launch_description(launch.LaunchDescription(entities))
    return service.run()


def _at_terminal() -> bool:
    return sys.stdin is not None and sys.stdin.isatty()
