"""Writes one MCAP file as rosbag2 does: profile `ros2`, messages in CDR, definitions as `ros2msg`.

A chunk is on the disk soon after its last message, so that a killed process leaves a file that can be read. When the
disk is full the file is cut after its last whole record.

Source: https://mcap.dev/spec; rosbag2_storage_mcap 0.26 (`mcap_storage.cpp`, and its README for the preset profiles)
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, cast

from mcap.writer import CompressionType, Writer

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.metadata import Metadata, Topic
from gz_course.sim.ros.rosbag2.storage.yaml_text import to_yaml

CHUNK_BYTES = 786432
PRESETS: dict[str, dict[str, Any]] = {
    "none": {},
    "fastwrite": {"use_chunking": False, "enable_crcs": False},
    "zstd_fast": {"compression": CompressionType.ZSTD, "enable_crcs": False},
    "zstd_small": {"compression": CompressionType.ZSTD, "chunk_size": 4 * 1024 * 1024},
}
"""The preset profiles of rosbag2. The level of the compression is the library's for both."""


class DiskFullError(BagError):
    """A file could not be written on; what it holds is whole up to the last record."""


class _Sink:
    """A file of which every write is whole or undone."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
        self._size = 0

    def write(self, data: bytes) -> int:
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[os.write(self._file, rest) :]
        except OSError as error:
            os.ftruncate(self._file, self._size)
            os.lseek(self._file, self._size, os.SEEK_SET)
            raise DiskFullError(f"{self._path} cannot be written: {error.strerror}") from None
        self._size += len(data)
        return len(data)

    def tell(self) -> int:
        return self._size

    def flush(self) -> None:
        """Do nothing, because nothing is held back."""

    def close(self) -> None:
        if self._file >= 0:
            os.close(self._file)
            self._file = -1


class McapFile:
    """An MCAP file being written. Raises DiskFullError when it cannot grow; then only `abandon` may follow."""

    def __init__(self, path: Path, preset: str = "none") -> None:
        self._sink = cast(Any, _Sink(path))
        options = {"compression": CompressionType.NONE, "chunk_size": CHUNK_BYTES, **PRESETS[preset]}
        self._writer = Writer(self._sink, **options)
        self._writer.start(profile="ros2", library="gz_course")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._buffered = 0

    @property
    def size(self) -> int:
        """Return the size of the file with what is still to be written [byte]."""
        return self._sink.tell() + self._buffered

    def add_topic(self, topic: Topic, definition: tuple[str, str]) -> None:
        """Make a topic known; `definition` is its encoding and its text."""
        if topic.type not in self._schemas:
            encoding, text = definition
            self._schemas[topic.type] = self._writer.register_schema(topic.type, encoding, text.encode())
        self._channels[topic.name] = self._writer.register_channel(
            topic.name,
            topic.serialization_format,
            self._schemas[topic.type],
            {
                "offered_qos_profiles": to_yaml([profile.as_dictionary() for profile in topic.qos]),
                "topic_type_hash": topic.type_hash,
            },
        )

    def write(self, topic: str, received: int, sent: int, data: bytes) -> None:
        """Add a serialised message with its times [ns]."""
        before = self._sink.tell()
        self._buffered += len(data)
        self._writer.add_message(self._channels[topic], received, data, sent)
        if self._sink.tell() > before:
            self._buffered = 0

    def flush(self) -> None:
        """Put all that was added into the file."""
        self._writer.flush()
        self._buffered = 0

    def close(self, metadata: Metadata) -> None:
        """Finish the file, with the metadata of its bag."""
        self._writer.add_metadata("rosbag2", {"serialized_metadata": to_yaml(metadata.as_dictionary())})
        self._writer.finish()
        self._sink.close()

    def abandon(self) -> None:
        """Close the file as it is."""
        self._sink.close()
