"""Record ROS data to a bag."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

from gz_course.sim.ros.ros2 import interruption
from gz_course.sim.ros.ros2.bag import bag_errors, default_folder, warn
from gz_course.sim.ros.ros2.errors import CommandError, UsageError
from gz_course.sim.ros.ros2.graph import Graph
from gz_course.sim.ros.ros2.option_values import positive_number, whole_number
from gz_course.sim.ros.ros_program.abandoned_segments import remove_abandoned_segments
from gz_course.sim.ros.rosbag2 import keys
from gz_course.sim.ros.rosbag2.qos import overrides
from gz_course.sim.ros.rosbag2.recording.recorder import Recorder, RecordOptions
from gz_course.sim.ros.rosbag2.recording.snapshot import SnapshotThread
from gz_course.sim.ros.rosbag2.recording.writing_thread import WritingThread
from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS, Selection, absolute
from gz_course.sim.ros.rosbag2.services import offer_recorder
from gz_course.sim.ros.rosbag2.storage.bag_writer import STORAGES, BagWriter
from gz_course.sim.ros.rosbag2.storage.compression import FORMAT, MODES
from gz_course.sim.ros.rosbag2.stored_types import installed_class

_PRESETS = sorted({preset for _, _, presets in STORAGES.values() for preset in presets})
_SMALLEST_SPLIT = 1024  # bytes
_ACTIONS = "--all-actions is not offered here: name the topics, such as `/NAME/_action/feedback`"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("topic_names", nargs="*", metavar="topic", help="Topics to record")
    add("--topics", nargs="+", default=[], metavar="TOPIC", help="Topics to record")
    add("-a", "--all", action="store_true", help="Record all topics and services (not hidden ones)")
    add("--all-topics", action="store_true", help="Record all topics (not hidden ones)")
    add("--all-services", action="store_true", help="Record the events of all services that are introspected")
    add("--services", nargs="+", default=[], metavar="SERVICE", help="Services whose events are recorded")
    add("--topic-types", nargs="+", default=[], metavar="TYPE", help="Types whose topics are recorded")
    add("-e", "--regex", default="", help="Record topics whose name contains this regular expression")
    add("-x", "--exclude-regex", default="", help="Leave out topics whose name contains this regular expression")
    add("--exclude-topics", nargs="+", default=[], metavar="TOPIC", help="Topics to leave out")
    add("--exclude-topic-types", nargs="+", default=[], metavar="TYPE", help="Types whose topics are left out")
    add("--exclude-services", nargs="+", default=[], metavar="SERVICE", help="Services to leave out")
    add("-o", "--output", type=Path, help="Folder to create; default: a name with the time of the day")
    add("-s", "--storage", choices=STORAGES, default="mcap", help="Storage of the bag (default: mcap)")
    add("-f", "--serialization-format", choices=["", "cdr"], default="", help="Only cdr")
    add("--include-unpublished-topics", action="store_true", help="Also topics that nobody publishes")
    add("--include-hidden-topics", action="store_true", help="Also topics with a part that begins with _")
    add("--ignore-leaf-topics", action="store_true", help="Leave out topics that nobody subscribes to")
    add("--no-discovery", action="store_true", help="Record only topics that are there at the start")
    add(
        "-p", "--polling-interval", type=positive_number, default=100, metavar="MS", help="Between looks for new topics"
    )
    add("--qos-profile-overrides-path", type=Path, metavar="FILE", help="YAML file: topic -> QoS profile to ask for")
    add("-b", "--max-bag-size", type=whole_number, default=0, metavar="BYTES", help="Size at which a new file begins")
    add("-d", "--max-bag-duration", type=whole_number, default=0, metavar="SECONDS", help="Time for a new file")
    add("--max-bag-files", type=whole_number, default=0, metavar="N", help="Keep only the last files of a split bag")
    add(
        "--max-cache-size", type=whole_number, default=100 * 1024 * 1024, metavar="BYTES", help="Of what is not written"
    )
    add("--start-paused", action="store_true", help="Start the recorder in a paused state")
    add("--use-sim-time", action="store_true", help="Time messages by /clock; none before its first message")
    add("--node-name", default="rosbag2_recorder", help="Name of the recorder's node")
    add("--custom-data", nargs="*", default=[], metavar="KEY=VALUE", help="Stored in the metadata of the bag")
    add("--storage-preset-profile", choices=_PRESETS, default="none", help="How the file is written")
    add("--compression-mode", choices=MODES, default="none", help="Compress each file after its end, or each message")
    add("--compression-format", choices=["", FORMAT], default="", help="Only zstd; needs --compression-mode")
    add("--disable-keyboard-controls", action="store_true", help="Do not listen to the keys")
    add(
        "--snapshot-mode",
        action="store_true",
        help="Write nothing until the service ~/snapshot is called; then the last messages, --max-cache-size bytes",
    )
    add("--all-actions", action="store_true", help="Not offered here")
    for name in ("--compression-queue-size", "--compression-threads", "--compression-threads-priority"):
        add(name, type=int, help="Accepted and ignored")
    add("--storage-config-file", type=Path, help="Accepted and ignored; see --storage-preset-profile")
    add("--log-level", help="Accepted and ignored")


def main(arguments: argparse.Namespace) -> int:
    """Record until interrupted; return 0, or 1 if the disk is full."""
    selection = _selection(arguments)
    custom = dict(_key_value(text) for text in arguments.custom_data)
    with bag_errors():
        profiles = overrides(path) if (path := arguments.qos_profile_overrides_path) else {}
        writer = BagWriter(
            arguments.output or default_folder(),
            storage=arguments.storage,
            preset=arguments.storage_preset_profile,
            split_bytes=arguments.max_bag_size,
            split_ns=arguments.max_bag_duration * 10**9,
            keep=arguments.max_bag_files,
            custom_data=custom,
            compression=arguments.compression_mode,
        )
    options = RecordOptions(
        selection,
        hidden=arguments.include_hidden_topics,
        unpublished=arguments.include_unpublished_topics,
        ignore_leaf=arguments.ignore_leaf_topics,
        sim_time=arguments.use_sim_time,
        overrides=profiles,
    )
    kind = SnapshotThread if arguments.snapshot_mode else WritingThread
    writing = kind(writer, arguments.max_cache_size)
    try:
        _record(arguments, options, writing)
    except KeyboardInterrupt:
        pass
    finally:
        interruption.ignore()
        writing.close()
    for topic, count in sorted(writing.lost.items()):
        warn(f"{count} messages of '{topic}' are lost: the disk was slower than they came (--max-cache-size)")
    if writing.failure:
        raise CommandError(f"[ERROR] [ros2bag]: {writing.failure}")
    return 0


def _record(arguments: argparse.Namespace, options: RecordOptions, writing: WritingThread) -> None:
    if not os.environ.get("FASTDDS_BUILTIN_TRANSPORTS"):
        # Images come whole only through shared memory.
        os.environ["FASTDDS_BUILTIN_TRANSPORTS"] = "DEFAULT"
        remove_abandoned_segments()
    place = argparse.Namespace(spin_time=None, use_sim_time=arguments.use_sim_time)
    with Graph(place, node_name=arguments.node_name) as graph:
        recorder = Recorder(graph.node, writing, options, installed_class)
        log = graph.node.get_logger()
        offer_recorder(graph.node, recorder)
        recorder.paused = arguments.start_paused
        actions = {} if arguments.disable_keyboard_controls else {keys.SPACE: recorder.toggle}
        with keys.keys(actions) as heard:
            if heard and actions:
                log.info("Press SPACE for pausing/resuming")
            log.info("Listening for topics..." if not arguments.no_discovery else "Looking for topics once...")
            if arguments.no_discovery:
                graph.settle()
                recorder.look()
            log.info("Waiting for recording: Press SPACE to start." if recorder.paused else "Recording...")
            try:
                _listen(graph, recorder, writing, 0 if arguments.no_discovery else arguments.polling_interval / 1000)
            finally:
                interruption.ignore()
                recorder.take_the_rest()
                log.info("Recording stopped")


def _listen(graph: Graph, recorder: Recorder, writing: WritingThread, look_every: float) -> None:
    next_look = 0.0
    while not writing.failure:
        now = time.monotonic()
        if look_every and now >= next_look:
            graph.settle(0.0)  # finds participants that have not been heard of
            recorder.look()
            next_look = now + look_every
        graph.spin_once(min(look_every or 0.1, 0.1))


def _selection(arguments: argparse.Namespace) -> Selection:
    """Return what is recorded. Raises UsageError for options that make no bag."""
    if arguments.all_actions:
        raise UsageError(_ACTIONS)
    if arguments.compression_format and arguments.compression_mode == "none":
        raise UsageError("Invalid choice: Cannot specify compression format without a compression mode.")
    if arguments.snapshot_mode and not arguments.max_cache_size:
        raise UsageError("In snapshot mode, the max_cache_size shall not be set to zero.")
    if 0 < arguments.max_bag_size < _SMALLEST_SPLIT:
        raise UsageError(f"--max-bag-size must be 0 or at least {_SMALLEST_SPLIT} bytes")
    if arguments.max_bag_files and not (arguments.max_bag_size or arguments.max_bag_duration):
        raise UsageError("--max-bag-files needs --max-bag-size or --max-bag-duration")
    names = [absolute(name) for name in (*arguments.topic_names, *arguments.topics)]
    services = [absolute(name) + SERVICE_EVENTS for name in arguments.services]
    everything = arguments.all or arguments.all_topics
    regex = arguments.regex or (f"{SERVICE_EVENTS}$" if arguments.all_services and not everything else "")
    if not (everything or names or services or regex or arguments.topic_types):
        raise UsageError(
            "Need to specify at least one option out of --all, --all-topics, --all-services, --services, --topics, "
            "--topic-types or --regex"
        )
    without = [absolute(name) for name in arguments.exclude_topics]
    without += [absolute(name) + SERVICE_EVENTS for name in arguments.exclude_services]
    with bag_errors():
        return Selection(
            all=everything,
            topics=(*names, *services),
            regex=regex,
            types=tuple(arguments.topic_types),
            without_regex=arguments.exclude_regex,
            without_topics=tuple(without),
            without_types=tuple(arguments.exclude_topic_types),
        )


def _key_value(text: str) -> tuple[str, str]:
    key, separator, value = text.partition("=")
    if not separator or not key:
        raise UsageError(f"--custom-data '{text}' is not of the form KEY=VALUE")
    return key, value
