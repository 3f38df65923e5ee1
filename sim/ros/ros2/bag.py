"""What the verbs of `ros2 bag` have in common: options for input bags, and how errors and warnings are shown."""

from __future__ import annotations

import argparse
import contextlib
import datetime
import sys
from collections.abc import Iterator
from pathlib import Path

from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.bag import SUFFIXES, Bag


def add_bag_path(parser: argparse.ArgumentParser) -> None:
    """Add the arguments for one input bag."""
    parser.add_argument("bag_path", type=Path, help="Bag to open: a folder, or one of its files")
    parser.add_argument(
        "-s", "--storage", choices=["", *SUFFIXES], default="", help="Accepted and ignored: the files tell it"
    )


def default_folder() -> Path:
    """Return the name of a new bag in the working directory."""
    return Path(datetime.datetime.now().strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))


@contextlib.contextmanager
def bag_errors() -> Iterator[None]:
    """Turn what is wrong with a bag into the error of a command."""
    try:
        yield
    except BagError as error:
        raise CommandError(f"[ERROR] [ros2bag]: {error}") from None


def opened(path: Path) -> Bag:
    """Return a bag, and say what is wrong with it. Raises BagError."""
    bag = Bag(path)
    for sentence in bag.complaints:
        warn(sentence)
    return bag


def warn(sentence: str) -> None:
    print(f"[WARN] [ros2bag]: {sentence}", file=sys.stderr)
