"""Reads the `.db3` files of rosbag2's older storage.

Source: rosbag2_storage_sqlite3 0.26 (`sqlite_storage.cpp`): the tables, and which came when
"""

from __future__ import annotations

import contextlib
import functools
import sqlite3
from collections import Counter
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Any

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.mcap_reading import Message
from gz_course.sim.ros.rosbag2.storage.metadata import Topic
from gz_course.sim.ros.rosbag2.storage.offered_qos import profiles_from_yaml

MAGIC = b"SQLite format 3\0"
_SUPPORTED = ("name", "type", "serialization_format", "offered_qos_profiles", "type_description_hash")


class SqliteReading:
    """A file with its topics, the number of their messages, and what is wrong with it (`damage`, else empty)."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.damage = ""
        self.metadata: dict[str, str] = {}
        self.topics: dict[str, Topic] = {}
        self.start, self.end = 0, 0  # [ns]
        with self._opened() as database:
            for topic in self._read_topics(database):
                self.topics.setdefault(topic.name, topic)
            first, last = database.execute("SELECT MIN(timestamp), MAX(timestamp) FROM messages").fetchone()
            if isinstance(first, int) and isinstance(last, int):
                self.start, self.end = max(0, first), max(0, first, last)
            self._definitions = dict(self._read_definitions(database))
            self._read_metadata(database)

    @functools.cached_property
    def counts(self) -> Counter[str]:
        """The number of messages of each topic; all of the file is read for it."""
        query = "SELECT t.name, COUNT(*) FROM messages m JOIN topics t ON m.topic_id = t.id GROUP BY t.name"
        with self._opened() as database:
            return Counter({name: count for name, count in database.execute(query) if name in self.topics})

    def definitions(self) -> dict[str, tuple[str, str]]:
        """Return encoding and text of the definition of each type, by its name."""
        return self._definitions

    def messages(self, topics: Collection[str] | None = None, begin: int = 0) -> Iterator[Message]:
        """Yield the messages of all or some topics from a time on [ns], in the order of their times."""
        query = (
            "SELECT t.name, m.timestamp, m.data FROM messages m JOIN topics t ON m.topic_id = t.id "
            "WHERE m.timestamp >= ? ORDER BY m.timestamp, m.id"
        )
        try:
            with self._opened() as database:
                for name, time, data in database.execute(query, (min(begin, 2**63 - 1),)):
                    if not isinstance(data, bytes) or not isinstance(time, int) or time < 0:
                        self.damage = (
                            self.damage or f"{self._path} has messages without data or time; they are left out"
                        )
                    elif name in self.topics and (topics is None or name in topics):
                        yield Message(name, time, time, data)
        except BagError as error:
            self.damage = self.damage or f"{error}; what is readable is used"

    @contextlib.contextmanager
    def _opened(self) -> Iterator[sqlite3.Connection]:
        try:
            beside = Path(f"{self._path}-wal").exists()  # what is not in the file itself yet
            uri = f"{self._path.resolve().as_uri()}?mode=ro{'' if beside else '&immutable=1'}"
            with contextlib.closing(sqlite3.connect(uri, uri=True, check_same_thread=False)) as database:
                database.execute("PRAGMA trusted_schema = OFF")
                database.text_factory = lambda raw: raw.decode(errors="replace")
                self._check_tables(database)
                yield database
        except (sqlite3.Error, OverflowError, MemoryError, UnicodeError) as error:
            raise BagError(f"{self._path} is not a readable database of rosbag2: {error}") from None

    def _check_tables(self, database: sqlite3.Connection) -> None:
        """Fail if a table is a view: one of unknown origin may have no end."""
        names = "('topics', 'messages', 'message_definitions', 'metadata')"
        query = f"SELECT sql FROM sqlite_master WHERE name IN {names}"
        found = [str(row[0]) for row in database.execute(query)]
        if len(found) < 2 or not all(each.upper().startswith("CREATE TABLE") for each in found):
            raise BagError(f"{self._path} is not a database of rosbag2: it has no tables 'topics' and 'messages'")

    def _columns(self, database: sqlite3.Connection, table: str) -> set[str]:
        return {row[1] for row in database.execute(f"PRAGMA table_info({table})")}

    def _read_topics(self, database: sqlite3.Connection) -> Iterator[Topic]:
        columns = self._columns(database, "topics")
        chosen = [name for name in _SUPPORTED if name in columns]
        if chosen[:3] != list(_SUPPORTED[:3]):
            raise BagError(f"{self._path} is not a database of rosbag2: it has no table 'topics' with name and type")
        for row in database.execute(f"SELECT {', '.join(chosen)} FROM topics ORDER BY id"):
            values: dict[str, Any] = dict(zip(chosen, row, strict=True))
            if not all(isinstance(value, str) for value in row):
                raise BagError(f"{self._path} is not a database of rosbag2: a topic has a name or type that is no text")
            try:
                qos = profiles_from_yaml(values.get("offered_qos_profiles", ""), str(self._path))
            except BagError as error:
                self.damage, qos = self.damage or str(error), ()
            type_hash = values.get("type_description_hash", "")
            yield Topic(values["name"], values["type"], values["serialization_format"], qos, type_hash)

    def _read_metadata(self, database: sqlite3.Connection) -> None:
        if "metadata" in self._columns(database, "metadata"):
            row = database.execute("SELECT metadata FROM metadata ORDER BY id DESC").fetchone()
            if row is not None and isinstance(row[0], str):
                self.metadata = {"serialized_metadata": row[0]}

    def _read_definitions(self, database: sqlite3.Connection) -> Iterator[tuple[str, tuple[str, str]]]:
        if not self._columns(database, "message_definitions") >= {"topic_type", "encoded_message_definition"}:
            return
        query = "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions"
        for row in database.execute(query):
            if all(isinstance(value, str) for value in row):
                yield row[0], (row[1], row[2])
