"""The text of `ros2 bag info`.

Source: rosbag2_py 0.26 (`format_bag_metadata.cpp`)
"""

from __future__ import annotations

import time
from collections.abc import Iterable

from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS
from gz_course.sim.ros.rosbag2.storage.metadata import Metadata, Topic

_INDENT = " " * 19
_UNITS = ("B", "KiB", "MiB", "GiB", "TiB")


def summary(metadata: Metadata, size: int, verbose: bool = False) -> str:
    """Return what a bag holds, in lines; `size` is that of its files [byte]."""
    services = [topic for topic in metadata.topics if topic.name.endswith(SERVICE_EVENTS)]
    topics = [topic for topic in metadata.topics if topic not in services]
    lines = {
        "Files": _block(file.path for file in metadata.files),
        "Bag size": _size(size),
        "Storage id": metadata.storage,
        "ROS Distro": metadata.distro or "unknown",
        "Duration": f"{_seconds(metadata.duration)}s",
        "Start": _date(metadata.start),
        "End": _date(metadata.start + metadata.duration),
        "Messages": str(metadata.count),
        "Topic information": _block(_topic(topic, metadata, verbose) for topic in topics),
        "Service": str(len(services)),
        "Service information": _block(_service(topic, metadata) for topic in services),
    }
    if verbose:
        lines |= {"File information": _block(f"{f.path} | {_seconds(f.duration)}s | {f.count}" for f in metadata.files)}
        lines |= {"Custom data": _block(f"{key}={value}" for key, value in metadata.custom_data.items())}
    return "\n" + "\n".join(f"{f'{name}:':<18} {value}" for name, value in lines.items())


def _block(lines: Iterable[str]) -> str:
    return f"\n{_INDENT}".join(lines)


def _topic(topic: Topic, metadata: Metadata, verbose: bool) -> str:
    parts = {
        "Topic": topic.name,
        "Type": topic.type,
        "Count": metadata.counts.get(topic.name, 0),
        "Serialization Format": topic.serialization_format,
    }
    if verbose:
        offered = ", ".join(sorted({f"{each.reliability} {each.durability}" for each in topic.qos}))
        parts |= {"QoS": offered or "unknown", "Type hash": topic.type_hash or "unknown"}
    return " | ".join(f"{name}: {value}" for name, value in parts.items())


def _service(topic: Topic, metadata: Metadata) -> str:
    parts = {
        "Service": topic.name.removesuffix(SERVICE_EVENTS),
        "Type": topic.type.removesuffix("_Event"),
        "Event Count": metadata.counts.get(topic.name, 0),
        "Serialization Format": topic.serialization_format,
    }
    return " | ".join(f"{name}: {value}" for name, value in parts.items())


def _seconds(nanoseconds: int) -> str:
    return f"{nanoseconds // 10**9}.{nanoseconds % 10**9:09}"


def _date(nanoseconds: int) -> str:
    try:
        day = time.strftime("%b %e %Y %H:%M:%S", time.localtime(nanoseconds // 10**9))
    except (OverflowError, ValueError, OSError):
        return f"({_seconds(nanoseconds)})"
    return f"{day}.{nanoseconds % 10**9:09} ({_seconds(nanoseconds)})"


def _size(size: float) -> str:
    unit = 0
    while size >= 1024 and unit < len(_UNITS) - 1:
        size /= 1024
        unit += 1
    return f"{size:.0f} B" if unit == 0 else f"{size:.1f} {_UNITS[unit]}"
