"""The ROS topics of a run as MCAP in simulated time, for Foxglove, Rerun, PlotJuggler and `ros2 bag play`.

The messages are made from the recording, which keeps their numbers, texts, lists of both, and lists of messages that
hold nothing but numbers and texts (`/tf`); a stamp is the time at which the message was seen. Pictures are those of the
recording, `TOPIC/compressed`. Topics whose messages the recording does not hold whole (raw images, clouds of more than
20,000 bytes, lists within lists) are left out, and named in the metadata of the file. With several trials it is the
first.

Source: https://mcap.dev/spec/registry (profile `ros2`)
"""

from __future__ import annotations

import bisect
import io
import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from gz_course.grader.report.format import Format

if TYPE_CHECKING:
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.report.report import Report

_TYPE = "ros_type"  # component of a topic's entity
_LOGS = {"log/student": "submission", "log/given_node": "given_node", "log/grader": "grader"}
_LEVELS = {"DEBUG": 10, "INFO": 20, "WARN": 30, "WARNING": 30, "ERROR": 40, "FATAL": 50, "CRITICAL": 50}
_TIMES = frozenset({"builtin_interfaces/msg/Time"})
_COMPRESSED = "sensor_msgs/msg/CompressedImage"
_WHOLE_NUMBERS = ("int", "uint", "byte", "char")
_TEXTS = ("string", "wstring")
Leaves = dict[str, Any]
"""The type of each field by its path; a field that is a list of messages has the Leaves of one of them."""
Row = tuple[int, str, str, dict[str, Any]]  # time [ns], topic, type, fields


def as_mcap(report: Report) -> bytes:
    """Return an MCAP file. Raises UsageError if the recording cannot be read."""
    from mcap_ros2.writer import Writer

    from gz_course.sim.ros.rosbag2.definitions import definition

    recording = report.trials[0].content() if report.trials else _read(report)
    out = io.BytesIO()
    writer = Writer(out)
    left_out: list[str] = []
    schemas: dict[str, Any] = {}
    for time, topic, kind, fields in sorted(_rows(recording, left_out), key=lambda row: row[0]):
        if kind not in schemas:
            schemas[kind] = writer.register_msgdef(kind, definition(kind)[1])
        writer.write_message(topic, schemas[kind], fields, log_time=time, publish_time=time)
    facts = {"exercise": report.exercise, "outcome": report.score.outcome, "topics_left_out": " ".join(left_out)}
    writer.add_metadata("gz_course", facts)
    writer.finish()
    return out.getvalue()


def _read(report: Report) -> Recording:
    from gz_course.grader.record.reading import Recording

    return Recording(report.recording)


def _rows(recording: Recording, left_out: list[str]) -> Iterator[Row]:
    """Yield the messages of all topics; those that cannot be made again are added to `left_out`."""
    topics = {entity: recording.static(entity).get(_TYPE) for entity in recording.entities("topics", _TYPE)}
    for entity, kind in topics.items():
        topic = entity.removeprefix("topics")
        times, pictures = recording.pictures(entity)
        frame = _Text(recording, f"{entity}/header/frame_id")
        for time, picture in zip(times.tolist(), pictures, strict=True):
            header = {"stamp": _stamp(time), "frame_id": frame.at(time)}
            fields = {"header": header, "format": "jpeg", "data": picture}
            yield time, f"{topic}/compressed", _COMPRESSED, fields
        leaves = _leaves(str(kind))
        if leaves is None or not _is_whole(recording, entity, leaves):
            left_out.append(topic)
            continue
        yield from _messages(recording, entity, str(kind), leaves)
    for entity, name in _LOGS.items():
        for line in recording.lines(entity):
            level = _LEVELS.get(line.level, 20)
            log: dict[str, Any] = {"stamp": _stamp(line.time_ns), "level": level, "name": name, "msg": line.text}
            yield line.time_ns, "/rosout", "rcl_interfaces/msg/Log", log


def _leaves(kind: str) -> Leaves | None:
    """Return the fields of a message that are no messages themselves; None if the recording cannot keep them."""
    from gz_course.sim.ros.rosbag2.definitions import UNKNOWN, definition, nested_types, parts_of

    encoding, text = definition(kind)
    if encoding == UNKNOWN[0]:
        return None
    parts = parts_of(kind, text)

    def walk(name: str, path: str, found: Leaves, within_list: bool) -> bool:
        for line in parts[name].splitlines():
            words = line.partition("#")[0].split()
            if len(words) < 2 or "=" in line.partition("#")[0].replace("<=", ""):
                continue  # a comment or a constant
            here = f"{path}/{words[1]}"
            inner = next(nested_types(line, name.partition("/")[0]), "")
            if inner in _TIMES and words[1] == "stamp":
                found[here] = "stamp"
            elif "[" in words[0] and (within_list or words[0].startswith("bool")):
                return False
            elif inner and "[" in words[0]:
                found[here] = {}
                if not walk(inner, "", found[here], True):
                    return False
            elif inner:
                if not walk(inner, here, found, within_list):
                    return False
            else:
                found[here] = words[0]
        return True

    found: Leaves = {}
    return found if walk(kind, "", found, False) else None


