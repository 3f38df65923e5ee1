"""Play back ROS data from a bag."""

from __future__ import annotations

import argparse
import contextlib
import gc
import os
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

from gz_course.sim.ros.ros2 import interruption
from gz_course.sim.ros.ros2.bag import add_bag_path, bag_errors, opened
from gz_course.sim.ros.ros2.errors import UsageError
from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.option_values import positive_number, rate, seconds, whole_number
from gz_course.sim.ros.ros_program.shared_memory import segment_for_images
from gz_course.sim.ros.rosbag2 import keys
from gz_course.sim.ros.rosbag2.playing.player import Player, PlayOptions
from gz_course.sim.ros.rosbag2.playing.service_requests import SOURCES
from gz_course.sim.ros.rosbag2.qos import overrides
from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS, Selection, absolute
from gz_course.sim.ros.rosbag2.services import offer_player
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.sim.ros.rosbag2.stored_types import StoredTypes

_DISCOVERY = 1.0  # [s] for subscribers to be found before the first message
_SWITCH_INTERVAL = 0.0005  # [s] for which another thread may keep the interpreter from the one that plays
_NANOSECONDS = 10**9


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add_bag_path(parser)
    add("-r", "--rate", type=rate, default=1.0, help="Rate at which to play back messages; above 0")
    add("-l", "--loop", action="store_true", help="Begin again at the end")
    add("-d", "--delay", type=seconds, default=0.0, metavar="SECONDS", help="Wait before play (each loop)")
    add("-p", "--start-paused", action="store_true", help="Start in a paused state")
    add("--start-offset", type=seconds, default=0.0, metavar="SECONDS", help="Begin so far into the bag")
    add("--playback-duration", type=float, default=-1.0, metavar="SECONDS", help="Play so much of the bag")
    add("--playback-until-sec", type=float, default=-1.0, metavar="SECONDS", help="Play up to this time of the bag")
    add("--playback-until-nsec", type=int, default=-1, metavar="NANOSECONDS", help="Play up to this time of the bag")
    add("--clock", type=rate, nargs="?", const=40.0, default=0.0, metavar="HZ", help="Publish /clock (default: 40 Hz)")
    add("--clock-topics", nargs="+", default=[], metavar="TOPIC", help="Publish /clock before messages of these topics")
    add("--clock-topics-all", action="store_true", help="Publish /clock before each message")
    add("--topics", nargs="+", default=[], metavar="TOPIC", help="Topics to replay; default: all")
    add("-e", "--regex", default="", help="Play topics whose name contains this regular expression")
    add("-x", "--exclude-regex", default="", help="Leave out topics whose name contains this regular expression")
    add("--exclude-topics", nargs="+", default=[], metavar="TOPIC", help="Topics to leave out")
    add("--services", nargs="+", default=[], metavar="SERVICE", help="Services whose events or requests are played")
    add("--exclude-services", nargs="+", default=[], metavar="SERVICE", help="Services to leave out")
    add("--publish-service-requests", action="store_true", help="Call services again instead of playing their events")
    add(
        "--service-requests-source",
        choices=SOURCES,
        default="service_introspection",
        help="Whose events hold the requests (default: service_introspection)",
    )
    add("-m", "--remap", nargs="+", default=[], metavar="OLD:=NEW", help="Publish topics under other names")
    add("--qos-profile-overrides-path", type=Path, metavar="FILE", help="YAML file: topic -> QoS profile to offer")
    add(
        "--read-ahead-queue-size",
        type=positive_number,
        default=1000,
        metavar="N",
        help="Messages read before their time",
    )
    add("--wait-for-all-acked", type=whole_number, metavar="MS", help="Wait at the end for subscribers; 0: for ever")
    add("--disable-keyboard-controls", action="store_true", help="Do not listen to the keys")
    add("--disable-loan-message", action="store_true", help="Accepted and ignored: messages are never loaned")
    add("--log-level", help="Accepted and ignored")


def main(arguments: argparse.Namespace) -> int:
    """Play to the end of the bag, or until interrupted; return 0."""
    return run(arguments, Player.play)


def run(arguments: argparse.Namespace, play: Callable[[Player], object]) -> int:
    """Open the bag, offer the services, listen to the keys, and call `play(player)`; return 0."""
    options = _options(arguments)
    with bag_errors(), contextlib.suppress(KeyboardInterrupt):
        bag = opened(arguments.bag_path)
        with StoredTypes(bag.definitions()) as types, _images_fit():
            _play(arguments, bag, options, types, play)
    return 0


