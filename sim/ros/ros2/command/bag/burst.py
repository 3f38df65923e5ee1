"""Burst data from a bag."""

from __future__ import annotations

import argparse
import threading

from gz_course.sim.ros.ros2.command.bag import play
from gz_course.sim.ros.ros2.option_values import whole_number
from gz_course.sim.ros.rosbag2.playing.player import Player


def add_arguments(parser: argparse.ArgumentParser) -> None:
    play.add_arguments(parser)
    parser.add_argument(
        "-n", "--num-messages", type=whole_number, default=0, metavar="N",
        help="Messages to play at once, before playing is paused; default: all",
    )  # fmt: skip


def main(arguments: argparse.Namespace) -> int:
    """Play messages without waiting between them, then wait paused until interrupted or resumed; return 0."""
    arguments.start_paused = True

    def burst(player: Player) -> None:
        threading.Thread(target=player.play_next, args=[arguments.num_messages], name="burst", daemon=True).start()
        player.play()

    return play.run(arguments, burst)
