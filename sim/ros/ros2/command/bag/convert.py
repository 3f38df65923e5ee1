"""Given an input bag, write out a new bag with different settings."""

from __future__ import annotations

import argparse
import heapq
from pathlib import Path
from typing import Any

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.bag import bag_errors, opened
from gz_course.sim.ros.ros2.errors import UsageError
from gz_course.sim.ros.rosbag2.errors import BagError
from gz_course.sim.ros.rosbag2.selection import Selection, absolute
from gz_course.sim.ros.rosbag2.storage.bag import Bag
from gz_course.sim.ros.rosbag2.storage.bag_writer import STORAGES, BagWriter
from gz_course.sim.ros.rosbag2.storage.compression import FORMAT, MODES
from gz_course.sim.ros.rosbag2.storage.yaml_text import load_yaml

_KEYS: dict[str, Any] = {
    **{"uri": str, "storage_id": str, "storage_preset_profile": str, "custom_data": dict},
    **{"all": bool, "all_topics": bool, "topics": list, "topic_types": list, "regex": str, "exclude_regex": str},
    **{"exclude_topics": list, "exclude_topic_types": list, "exclude": str},
    **{"max_bagfile_size": int, "max_bagfile_duration": int, "max_cache_size": int},
    **{"rmw_serialization_format": str, "output_serialization_format": str},
    **{"compression_mode": str, "compression_format": str},
}
"""The keys of an output bag and the types of their values."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-i", "--input", nargs="+", action="append", required=True, metavar="BAG", help="Bag to read, then its storage"
    )
    parser.add_argument(
        "-o", "--output-options", type=Path, required=True, metavar="FILE", help="YAML file with a list 'output_bags'"
    )


def main(arguments: argparse.Namespace) -> None:
    for words in arguments.input:
        if len(words) > 2 or (len(words) == 2 and words[1] not in STORAGES):
            raise UsageError(f"--input takes a bag and its storage ({', '.join(STORAGES)}), not: {' '.join(words)}")
    with bag_errors():
        outputs = [_Output(values, arguments.output_options) for values in _output_bags(arguments.output_options)]
        inputs = [opened(Path(words[0])) for words in arguments.input]
        for output in outputs:
            output.write(inputs)


class _Output:
    """One output bag: what goes into it, and how it is written. Raises BagError."""

    def __init__(self, values: dict[str, Any], file: Path) -> None:
        for key, value in values.items():
            if key not in _KEYS:
                raise BagError(f"{file}: unknown key '{key}' of an output bag{did_you_mean(str(key), _KEYS)}")
            if not isinstance(value, _KEYS[key]):
                raise BagError(f"{file}: '{key}' cannot be {str(value)[:80]!r}; expected {_KEYS[key].__name__}")
        if not values.get("uri"):
            raise BagError(f"{file}: an output bag has no 'uri', the folder to create")
        self._storage = values.get("storage_id") or "mcap"
        if self._storage not in STORAGES:
            raise BagError(f"{file}: unknown 'storage_id' {self._storage!r}{did_you_mean(self._storage, STORAGES)}")
        self._compression = (values.get("compression_mode") or "none").lower()
        if self._compression not in MODES:
            raise BagError(f"{file}: 'compression_mode' can be {', '.join(MODES)}, not {self._compression!r}")
        if values.get("compression_format", "") not in ("", FORMAT):
            raise BagError(f"{file}: 'compression_format' can be {FORMAT}, not {values['compression_format']!r}")
        self._preset = values.get("storage_preset_profile") or "none"
        self._folder = Path(values["uri"])
        self._values = values
        everything = values.get("all") or values.get("all_topics")
        chosen = [values.get(key) for key in ("topics", "regex", "topic_types")]
        self._selection = Selection(
            all=bool(everything) or not any(chosen),
            topics=tuple(absolute(str(name)) for name in values.get("topics", ())),
            regex=values.get("regex", ""),
            types=tuple(map(str, values.get("topic_types", ()))),
            without_regex=values.get("exclude_regex", "") or values.get("exclude", ""),
            without_topics=tuple(absolute(str(name)) for name in values.get("exclude_topics", ())),
            without_types=tuple(map(str, values.get("exclude_topic_types", ()))),
        )

    def write(self, bags: list[Bag]) -> None:
        """Write the messages of all input bags in the order of their times."""
        writer = BagWriter(
            self._folder,
            storage=self._storage,
            preset=self._preset,
            split_bytes=max(0, self._values.get("max_bagfile_size", 0)),
            split_ns=max(0, self._values.get("max_bagfile_duration", 0)) * 10**9,
            custom_data={str(key): str(value) for key, value in self._values.get("custom_data", {}).items()},
            compression=self._compression,
        )
        chosen: set[str] = set()
        for bag in bags:
            definitions = bag.definitions()
            for name, topic in bag.topics.items():
                if self._selection.takes(name, topic.type):
                    chosen.add(name)
                    writer.add_topic(topic, definitions.get(topic.type) or _installed_definition(topic.type))
        streams = [bag.messages(chosen) for bag in bags]
        for message in heapq.merge(*streams, key=lambda message: message.received):
            writer.write(message.topic, message.received, message.sent, message.data)
        writer.close()
        print(f"{self._folder}: {writer.metadata.count} messages of {len(chosen)} topics")


def _installed_definition(type_name: str) -> tuple[str, str]:
    """Return the definition of a type that a bag does not hold, as older `.db3` files."""
    from gz_course.sim.ros.rosbag2.definitions import definition

    return definition(type_name)


def _output_bags(file: Path) -> list[dict[str, Any]]:
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise BagError(f"{file} cannot be read: {getattr(error, 'strerror', None) or error}") from None
    values = load_yaml(text, str(file))
    bags = values.get("output_bags") if isinstance(values, dict) else None
    if not isinstance(bags, list) or not bags or not all(isinstance(each, dict) for each in bags):
        raise BagError(f"{file} must hold a list 'output_bags', and each of them a 'uri', the folder to create")
    return bags
