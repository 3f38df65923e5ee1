"""Writes a bag, message by message."""

from __future__ import annotations

from pathlib import Path

from gz_course.sim.ros.rosbag2.definitions import definition
from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.storage.bag_writer import STORAGES, BagWriter
from gz_course.sim.ros.rosbag2_py.storage import ConverterOptions, StorageOptions, TopicMetadata, get_default_storage_id


class SequentialWriter:
    """Writes a new bag; it is finished by `close`, or when nobody uses the writer any more. Errors are RuntimeError."""

    def __init__(self) -> None:
        self._writer: BagWriter | None = None
        self._topics: set[str] = set()

    def open(self, storage_options: StorageOptions, converter_options: ConverterOptions | None = None) -> None:
        """Create the folder of the bag, which must not exist."""
        storage = storage_options.storage_id or get_default_storage_id()
        if storage not in STORAGES:
            raise RuntimeError(f"No storage could be initialized: there is no '{storage}', only {', '.join(STORAGES)}")
        self.close()
        try:
            self._writer = BagWriter(
                Path(storage_options.uri),
                storage=storage,
                preset=storage_options.storage_preset_profile or "none",
                split_bytes=storage_options.max_bagfile_size,
                split_ns=storage_options.max_bagfile_duration * 10**9,
                custom_data=dict(storage_options.custom_data),
            )
        except BagError as error:
            raise RuntimeError(str(error)) from None

    def create_topic(self, topic: TopicMetadata) -> None:
        """Make a topic known, before its first message."""
        made = topic.as_topic()
        try:
            self._open_writer().add_topic(made, definition(made.type))
        except BagError as error:
            raise RuntimeError(str(error)) from None
        self._topics.add(made.name)

    def write(self, topic_name: str, message: bytes, recv_timestamp: int, send_timestamp: int | None = None) -> None:
        """Add a serialised message with its times [ns]."""
        writer = self._open_writer()
        if topic_name not in self._topics:
            raise RuntimeError(f"Topic '{topic_name}' has not been created yet! Call 'create_topic' first.")
        sent = recv_timestamp if send_timestamp is None else send_timestamp
        try:
            writer.write(topic_name, recv_timestamp, sent, bytes(message))
        except BagError as error:
            raise RuntimeError(str(error)) from None

    def split_bagfile(self) -> None:
        """Continue in a new file."""
        try:
            self._open_writer().split()
        except BagError as error:
            raise RuntimeError(str(error)) from None

    def close(self) -> None:
        """Finish the bag."""
        writer, self._writer = self._writer, None
        self._topics.clear()
        if writer is not None:
            try:
                writer.close()
            except BagError as error:
                raise RuntimeError(str(error)) from None

    def _open_writer(self) -> BagWriter:
        if self._writer is None:
            raise RuntimeError("Bag is not open. Call open() before writing.")
        return self._writer

    def __del__(self) -> None:
        self.close()


def get_registered_writers() -> set[str]:
    """Return the storages that are written."""
    return set(STORAGES)


def get_registered_serializers() -> set[str]:
    """Return the formats of messages that are converted: none needs to be."""
    return {"cdr"}