def _is_whole(recording: Recording, entity: str, leaves: Leaves) -> bool:
    """Return whether the recording has the content of messages: long lists are not kept."""
    from gz_course.grader.record.messages import EACH, NOT_KEPT

    for path, kind in leaves.items():
        if isinstance(kind, dict):
            lines = recording.lines(f"{entity}{path}/{EACH}")
            if not lines or any(line.text == NOT_KEPT for line in lines):
                return False
        elif "[" in kind and kind.startswith(_TEXTS):
            if any(line.text == NOT_KEPT for line in recording.lines(f"{entity}{path}")):
                return False
        elif "[" in kind and path.endswith("/data") and not recording.has(f"{entity}{path}"):
            return False
    return True


def _messages(recording: Recording, entity: str, kind: str, leaves: Leaves) -> Iterator[Row]:
    plain = {path: each for path, each in leaves.items() if isinstance(each, str) and each != "stamp"}
    numbers = [path for path, each in plain.items() if "[" not in each and not each.startswith(_TEXTS)]
    lists = [path for path, each in plain.items() if "[" in each and not each.startswith(_TEXTS)]
    columns: dict[str, Any] = {path: recording.signal(f"{entity}{path}") for path in numbers}
    main = next(iter(columns.values())) if columns else recording.signal(f"{entity}/count")
    rows = {path: recording.arrays(f"{entity}{path}") for path in lists}
    said = {path: _Text(recording, f"{entity}{path}") for path, each in plain.items() if each.startswith(_TEXTS)}
    each_of = {path: _Each(recording, f"{entity}{path}", of) for path, of in leaves.items() if isinstance(of, dict)}
    places = dict.fromkeys(lists, 0)
    for number, time in enumerate(main.times.tolist()):
        fields: dict[str, Any] = {}
        for path, column in columns.items():
            _set(fields, path, _number(column.values[number], leaves[path]) if number < len(column) else 0)
        for path in lists:
            times, values = rows[path]
            place = places[path]
            while place < len(times) and times[place] < time:
                place += 1
            if place < len(times) and times[place] == time:
                _set(fields, path, [_number(value, leaves[path]) for value in values[place].tolist()])
                place += 1
            places[path] = place
        for path, text in said.items():
            _set(fields, path, json.loads(text.at(time) or "[]") if "[" in leaves[path] else text.at(time))
        for path, inner in each_of.items():
            _set(fields, path, inner.at(number, time))
        for path, what in leaves.items():
            if what == "stamp":
                _set(fields, path, _stamp(time))
        yield time, entity.removeprefix("topics"), kind, fields


class _Each:
    """A list of messages over time: a line of texts for each message on the topic, numbers for those with any."""

    def __init__(self, recording: Recording, entity: str, leaves: Leaves) -> None:
        from gz_course.grader.record.messages import EACH

        self._leaves = leaves
        self._lines = [line.text for line in recording.lines(f"{entity}/{EACH}")]
        self._rows = iter(recording.arrays(f"{entity}/{EACH}")[1])
        self._has_numbers = any(not each.startswith((*_TEXTS, "stamp")) for each in leaves.values())

    def at(self, number: int, time: int) -> list[dict[str, Any]]:
        """Return the messages in the list of the next message on the topic, which is this one."""
        texts = json.loads(self._lines[number]) if number < len(self._lines) else []
        row = next(self._rows, None) if texts and self._has_numbers else None
        numbers = iter(() if row is None else row.tolist())
        return [self._one(iter(words), numbers, time) for words in texts]

    def _one(self, words: Iterator[str], numbers: Iterator[float], time: int) -> dict[str, Any]:
        fields: dict[str, Any] = {}
        for path, kind in self._leaves.items():
            if kind == "stamp":
                _set(fields, path, _stamp(time))
            elif kind.startswith(_TEXTS):
                _set(fields, path, next(words, ""))
            else:
                _set(fields, path, _number(next(numbers, 0.0), kind))
        return fields


def _set(fields: dict[str, Any], path: str, value: Any) -> None:
    *above, last = path.strip("/").split("/")
    for name in above:
        fields = fields.setdefault(name, {})
    fields[last] = value


def _number(value: float, kind: str) -> Any:
    if kind.startswith("bool"):
        return bool(value)
    return int(value) if kind.startswith(_WHOLE_NUMBERS) else float(value)


def _stamp(time: int) -> dict[str, int]:
    seconds, nanoseconds = divmod(time, 10**9)
    return {"sec": seconds, "nanosec": nanoseconds}


class _Text:
    """A text field over time: recorded only when it changes."""

    def __init__(self, recording: Recording, entity: str) -> None:
        self._lines = recording.lines(entity)
        self._times = [line.time_ns for line in self._lines]

    def at(self, time: int) -> str:
        place = bisect.bisect_right(self._times, time)
        return self._lines[place - 1].text if place else ""


FORMAT = Format(
    as_text=as_mcap,
    file="run.mcap",
    help="Write the run's ROS topics as MCAP, in simulated time, for Foxglove, Rerun and `ros2 bag play`.",
)
