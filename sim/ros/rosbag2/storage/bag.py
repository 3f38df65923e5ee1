"""A bag to read: a folder with `metadata.yaml` and its files, or a single `.mcap` or `.db3` file.

Topics and messages come from the files. A folder without metadata, which a killed recorder leaves, is read like one
with it.
"""

from __future__ import annotations

import contextlib
import heapq
import os
import shutil
import tempfile
import weakref
from collections import Counter
from collections.abc import Collection, Iterator
from pathlib import Path

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage import compression, mcap_reading, sqlite_reading
from gz_course.sim.ros.rosbag2.storage.compression import unpack_message
from gz_course.sim.ros.rosbag2.storage.mcap_reading import McapReading, Message
from gz_course.sim.ros.rosbag2.storage.metadata import (
    FILE,
    FileInformation,
    Metadata,
    Topic,
    from_dictionary,
    from_yaml,
)
from gz_course.sim.ros.rosbag2.storage.sqlite_reading import SqliteReading
from gz_course.sim.ros.rosbag2.storage.yaml_text import load_yaml

SUFFIXES = {"mcap": ".mcap", "sqlite3": ".db3"}
"""The storages that are read, and how their files end."""
_WHOLE = tuple(SUFFIXES.values())
_ENDS = (*_WHOLE, *(suffix + end for suffix in _WHOLE for end in compression.SUFFIXES))


