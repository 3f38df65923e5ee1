"""Writes a bag: a folder with `metadata.yaml` and one file of its storage, or several if it is split."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from pathlib import Path

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.bag import write_metadata
from gz_course.sim.ros.rosbag2.storage.compression import FORMAT, compress_file, compress_message
from gz_course.sim.ros.rosbag2.storage.mcap_writing import PRESETS, DiskFullError, McapFile
from gz_course.sim.ros.rosbag2.storage.metadata import FileInformation, Metadata, Topic
from gz_course.sim.ros.rosbag2.storage.sqlite_writing import SqliteFile

STORAGES: dict[str, tuple[str, type[McapFile] | type[SqliteFile], tuple[str, ...]]] = {
    "mcap": (".mcap", McapFile, tuple(PRESETS)),
    "sqlite3": (".db3", SqliteFile, ("none", "resilient")),
}
"""The storages that are written: suffix, class of a file and preset profiles."""


class BagWriter:
    """A new bag in a folder that does not exist yet.

    A new file begins before one exceeds `split_bytes`, and when its messages span `split_ns` [ns]; 0 is never.
    Of the files only the last `keep` remain; 0 is all. `compression` is `none`, `file` (each after its end) or
    `message`. `on_split` gets the paths of the file that has ended and of the new one. Not for several threads.
    """

    def __init__(
        self,
        folder: Path,
        storage: str = "mcap",
        preset: str = "none",
        split_bytes: int = 0,
        split_ns: int = 0,
        keep: int = 0,
        custom_data: dict[str, str] | None = None,
        compression: str = "none",
    ) -> None:
        self.folder = folder
        self.on_split: Callable[[str, str], object] = lambda ended, new: None
        self.metadata = Metadata(storage, custom_data=custom_data or {})
        if compression != "none":
            self.metadata.compression_mode, self.metadata.compression_format = compression.upper(), FORMAT
        self._compression = compression
        self._compressing: list[threading.Thread] = []
        self._suffix, self._kind, presets = STORAGES[storage]
        if preset not in presets:
            raise BagError(f"the storage '{storage}' has no preset profile '{preset}'; it has {', '.join(presets)}")
        self._preset = preset
        self._split_bytes, self._split_ns, self._keep = split_bytes, split_ns, keep
        self._definitions: dict[str, tuple[str, str]] = {}
        self._topics: dict[str, Topic] = {}
        self._end = 0
        self._number = 0
        try:
            folder.mkdir(parents=True)
        except FileExistsError:
            raise BagError(f"Output folder '{folder}' already exists.") from None
        except OSError as error:
            raise BagError(f"Could not create bag folder '{folder}': {error.strerror}.") from None
        self._open()

    def add_topic(self, topic: Topic, definition: tuple[str, str]) -> None:
        """Make a topic known; `definition` is the encoding and the text of its type's definition."""
        if topic.name not in self._topics:
            self._topics[topic.name] = topic
            self._definitions[topic.type] = definition
            self.metadata.topics.append(topic)
            self._file.add_topic(topic, definition)

    def write(self, topic: str, received: int, sent: int, data: bytes) -> None:
        """Add a serialised message with its times [ns]. Raises DiskFullError."""
        if self._compression == "message":
            data = compress_message(data)
        here = self.metadata.files[-1]
        if here.count and (
            (self._split_bytes and self._file.size + len(data) > self._split_bytes)
            or (self._split_ns and received - here.start >= self._split_ns)
        ):
            self.split()
            here = self.metadata.files[-1]
        self._file.write(topic, received, sent, data)
        self._count(here, topic, received)

    def split(self) -> None:
        """Continue in a new file."""
        self._file.close(self.metadata)
        self._compress()
        ended = self.metadata.files[-1]
        self._number += 1
        while self._keep and len(self.metadata.files) >= self._keep:
            self._wait_for_compression()
            oldest = self.metadata.files.pop(0)
            (self.folder / oldest.path).unlink(missing_ok=True)
        self._open()
        self.on_split(str(self.folder / ended.path), str(self.folder / self.metadata.files[-1].path))

    def flush(self) -> None:
        """Put all messages on the disk. Raises DiskFullError."""
        self._file.flush()

    def close(self) -> None:
        """Finish the bag. Raises BagError if the disk is full; what was written before can be read."""
        try:
            self._file.close(self.metadata)
        except DiskFullError:
            self._file.abandon()
            self._wait_for_compression()
            raise
        self._compress()
        self._wait_for_compression()
        write_metadata(self.folder, self.metadata)

    def abandon(self) -> None:
        """Leave the last file without its end, after DiskFullError."""
        self._file.abandon()
        self._wait_for_compression()

    def _compress(self) -> None:
        """Have the file that has ended compressed beside the writing; if that fails it stays as it is."""
        if self._compression != "file":
            return
        file = self.metadata.files[-1]

        def work() -> None:
            with contextlib.suppress(OSError):
                file.path = compress_file(self.folder / file.path).name

        self._compressing.append(threading.Thread(target=work, name="bag compression"))
        self._compressing[-1].start()

    def _wait_for_compression(self) -> None:
        while self._compressing:
            self._compressing.pop().join()

    def _open(self) -> None:
        name = f"{self.folder.resolve().name}_{self._number}{self._suffix}"
        try:
            self._file = self._kind(self.folder / name, self._preset)
        except OSError as error:
            raise DiskFullError(f"{self.folder / name} cannot be written: {error.strerror}") from None
        self.metadata.files.append(FileInformation(name))
        for topic in self._topics.values():
            self._file.add_topic(topic, self._definitions[topic.type])

    def _count(self, file: FileInformation, topic: str, time: int) -> None:
        metadata = self.metadata
        if not metadata.counts:
            metadata.start = self._end = time
        if not file.count:
            file.start = time
        metadata.counts[topic] = metadata.counts.get(topic, 0) + 1
        file.count += 1
        end = max(file.start + file.duration, time)
        file.start = min(file.start, time)
        file.duration = end - file.start
        self._end = max(self._end, time)
        metadata.start = min(metadata.start, time)
        metadata.duration = self._end - metadata.start
