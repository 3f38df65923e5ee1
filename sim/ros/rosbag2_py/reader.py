"""Reads the messages of a bag, one after the other."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path

from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.bag import Bag, reindex
from gz_course.sim.ros.rosbag2.storage.bag_writer import STORAGES
from gz_course.sim.ros.rosbag2.storage.mcap_reading import Message
from gz_course.sim.ros.rosbag2_py.storage import (
    BagMetadata,
    ConverterOptions,
    MessageDefinition,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    TopicMetadata,
)


class SequentialReader:
    """Reads a bag by the times of its messages. Errors are RuntimeError, as those of the original."""

    def __init__(self) -> None:
        self._bag: Bag | None = None
        self._filter = StorageFilter()
        self._begin = 0
        self._reverse = False
        self._messages: Iterator[Message] = iter(())
        self._next: Message | None = None

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Open a bag; what is wrong with it, but can be read, is said on stderr."""
        self._bag = _opened(storage_options.uri)
        self._filter, self._begin, self._reverse = StorageFilter(), 0, False
        self._restart()

    def open_uri(self, uri: str) -> None:
        self.open(StorageOptions(uri))

    def has_next(self) -> bool:
        return self._next is not None

    def read_next(self) -> tuple[str, bytes, int]:
        """Return topic, serialised message and the time [ns] at which it was received."""
        message = self._next
        if message is None:
            raise RuntimeError("Bag is at end. No next message.")
        self._advance()
        return message.topic, message.data, message.received

    def seek(self, timestamp: int) -> None:
        """Continue with the messages from a time on [ns]; in reverse order, with those up to it."""
        self._begin = timestamp
        self._restart(sought=True)

    def set_filter(self, storage_filter: StorageFilter) -> None:
        self._filter = storage_filter
        self._restart()

    def reset_filter(self) -> None:
        self.set_filter(StorageFilter())

    def set_read_order(self, order: ReadOrder) -> bool:
        """Read by the time of receiving, forwards or backwards; return False for another order."""
        if order.sort_by is not ReadOrderSortBy.ReceivedTimestamp:
            return False
        self._reverse = order.reverse
        self._restart()
        return True

    def get_all_topics_and_types(self) -> list[TopicMetadata]:
        return [TopicMetadata.of(number, topic) for number, topic in enumerate(self._open_bag().topics.values())]

    def get_all_message_definitions(self) -> list[MessageDefinition]:
        bag = self._open_bag()
        hashes = {topic.type: topic.type_hash for topic in bag.topics.values()}
        return [
            MessageDefinition(name, encoding, text, hashes.get(name, ""))
            for name, (encoding, text) in bag.definitions().items()
        ]

    def get_metadata(self) -> BagMetadata:
        bag = self._open_bag()
        return BagMetadata.of(bag.metadata, bag.size)

    def close(self) -> None:
        self._bag, self._messages, self._next = None, iter(()), None

    def _open_bag(self) -> Bag:
        if self._bag is None:
            raise RuntimeError("Bag is not open. Call open() before reading.")
        return self._bag

    def _restart(self, sought: bool = False) -> None:
        bag, chosen = self._open_bag(), {name for name in self._open_bag().topics if self._passes(name)}
        if self._reverse:
            end = self._begin if sought or self._begin else bag.end
            earlier = (message for message in bag.messages(chosen) if message.received <= end)
            self._messages = iter(sorted(earlier, key=lambda message: message.received, reverse=True))
        else:
            self._messages = bag.messages(chosen, max(0, self._begin))
        self._advance()

    def _advance(self) -> None:
        try:
            self._next = next(self._messages, None)
        except (BagError, OSError) as error:
            raise RuntimeError(str(error)) from None

    def _passes(self, name: str) -> bool:
        wanted, named = self._filter, [*self._filter.topics, *self._filter.services_events]
        try:
            if name in wanted.exclude_topics or name in wanted.exclude_service_events:
                return False
            if wanted.regex_to_exclude and re.fullmatch(wanted.regex_to_exclude, name):
                return False
            if not named and not wanted.regex:
                return True
            return name in named or bool(wanted.regex and re.fullmatch(wanted.regex, name))
        except re.error as error:
            raise RuntimeError(f"the filter has no regular expression: {error}") from None


class Info:
    """What a bag tells of itself."""

    def read_metadata(self, uri: str, storage_id: str = "") -> BagMetadata:
        bag = _opened(uri)
        return BagMetadata.of(bag.metadata, bag.size)


class Reindexer:
    """Writes `metadata.yaml` of a bag anew."""

    def reindex(self, storage_options: StorageOptions) -> None:
        try:
            reindex(Path(storage_options.uri))
        except BagError as error:
            raise RuntimeError(str(error)) from None


def _opened(uri: str) -> Bag:
    try:
        bag = Bag(Path(uri))
    except BagError as error:
        raise RuntimeError(str(error)) from None
    for sentence in bag.complaints:
        print(f"[WARN] [rosbag2_py]: {sentence}", file=sys.stderr)
    return bag


def get_registered_readers() -> set[str]:
    """Return the storages that are read."""
    return set(STORAGES)