class Bag:
    """A bag with its topics by name. `complaints` are sentences on what is wrong with it, but can be read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.complaints: list[str] = []
        self._unpacked: Path | None = None
        stored = self._stored_metadata() if path.is_dir() else None
        self._readings = {name: self._reading(name) for name in self._files(stored)}
        self.topics: dict[str, Topic] = {}
        for reading in self._readings.values():
            self.topics |= {name: topic for name, topic in reading.topics.items() if name not in self.topics}
            if reading.damage:
                self.complaints.append(reading.damage)
        self.metadata = self._collected() if stored is None else stored

    @property
    def start(self) -> int:
        """The time of the first message [ns]."""
        return min((reading.start for reading in self._readings.values() if reading.topics), default=0)

    @property
    def end(self) -> int:
        """The time of the last message [ns]."""
        return max((reading.end for reading in self._readings.values()), default=0)

    @property
    def size(self) -> int:
        """The size of the files [byte]."""
        return sum(self._place(name).stat().st_size for name in self._readings)

    def definitions(self) -> dict[str, tuple[str, str]]:
        """Return encoding and text of the definition of each type, by its name."""
        found: dict[str, tuple[str, str]] = {}
        for reading in self._readings.values():
            found = reading.definitions() | found
        return found

    def messages(self, topics: Collection[str] | None = None, begin: int = 0) -> Iterator[Message]:
        """Yield the messages of all or some topics from a time on [ns], in the order of their times."""
        later = sorted(
            (reading.start, number, reading)
            for number, reading in enumerate(self._readings.values())
            if reading.end >= begin
        )
        current: list[tuple[int, int, Message, Iterator[Message]]] = []
        while later or current:
            while later and (not current or later[0][0] <= current[0][0]):
                _, number, reading = later.pop(0)
                messages = reading.messages(topics, begin)
                if (first := next(messages, None)) is not None:
                    heapq.heappush(current, (first.received, number, first, messages))
            if current:
                _, number, message, messages = current[0]
                if message.data.startswith(compression.MAGIC):
                    message = message._replace(data=unpack_message(message.data, message.topic))
                yield message
                following = next(messages, None)
                if following is None:
                    heapq.heappop(current)
                else:
                    heapq.heapreplace(current, (following.received, number, following, messages))

    def _stored_metadata(self) -> Metadata | None:
        file = self.path / FILE
        try:
            if file.is_file():
                return from_yaml(file.read_text(encoding="utf-8"), str(file))
            sentence = f"{self.path} has no {FILE}"
        except BagError as error:
            sentence = str(error)
        except (OSError, UnicodeDecodeError) as error:
            sentence = f"{file} cannot be read: {getattr(error, 'strerror', None) or error}"
        self.complaints.append(f"{sentence}; its files are read, `ros2 bag reindex {self.path}` writes it anew")
        return None

    def _files(self, stored: Metadata | None) -> list[str]:
        """Return the names of the files, relative to the folder."""
        if not self.path.is_dir():
            if not self.path.exists():
                raise BagError(f"Bag path '{self.path}' does not exist!")
            return [self.path.name]
        if stored is None:
            there = {entry.name for entry in os.scandir(self.path) if entry.name.endswith(_ENDS)}
            # Compressing may have been interrupted before the whole file was removed.
            found = [name for name in there if name.endswith(_WHOLE) or Path(name).stem not in there]
            if not found:
                raise BagError(f"{self.path} is not a bag: it has neither {FILE} nor .mcap or .db3 files")
            return sorted(found, key=lambda name: (len(name), name))
        if stored.storage not in SUFFIXES:
            raise BagError(f"{self.path} has the storage '{stored.storage}'; here bags are read in {_known_storages()}")
        if stored.compression_format not in ("", compression.FORMAT):
            raise BagError(f"{self.path} is compressed with '{stored.compression_format}'; zstd is read here")
        names = []
        for file in stored.files:
            name = file.path if (self.path / file.path).exists() else Path(file.path).name
            if Path(name).is_absolute() or ".." in Path(name).parts:
                raise BagError(f"{self.path / FILE}: the file '{file.path}' is not in the folder of the bag")
            if not (self.path / name).is_file():
                self.complaints.append(f"{self.path / name} is missing; the other files are read")
            elif name not in names:
                names.append(name)
        if stored.files and not names:
            raise BagError(f"{self.path}: none of its {len(stored.files)} files is there")
        return names

    def _place(self, name: str) -> Path:
        return self.path / name if self.path.is_dir() else self.path

    def _reading(self, name: str) -> McapReading | SqliteReading:
        path = self._place(name)
        if _head(path).startswith(compression.MAGIC):
            if self._unpacked is None:
                self._unpacked = Path(tempfile.mkdtemp(prefix="rosbag2_"))
                weakref.finalize(self, shutil.rmtree, self._unpacked, True)
            path = compression.unpack_file(path, self._unpacked)
        head = _head(path)
        if head.startswith(mcap_reading.MAGIC):
            return McapReading(path)
        if head.startswith(sqlite_reading.MAGIC):
            return SqliteReading(path)
        raise BagError(f"{self._place(name)} is no file of a bag: it begins neither as MCAP nor as SQLite")

    def _collected(self) -> Metadata:
        """Return metadata made from the files."""
        counts: Counter[str] = Counter()
        files = []
        for name, reading in self._readings.items():
            counts.update(reading.counts)
            duration = reading.end - reading.start
            files.append(FileInformation(name, reading.start, duration, reading.counts.total()))
        metadata = Metadata(self._storage(), list(self.topics.values()), dict(counts), files)
        metadata.start = self.start
        metadata.duration = max(0, self.end - self.start)
        told = self._told()
        metadata.distro, metadata.custom_data = told.distro, told.custom_data
        if self._unpacked is not None:
            metadata.compression_mode, metadata.compression_format = "FILE", compression.FORMAT
        elif told.compression_mode == "message":
            metadata.compression_mode, metadata.compression_format = "MESSAGE", compression.FORMAT
        return metadata

    def _storage(self) -> str:
        mcap = any(isinstance(reading, McapReading) for reading in self._readings.values())
        return "mcap" if mcap or not self._readings else "sqlite3"

    def _told(self) -> Metadata:
        """Return the metadata that a file tells."""
        for reading in self._readings.values():
            if text := reading.metadata.get("serialized_metadata"):
                with contextlib.suppress(BagError):
                    values = load_yaml(text, str(self.path))
                    return from_dictionary(values if isinstance(values, dict) else {}, str(self.path))
        return Metadata("", distro="unknown")


def _head(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            return file.read(16)
    except OSError as error:
        raise BagError(f"{path} cannot be read: {error.strerror}") from None


def _known_storages() -> str:
    return " and ".join(f"'{name}'" for name in SUFFIXES)


def reindex(folder: Path) -> Metadata:
    """Write `metadata.yaml` of a bag anew, from its files."""
    if not folder.is_dir():
        raise BagError(f"'{folder}' is not a folder: `reindex` writes the {FILE} of one")
    old = folder / FILE
    aside = folder / f"{FILE}.old"
    if old.exists():
        old.replace(aside)
    try:
        metadata = Bag(folder).metadata
        write_metadata(folder, metadata)
    except BagError:
        if aside.exists():
            aside.replace(old)
        raise
    aside.unlink(missing_ok=True)
    return metadata


def write_metadata(folder: Path, metadata: Metadata) -> None:
    """Write `metadata.yaml` as a whole or not at all. Raises BagError."""
    file = folder / FILE
    draft = folder / f"{FILE}.part"
    try:
        draft.write_text(metadata.as_yaml(), encoding="utf-8")
        draft.replace(file)
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise BagError(f"{file} cannot be written: {error.strerror}") from None
