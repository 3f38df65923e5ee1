"""The program `ros2 run ros_gz_bridge bridge_types`, which prints the type pairs of the bridge, one per line.

Pairs of ROS packages that are not installed are omitted; standard error names these packages.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable, Sequence

from gz_course.sim.bridge.ros_gz_bridge.type_pairs import (
    TypePair,
    UnknownPairError,
    canonical_gz_type,
    missing_packages,
    need_package,
    pairs,
)
from gz_course.sim.did_you_mean import nearest_name
from gz_course.sim.terminal_text import guard


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the requested types; return 0, 1 for a type without a partner, or 2 for wrong arguments."""
    if arguments is None:
        guard()
    parser = argparse.ArgumentParser(
        prog="bridge_types", description="Says which message types the bridge converts into which."
    )
    asked = parser.add_mutually_exclusive_group(required=True)
    asked.add_argument("--print-pairs", action="store_true", help="every ROS type with its Gazebo type")
    asked.add_argument("--print-gz", action="store_true", help="every Gazebo type that can be bridged")
    asked.add_argument("--print-ros", action="store_true", help="every ROS type that can be bridged")
    asked.add_argument("--get-gz-to-ros", metavar="GZ_TYPE", help="the ROS types of a Gazebo type, all of them")
    asked.add_argument("--get-ros-to-gz", metavar="ROS_TYPE", help="the Gazebo types of a ROS type, all of them")
    chosen = parser.parse_args(arguments)
    try:
        _print(_answer(chosen))
    except UnknownPairError as error:
        print(f"bridge_types: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:  # the reader, such as `head`, has ended
        # The text in the buffer would fail again when the interpreter ends.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    return 0


def _answer(chosen: argparse.Namespace) -> list[str]:
    """Return the lines to print. Raises UnknownPairError for a type without partner."""
    known = pairs()
    if chosen.get_gz_to_ros is not None:
        return _partners_of_gz(known, canonical_gz_type(chosen.get_gz_to_ros))
    if chosen.get_ros_to_gz is not None:
        return _partners_of_ros(known, chosen.get_ros_to_gz)
    if absent := missing_packages():
        print(f"bridge_types: left out, as these ROS packages are not installed: {', '.join(absent)}", file=sys.stderr)
    if chosen.print_pairs:
        width = max(len(pair.ros_type) for pair in known)
        return [f"{pair.ros_type:<{width}}  {pair.gz_type}" for pair in known]
    return sorted({pair.gz_type if chosen.print_gz else pair.ros_type for pair in known})


def _partners_of_gz(known: list[TypePair], gz_type: str) -> list[str]:
    partners = [pair.ros_type for pair in known if pair.gz_type == gz_type]
    if not partners:
        hint = nearest_name(gz_type, (pair.gz_type for pair in known), 0.0)
        absent = ", ".join(missing_packages())
        also = f" (a ROS package that is not installed may have one: {absent})" if absent else ""
        raise UnknownPairError(f"no ROS type is known for {gz_type}{also}; the nearest Gazebo type is {hint}")
    return partners


def _partners_of_ros(known: list[TypePair], ros_type: str) -> list[str]:
    need_package(ros_type)
    partners = [pair.gz_type for pair in known if pair.ros_type == ros_type]
    if not partners:
        hint = nearest_name(ros_type, (pair.ros_type for pair in known), 0.0)
        raise UnknownPairError(f"no Gazebo type is known for {ros_type}; the nearest ROS type is {hint}")
    return partners


def _print(lines: Iterable[str]) -> None:
    for line in lines:
        print(line)
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main())
