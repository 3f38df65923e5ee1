"""Writes one `.db3` file as rosbag2's older storage does, for programs that ask for `sqlite3`.

Source: rosbag2_storage_sqlite3 0.26 (`sqlite_storage.cpp`): the tables of schema version 4
"""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from gz_course.sim.ros.rosbag2.storage.mcap_writing import DiskFullError
from gz_course.sim.ros.rosbag2.storage.metadata import DISTRO, Metadata, Topic
from gz_course.sim.ros.rosbag2.storage.yaml_text import to_yaml

_SCHEMA_VERSION = 4
_TABLES = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL,
    offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL,
    encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,
    data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
"""


class SqliteFile:
    """A `.db3` file being written. Raises DiskFullError when it cannot grow; then only `abandon` may follow."""

    def __init__(self, path: Path, preset: str = "none") -> None:
        self._path = path
        self._topics: dict[str, int] = {}
        self._types: set[str] = set()
        self.size = 0
        """The bytes of the messages so far."""
        with self._explained(), contextlib.ExitStack() as on_failure:
            # Written by one thread, which need not be the one that opens and closes it.
            self._database = on_failure.enter_context(
                contextlib.closing(sqlite3.connect(path, check_same_thread=False))
            )
            if preset != "resilient":
                self._database.execute("PRAGMA synchronous = OFF")
            self._database.executescript(_TABLES)
            self._insert("schema", _SCHEMA_VERSION, DISTRO)
            self._database.commit()
            on_failure.pop_all()

    def add_topic(self, topic: Topic, definition: tuple[str, str]) -> None:
        """Make a topic known; `definition` is its encoding and its text."""
        qos = to_yaml([profile.as_dictionary() for profile in topic.qos])
        with self._explained():
            self._topics[topic.name] = len(self._topics) + 1
            number = self._topics[topic.name]
            self._insert("topics", number, topic.name, topic.type, topic.serialization_format, qos, topic.type_hash)
            if topic.type not in self._types:
                self._types.add(topic.type)
                self._insert("message_definitions", None, topic.type, *definition, topic.type_hash)

    def write(self, topic: str, received: int, sent: int, data: bytes) -> None:
        """Add a serialised message with the time [ns] at which it came; there is no place for when it was sent."""
        with self._explained():
            self._insert("messages", None, self._topics[topic], received, data)
        self.size += len(data)

    def flush(self) -> None:
        """Put all that was added into the file."""
        with self._explained():
            self._database.commit()

    def close(self, metadata: Metadata) -> None:
        """Finish the file, with the metadata of its bag."""
        with self._explained():
            self._insert("metadata", None, metadata.version, to_yaml(metadata.as_dictionary()))
            self._database.commit()
        self._database.close()

    def abandon(self) -> None:
        """Close the file with what was flushed."""
        with contextlib.suppress(sqlite3.Error):
            self._database.rollback()
        self._database.close()

    def _insert(self, table: str, *values: Any) -> None:
        self._database.execute(f"INSERT INTO {table} VALUES ({', '.join('?' * len(values))})", values)

    @contextlib.contextmanager
    def _explained(self) -> Iterator[None]:
        try:
            yield
        except (sqlite3.Error, OverflowError) as error:
            raise DiskFullError(f"{self._path} cannot be written: {error}") from None
