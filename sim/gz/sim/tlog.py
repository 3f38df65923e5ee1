"""Gazebo's log file `state.tlog`: messages of many topics in an SQLite database, schema 0.1.0 of gz-transport.

Written by the LogRecord system and `gz log record`, read by `gz tlog`. Tables: `message_types` (name), `topics` (name,
message_type_id), `messages` (time_recv in ns of simulated time, topic_id, message), `migrations` (to_version).

Source: https://github.com/gazebosim/gz-transport/tree/gz-transport13/log/sql
"""

from __future__ import annotations

import contextlib
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from gz_course.sim.gz.sim.errors import SimError

FILE_NAME = "state.tlog"
VERSION = "0.1.0"
_TABLES = (
    "CREATE TABLE migrations (id INTEGER PRIMARY KEY AUTOINCREMENT, from_version TEXT DEFAULT NULL, "
    "to_version TEXT NOT NULL, time_utc INTEGER NOT NULL DEFAULT CURRENT_TIMESTAMP)",
    "CREATE TABLE message_types (id INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL, proto_descriptor TEXT)",
    "CREATE TABLE topics (id INTEGER PRIMARY KEY AUTOINCREMENT, name TEXT NOT NULL, "
    "message_type_id NOT NULL REFERENCES message_types (id) ON DELETE CASCADE)",
    "CREATE UNIQUE INDEX idx_topic ON topics (name, message_type_id)",
    "CREATE TABLE messages (id INTEGER PRIMARY KEY AUTOINCREMENT, time_recv INTEGER NOT NULL, "
    "topic_id REFERENCES topics (id) ON DELETE CASCADE, message BLOB NOT NULL)",
    "CREATE INDEX idx_time_recv ON messages (time_recv)",
)
_AT_ONCE = 500


@dataclass(frozen=True)
class Entry:
    """One recorded message."""

    topic: str
    type_name: str
    time_ns: int
    data: bytes


@dataclass(frozen=True)
class TopicSummary:
    """The messages of one topic in a log; times in [ns] of simulated time."""

    topic: str
    type_name: str
    count: int
    first_ns: int
    last_ns: int
    size: int


class LogWriter:
    """Writes one log and commits every few hundred messages; not thread-safe."""

    def __init__(self, path: Path) -> None:
        """Create the file. Raises SimError if that fails."""
        self._path = path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with _opened(path, isolation_level=None) as self._database:
                for table in _TABLES:
                    self._database.execute(table)
                self._database.execute("INSERT INTO migrations (to_version) VALUES (?)", (VERSION,))
                self._database.execute("BEGIN")
        except (OSError, sqlite3.Error) as error:
            raise SimError(f"the log '{path}' cannot be written ({error})") from None
        self._topics: dict[tuple[str, str], int] = {}
        self._types: dict[str, int] = {}
        self._pending = 0
        self._closed = False

    def write(self, entry: Entry) -> None:
        """Append a message. Raises SimError if writing fails."""
        try:
            values = (entry.time_ns, self._topic(entry.topic, entry.type_name), entry.data)
            self._database.execute("INSERT INTO messages (time_recv, topic_id, message) VALUES (?, ?, ?)", values)
            self._pending += 1
            if self._pending >= _AT_ONCE:
                self._pending = 0
                self._database.execute("COMMIT")
                self._database.execute("BEGIN")
        except sqlite3.Error as error:
            raise SimError(f"the log '{self._path}' cannot be written any more ({error})") from None

    def _topic(self, topic: str, type_name: str) -> int:
        found = self._topics.get((topic, type_name))
        if found is None:
            if type_name not in self._types:
                made = self._database.execute("INSERT INTO message_types (name) VALUES (?)", (type_name,))
                self._types[type_name] = int(made.lastrowid or 0)
            made = self._database.execute(
                "INSERT INTO topics (name, message_type_id) VALUES (?, ?)", (topic, self._types[type_name])
            )
            found = self._topics[(topic, type_name)] = int(made.lastrowid or 0)
        return found

    def close(self) -> None:
        """Commit and close the file; closing twice does nothing."""
        if self._closed:
            return
        self._closed = True
        try:
            if self._database.in_transaction:
                self._database.execute("COMMIT")
            self._database.close()
        except sqlite3.Error as error:
            raise SimError(f"the log '{self._path}' could not be finished ({error})") from None


class Log:
    """An existing log, also as a context that closes it. Raises SimError if the file is no log."""

    def __init__(self, path: Path) -> None:
        """Open the file `path`, or the log in the folder `path`."""
        self.path = path / FILE_NAME if path.is_dir() else path
        if not self.path.is_file():
            raise SimError(f"there is no log '{self.path}'; gz sim --record --record-path FOLDER writes one")
        try:
            with _opened(f"file:{self.path.resolve()}?mode=ro", uri=True) as self._database:
                self.version = str(self._database.execute("SELECT to_version FROM migrations").fetchall()[-1][0])
        except (sqlite3.Error, IndexError) as error:
            raise SimError(f"'{self.path}' is not a log of Gazebo ({error})") from None

    def topics(self) -> list[TopicSummary]:
        """Return a summary of every topic, sorted by name."""
        rows = self._database.execute(
            "SELECT topics.name, message_types.name, COUNT(*), MIN(time_recv), MAX(time_recv), SUM(LENGTH(message)) "
            "FROM messages JOIN topics ON topics.id = topic_id "
            "JOIN message_types ON message_types.id = message_type_id GROUP BY topics.id ORDER BY topics.name"
        )
        return [TopicSummary(*row) for row in rows]

    def messages(self, topic: str | None = None) -> Iterator[Entry]:
        """Yield the messages of one topic or of all, in recorded order."""
        rows = self._database.execute(
            "SELECT topics.name, message_types.name, time_recv, message FROM messages "
            "JOIN topics ON topics.id = topic_id JOIN message_types ON message_types.id = message_type_id "
            "WHERE :topic IS NULL OR topics.name = :topic ORDER BY messages.id",
            {"topic": topic},
        )
        for row in rows:
            yield Entry(*row)

    def latest(self, topic: str, time_ns: int) -> Entry | None:
        """Return the last message of a topic until a simulated time [ns], or the first one if all are later."""
        for condition in ("<= ? ORDER BY time_recv DESC, messages.id DESC", "> ? ORDER BY time_recv, messages.id"):
            row = self._database.execute(
                "SELECT topics.name, message_types.name, time_recv, message FROM messages "
                "JOIN topics ON topics.id = topic_id JOIN message_types ON message_types.id = message_type_id "
                f"WHERE topics.name = ? AND time_recv {condition} LIMIT 1",
                (topic, time_ns),
            ).fetchone()
            if row is not None:
                return Entry(*row)
        return None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._database.close()


@contextlib.contextmanager
def _opened(path: Path | str, **options: Any) -> Iterator[sqlite3.Connection]:
    """Yield a connection that stays open, unless what is done first with it fails."""
    database = sqlite3.connect(path, check_same_thread=False, **options)
    try:
        yield database
    except BaseException:
        database.close()
        raise
