"""Reads MCAP files of any origin: whole ones, truncated ones and damaged ones.

A first pass reads the frame of each record and skips the content of chunks, so that a file without an index is read
like one with it. What a file claims of its sizes is compared with the file before memory is taken.

Source: https://mcap.dev/spec; rosbag2_storage_mcap 0.26 (`mcap_storage.cpp`)
"""

from __future__ import annotations

import heapq
import struct
import zlib
from collections import Counter
from collections.abc import Collection, Iterator
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import lz4.frame
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Metadata, Schema, Statistics

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.metadata import Topic
from gz_course.sim.ros.rosbag2.storage.offered_qos import profiles_from_yaml

MAGIC = b"\x89MCAP0\r\n"
LARGEST_CHUNK = 1 << 30  # bytes, unpacked
_LARGEST_RECORD = 1 << 28  # bytes, of what is not a message
_FRAME = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")
_CHUNK = struct.Struct("<QQQII")
_PIECE = 1 << 20  # bytes unpacked at a time
_DAMAGED = (
    *(struct.error, McapError, ValueError, EOFError, OverflowError, MemoryError, RuntimeError),
    zstandard.ZstdError,
)


class Message(NamedTuple):
    """A serialised message of a bag, with its times [ns]."""

    topic: str
    received: int
    sent: int
    data: bytes


class _Part(NamedTuple):
    """A chunk, or a message outside of chunks, with the time of its first message [ns]."""

    start: int
    offset: int
    length: int
    is_chunk: bool


