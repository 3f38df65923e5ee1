"""Reading and writing bags in Python: what `import rosbag2_py` gives where no ROS 2 is installed.

Source: rosbag2_py 0.26 of ROS 2 Jazzy (`_storage.pyi`, `_reader.pyi`, `_writer.pyi`): names, arguments and defaults
"""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.rosbag2_py.reader import Info, Reindexer, SequentialReader, get_registered_readers
from gz_course.sim.ros.rosbag2_py.storage import (
    BagMetadata,
    ConverterOptions,
    FileInformation,
    MessageDefinition,
    ReadOrder,
    ReadOrderSortBy,
    StorageFilter,
    StorageOptions,
    TopicInformation,
    TopicMetadata,
    get_default_storage_id,
)
from gz_course.sim.ros.rosbag2_py.writer import SequentialWriter, get_registered_serializers, get_registered_writers

__all__ = [
    "BagMetadata",
    "ConverterOptions",
    "FileInformation",
    "Info",
    "MessageDefinition",
    "ReadOrder",
    "ReadOrderSortBy",
    "Reindexer",
    "SequentialReader",
    "SequentialWriter",
    "StorageFilter",
    "StorageOptions",
    "TopicInformation",
    "TopicMetadata",
    "get_default_storage_id",
    "get_registered_readers",
    "get_registered_serializers",
    "get_registered_writers",
]

_COMMANDS = {"Recorder": "record", "RecordOptions": "record", "Player": "play", "PlayOptions": "play"}
_COMMANDS |= {"bag_rewrite": "convert"}


def __getattr__(name: str) -> Any:
    if name in _COMMANDS:
        raise AttributeError(f"rosbag2_py has no {name} here; run `ros2 bag {_COMMANDS[name]}` as a process instead")
    raise AttributeError(f"module 'rosbag2_py' has no attribute {name!r}")