def _play(
    arguments: argparse.Namespace,
    bag: Bag,
    options: PlayOptions,
    types: StoredTypes,
    play: Callable[[Player], object],
) -> None:
    place = argparse.Namespace(spin_time=None, use_sim_time=False)
    with Graph(place, node_name="rosbag2_player") as graph:
        player = Player(graph.node, bag, options, types.message_class)
        log = graph.node.get_logger()
        log.info(f"Set rate to {options.rate:g}")
        offer_player(graph.node, player)
        actions = {
            keys.SPACE: player.toggle,
            keys.RIGHT: lambda: void(player.play_next()),
            keys.UP: lambda: void(player.set_rate(player.rate * 1.1)),
            keys.DOWN: lambda: void(player.set_rate(player.rate * 0.9)),
        }
        with keys.keys({} if arguments.disable_keyboard_controls else actions) as heard:
            if heard and not arguments.disable_keyboard_controls:
                log.info("Press SPACE for Pause/Resume")
                log.info("Press CURSOR_RIGHT for Play Next Message")
                log.info("Press CURSOR_UP for Increase Rate 10%")
                log.info("Press CURSOR_DOWN for Decrease Rate 10%")
            graph.settle(_DISCOVERY)
            gc.freeze()  # looking through all that was imported takes longer than a message may be late
            sys.setswitchinterval(_SWITCH_INTERVAL)
            with _answering(graph):
                play(player)


def void(_: object) -> None:
    """Drop a result."""


@contextlib.contextmanager
def _answering(graph: Graph) -> Iterator[None]:
    """Answer requests in a thread inside the block."""
    ending = threading.Event()

    def spin() -> None:
        with contextlib.suppress(KeyboardInterrupt):  # the main thread has it, too
            while not ending.is_set():
                graph.spin_once(0.1)

    thread = threading.Thread(target=spin, name="services", daemon=True)
    thread.start()
    try:
        yield
    finally:
        interruption.ignore()
        ending.set()
        thread.join()


@contextlib.contextmanager
def _images_fit() -> Iterator[None]:
    """Send images through shared memory, unless the user has chosen how DDS sends."""
    with segment_for_images():
        if not any(os.environ.get(name) for name in ("FASTDDS_BUILTIN_TRANSPORTS", "FASTRTPS_DEFAULT_PROFILES_FILE")):
            os.environ["FASTDDS_BUILTIN_TRANSPORTS"] = "DEFAULT"
        yield


def _options(arguments: argparse.Namespace) -> PlayOptions:
    clock_topics = tuple(absolute(name) for name in arguments.clock_topics)
    names = tuple(absolute(name) for name in arguments.topics)
    names += tuple(absolute(name) + SERVICE_EVENTS for name in arguments.services)
    without = [absolute(name) for name in arguments.exclude_topics]
    without += [absolute(name) + SERVICE_EVENTS for name in arguments.exclude_services]
    until = max(0, arguments.playback_until_nsec, int(arguments.playback_until_sec * _NANOSECONDS))
    acknowledged = arguments.wait_for_all_acked
    with bag_errors():
        return PlayOptions(
            selection=Selection(
                all=not (names or arguments.regex),
                topics=names,
                regex=arguments.regex,
                without_regex=arguments.exclude_regex,
                without_topics=tuple(without),
            ),
            rate=arguments.rate,
            loop=arguments.loop,
            delay=arguments.delay,
            start_offset=int(arguments.start_offset * _NANOSECONDS),
            duration=max(0, int(arguments.playback_duration * _NANOSECONDS)),
            until=until,
            clock_hz=arguments.clock,
            clock_at=Selection(all=arguments.clock_topics_all, topics=clock_topics),
            paused=arguments.start_paused,
            read_ahead=arguments.read_ahead_queue_size,
            remapped=dict(_remapped(text) for text in arguments.remap),
            overrides=overrides(path) if (path := arguments.qos_profile_overrides_path) else {},
            requests_of=arguments.service_requests_source if arguments.publish_service_requests else "",
            acknowledged=None if acknowledged is None else acknowledged / 1000,
        )


def _remapped(text: str) -> tuple[str, str]:
    old, separator, new = text.partition(":=")
    if not separator or not old or not new:
        raise UsageError(f"--remap '{text}' is not of the form OLD:=NEW")
    return absolute(old), absolute(new)