class McapReading:
    """A file with its topics, the number of their messages, and what is wrong with it (`damage`, else empty)."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.damage = ""
        self.counts: Counter[str] = Counter()
        self.start, self.end = 0, 0  # [ns]
        self.metadata: dict[str, str] = {}
        self._schemas: dict[int, Schema] = {}
        self._channels: dict[int, Channel] = {}
        self._parts: list[_Part] = []
        self._statistics: Statistics | None = None
        try:
            with path.open("rb") as file:
                if file.read(len(MAGIC)) != MAGIC:
                    raise BagError(f"{path} is not an MCAP file: it does not begin as one")
                self._scan(file, path.stat().st_size)
                if self._statistics is None or not self._channels:
                    self._count(file)
        except OSError as error:
            raise BagError(f"{path} cannot be read: {error.strerror}") from None
        if self._statistics is not None:
            self._take_statistics(self._statistics)
        self.topics: dict[str, Topic] = {}
        for channel in self._channels.values():
            schema = self._schemas.get(channel.schema_id)
            if schema is not None and channel.topic not in self.topics:
                self.topics[channel.topic] = self._topic(channel, schema)

    def definitions(self) -> dict[str, tuple[str, str]]:
        """Return encoding and text of the definition of each type, by its name."""
        return {
            schema.name: (schema.encoding, schema.data.decode(errors="replace")) for schema in self._schemas.values()
        }

    def messages(self, topics: Collection[str] | None = None, begin: int = 0) -> Iterator[Message]:
        """Yield the messages of all or some topics from a time on [ns], in the order of their times."""
        waiting: list[tuple[int, int, Message]] = []
        number = 0
        with self._path.open("rb") as file:
            for part in sorted(self._parts):
                while waiting and waiting[0][0] < part.start:
                    yield heapq.heappop(waiting)[2]
                for message in self._messages_of(file, part, topics):
                    if message.received >= begin:
                        heapq.heappush(waiting, (message.received, number, message))
                        number += 1
            while waiting:
                yield heapq.heappop(waiting)[2]

    def _scan(self, file: BinaryIO, size: int) -> None:
        """Read the frames of all records, and the content of those that are not messages."""
        offset = len(MAGIC)
        while True:
            head = file.read(_FRAME.size)
            if len(head) < _FRAME.size:
                self._spoilt(offset, "it ends before its end mark")
                return
            opcode, length = _FRAME.unpack(head)
            offset += _FRAME.size
            if length > size - offset:
                self._spoilt(offset, "its last record is cut off")
                return
            try:
                self._take(file, opcode, offset, length)
            except _DAMAGED as error:
                self._spoilt(offset, f"a record cannot be read ({str(error)[:80] or type(error).__name__})")
            if opcode == Opcode.FOOTER:
                return
            offset += length
            file.seek(offset)

    def _take(self, file: BinaryIO, opcode: int, offset: int, length: int) -> None:
        if opcode == Opcode.CHUNK:
            start, *_ = _CHUNK.unpack(file.read(min(length, _CHUNK.size)))
            self._parts.append(_Part(start, offset, length, True))
        elif opcode == Opcode.MESSAGE:
            _, _, time, _ = _MESSAGE.unpack(file.read(min(length, _MESSAGE.size)))
            self._parts.append(_Part(time, offset, length, False))
        elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.METADATA, Opcode.STATISTICS):
            if length > _LARGEST_RECORD:
                raise ValueError(f"{length} bytes are too many")
            self._take_record(opcode, file.read(length))

    def _take_record(self, opcode: int, data: bytes) -> None:
        stream = ReadDataStream(BytesIO(data))
        if opcode == Opcode.SCHEMA:
            schema = Schema.read(stream)
            self._schemas.setdefault(schema.id, schema)
        elif opcode == Opcode.CHANNEL:
            channel = Channel.read(stream)
            self._channels.setdefault(channel.id, channel)
        elif opcode == Opcode.METADATA:
            record = Metadata.read(stream)
            if record.name == "rosbag2":
                self.metadata = record.metadata
        elif opcode == Opcode.STATISTICS:
            self._statistics = Statistics.read(stream)

    def _count(self, file: BinaryIO) -> None:
        """Learn from the messages themselves what the end of the file should tell."""
        self._statistics = None
        times: list[int] = []
        for part in self._parts:
            for message in self._messages_of(file, part, None):
                self.counts[message.topic] += 1
                times = [min([*times[:1], message.received]), max([*times[1:], message.received])]
        self.start, self.end = times or (0, 0)

    def _take_statistics(self, statistics: Statistics) -> None:
        self.start, self.end = statistics.message_start_time, statistics.message_end_time
        self.end = max(self.start, self.end)
        for number, count in statistics.channel_message_counts.items():
            if number in self._channels:
                self.counts[self._channels[number].topic] += count

    def _messages_of(self, file: BinaryIO, part: _Part, topics: Collection[str] | None) -> Iterator[Message]:
        file.seek(part.offset)
        data = file.read(part.length)
        if not part.is_chunk:
            yield from self._message(memoryview(data), topics)
            return
        try:
            view = memoryview(_unpacked(data))
            place = 0
            while place < len(view):
                opcode, length = _FRAME.unpack_from(view, place)
                place += _FRAME.size
                record = view[place : place + length]
                if len(record) < length:
                    raise ValueError("a record is longer than its chunk")
                place += length
                if opcode == Opcode.MESSAGE:
                    yield from self._message(record, topics)
                elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL):
                    self._take_record(opcode, bytes(record))
        except _DAMAGED as error:
            self._spoilt(part.offset, f"a chunk cannot be read ({str(error)[:80] or type(error).__name__})")

    def _message(self, record: memoryview, topics: Collection[str] | None) -> Iterator[Message]:
        number, _, received, sent = _MESSAGE.unpack_from(record)
        channel = self._channels.get(number)
        if channel is not None and (topics is None or channel.topic in topics):
            yield Message(channel.topic, received, sent, bytes(record[_MESSAGE.size :]))

    def _topic(self, channel: Channel, schema: Schema) -> Topic:
        try:
            qos = profiles_from_yaml(channel.metadata.get("offered_qos_profiles", ""), str(self._path))
        except BagError as error:
            self.damage, qos = self.damage or str(error), ()
        type_hash = channel.metadata.get("topic_type_hash", "")
        return Topic(channel.topic, schema.name, channel.message_encoding, qos, type_hash)

    def _spoilt(self, offset: int, what: str) -> None:
        self.damage = self.damage or f"{self._path} is not whole: {what} (byte {offset}); what is readable is used"


def _unpacked(record: bytes) -> Any:
    """Return the records of a chunk. Raises one of `_DAMAGED`."""
    _, _, size, crc, length = _CHUNK.unpack_from(record)
    name = record[_CHUNK.size : _CHUNK.size + length].decode()
    place = _CHUNK.size + length
    (packed_size,) = struct.unpack_from("<Q", record, place)
    packed = memoryview(record)[place + 8 : place + 8 + packed_size]
    if len(packed) < packed_size or size > LARGEST_CHUNK:
        raise ValueError(f"it claims {packed_size} bytes, and {size} unpacked")
    data: Any = packed
    if name == "zstd":
        data = _pieces(zstandard.ZstdDecompressor(max_window_size=1 << 27).stream_reader(packed), size)
    elif name == "lz4":
        data = lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=size)
    elif name:
        raise ValueError(f"unknown compression {name[:20]!r}")
    if len(data) != size:
        raise ValueError(f"it has {len(data)} bytes instead of {size}")
    if crc and zlib.crc32(data) != crc:
        raise ValueError("its checksum is wrong")
    return data


def _pieces(stream: Any, size: int) -> bytearray:
    data = bytearray()
    while len(data) <= size and (piece := stream.read(_PIECE)):
        data += piece
    return data
