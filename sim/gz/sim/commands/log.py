"""Record and play back topics: `gz log record --file FILE`, `gz log playback --file FILE`.

`record` writes all messages until Ctrl-C, also of topics that appear later; times are those of the wall clock.
`playback` publishes them again at their intervals. `gz tlog` shows what is in a file.

Source: https://github.com/gazebosim/gz-transport/blob/gz-transport13/log/src/cmd/cmdlog.rb.in
"""

from __future__ import annotations

import argparse
import re
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from gz_course.sim.gz.command_line import Parser, whole_number
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.tlog import Entry, Log, LogWriter
from gz_course.sim.gz.transport import Node, NodeOptions

_LOOK_S = 0.5
_WAIT_MS = 1000


def add_arguments(parser: Parser) -> None:
    parser.add_argument("action", nargs="?", choices=("record", "playback"), help="what to do")
    parser.add_argument("--file", metavar="FILE", help="the recording (record: DATE_TIME.tlog without it)")
    parser.add_argument("--pattern", metavar="REGEX", default=".+", help="only topics that match as a whole")
    parser.add_argument("--force", action="store_true", help="record: overwrite the file")
    parser.add_argument("--remap", metavar="FROM:=TO", help="playback: publish topic FROM as TO")
    parser.add_argument(
        "--wait", type=whole_number, metavar="MS", default=_WAIT_MS, help="playback: milliseconds before it starts"
    )
    parser.add_argument("-f", "--fast", action="store_true", help="playback: without the times between messages")
    parser.set_defaults(show_help=parser.print_help)


def run(values: argparse.Namespace) -> int:
    """Run `gz log`; return the exit code. Raises ValueError with one sentence if there is no such file or pattern."""
    if values.action is None:
        values.show_help()
        return 0
    try:
        pattern = re.compile(values.pattern)
    except re.error as error:
        raise ValueError(f"--pattern {values.pattern!r} is not a regular expression ({error})") from None
    try:
        if values.action == "record":
            return _record(values, pattern)
        return _playback(values, pattern)
    except SimError as error:
        raise ValueError(str(error)) from None


def _record(values: argparse.Namespace, pattern: re.Pattern[str]) -> int:
    path = Path(values.file or time.strftime("%Y%m%d_%H%M%S") + ".tlog")
    if path.exists():
        if not values.force:
            raise ValueError(f"'{path}' exists already; --force overwrites it")
        path.unlink()
    with Recorder(path, pattern) as recorder:
        print(f"Recording into {path}; Ctrl-C ends it.")
        try:
            while recorder.look():
                recorder.failed.wait(_LOOK_S)
        except KeyboardInterrupt:
            pass
    print(f"{recorder.count} messages of {len(recorder.topics)} topics were recorded.")
    return 1 if recorder.failed.is_set() else 0


class Recorder:
    """Subscribes to the topics that match and writes their messages; a context manager."""

    def __init__(self, path: Path, pattern: re.Pattern[str]) -> None:
        """Create the file. Raises SimError if that fails."""
        self._writer = LogWriter(path)
        self._pattern = pattern
        self._lock = threading.Lock()
        self._node = Node()
        self.topics: set[str] = set()
        self.count = 0
        self.failed = threading.Event()

    def look(self) -> bool:
        """Subscribe to topics that are new; return False if writing has failed."""
        for topic in self._node.topic_list():
            if topic not in self.topics and self._pattern.fullmatch(topic):
                self.topics.add(topic)
                self._node.subscribe_raw(topic, self._keep)
        return not self.failed.is_set()

    def _keep(self, data: bytes, info: Any) -> None:
        entry = Entry(info.topic, info.type, time.time_ns(), data)
        with self._lock:  # messages of this process and of others come in two threads
            if self.failed.is_set():
                return
            try:
                self._writer.write(entry)
                self.count += 1
            except SimError as error:
                self.failed.set()
                print(f"gz log: {error}")

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self._node.close()
        with self._lock:
            self._writer.close()


def _playback(values: argparse.Namespace, pattern: re.Pattern[str]) -> int:
    if values.file is None:
        raise ValueError("playback needs --file FILE")
    options = NodeOptions()
    if values.remap is not None:
        source, separator, target = values.remap.partition(":=")
        if not separator or not options.add_topic_remap(source, target):
            raise ValueError(f"--remap takes FROM:=TO with two names of topics, but found {values.remap!r}")
    with Log(Path(values.file)) as log, Node(options) as node:
        stop = threading.Event()
        try:
            count = play(log, node, pattern, values.wait / 1000, 0.0 if values.fast else 1.0, stop.wait)
        except KeyboardInterrupt:
            return 0
    print(f"{count} messages were played back.")
    return 0


def play(
    log: Log, node: Node, pattern: re.Pattern[str], wait: float, pace: float, pause: Callable[[float], Any]
) -> int:
    """Publish the messages of the matching topics; return their number.

    `pause(seconds)` is called before the first message with `wait` [s], then with the time [s] until the next, which
    is that of the recording multiplied by `pace`. Raises ValueError if no topic matches.
    """
    topics = [each for each in log.topics() if pattern.fullmatch(each.topic)]
    if not topics:
        raise ValueError(f"{log.path} has no topic that matches {pattern.pattern!r}; see gz tlog -i {log.path}")
    publishers = {each.topic: node.advertise(each.topic, each.type_name) for each in topics}
    pause(wait)
    began, first, count = time.monotonic(), min(each.first_ns for each in topics), 0
    for entry in log.messages():
        if entry.topic not in publishers:
            continue
        left = began + pace * (entry.time_ns - first) * 1e-9 - time.monotonic() if pace else 0.0
        if left > 0.0:
            pause(left)
        publishers[entry.topic].publish_raw(entry.data, entry.type_name)
        count += 1
    return count
