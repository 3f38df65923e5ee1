"""Registry of the protobuf classes of Gazebo's types, which are built on first use.

All classes are in one private descriptor pool, so that they cannot collide with a gz-msgs package installed beside this
one.
"""

from __future__ import annotations

import functools
import re
import threading
from pathlib import Path
from typing import Any

from google.protobuf import any_pb2, message_factory
from google.protobuf.descriptor import Descriptor
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message import Message

from gz_course.sim.did_you_mean import nearest_name
from gz_course.sim.gz.msgs.proto_reader import read_proto

PROTO_FOLDER = Path(__file__).with_name("proto")
_IMPORT_PREFIX = "gz/msgs/"
_PACKAGE = "gz.msgs."
_FORTRESS_PACKAGE = "ignition.msgs."
_PREFIXES = ("gz.msgs.", "gz_msgs.", "ignition.msgs.", "ign_msgs.")
_TOP_LEVEL = re.compile(r"^(message|enum)\s+(\w+)", re.MULTILINE)

_pool = DescriptorPool()
_loaded: set[str] = set()
_lock = threading.RLock()


class UnknownTypeError(ValueError):
    """An unknown message type; the error names the nearest ones."""


def load_file(stem: str) -> Any:
    """Return the FileDescriptor of `proto/<stem>.proto`, linked with everything it imports.

    Raises FileNotFoundError if there is no such file.
    """
    with _lock:
        _load(stem)
    return _pool.FindFileByName(f"{_IMPORT_PREFIX}{stem}.proto")


def _load(stem: str) -> None:
    if stem in _loaded:
        return
    path = PROTO_FOLDER / f"{stem}.proto"
    file = read_proto(path.read_text(encoding="utf-8"), f"{_IMPORT_PREFIX}{stem}.proto", str(path))
    for imported in file.dependency:
        if imported == any_pb2.DESCRIPTOR.name:
            _pool.AddSerializedFile(any_pb2.DESCRIPTOR.serialized_pb)
            continue
        _load(imported.removeprefix(_IMPORT_PREFIX).removesuffix(".proto"))
    _pool.AddSerializedFile(file.SerializeToString())
    _loaded.add(stem)


def file_stems() -> list[str]:
    """Return the names of all definition files, sorted: `twist` stands for `gz/msgs/twist.proto`."""
    return sorted(path.stem for path in PROTO_FOLDER.glob("*.proto"))


@functools.cache
def _file_of_each_type() -> dict[str, tuple[str, str]]:
    """Return (kind, file stem) by top-level name, read from the texts of all files without linking them."""
    homes: dict[str, tuple[str, str]] = {}
    for stem in file_stems():
        text = (PROTO_FOLDER / f"{stem}.proto").read_text(encoding="utf-8")
        homes.update({name: (kind, stem) for kind, name in _TOP_LEVEL.findall(text)})
    return homes


@functools.cache
def _fortress_files() -> dict[str, str]:
    """Return the file stem by name for the messages that differ in Fortress."""
    homes: dict[str, str] = {}
    for path in sorted((PROTO_FOLDER / "fortress").glob("*.proto")):
        found = _TOP_LEVEL.findall(path.read_text(encoding="utf-8"))
        homes.update({name: f"fortress/{path.stem}" for kind, name in found if kind == "message"})
    return homes


def differs_in_fortress(name: str) -> bool:
    """Return whether a type, in any spelling, has other bytes in Fortress (`ignition.msgs.X`) than in `gz.msgs.X`."""
    return canonical_name(name).removeprefix(_PACKAGE) in _fortress_files()


def type_names() -> list[str]:
    """Return the full names of all top-level message types, sorted: `["gz.msgs.Actuators", ...]`."""
    return sorted(_PACKAGE + name for name, (kind, _) in _file_of_each_type().items() if kind == "message")


@functools.lru_cache(maxsize=1024)
def canonical_name(name: str) -> str:
    """Return a type name in the spelling `gz.msgs.X`; the names of other packages are returned unchanged.

    `ignition.msgs.Twist`, as Fortress calls it, `ign_msgs.Twist` and `gz_msgs.Twist` become `gz.msgs.Twist`.
    """
    bare = name.removeprefix(".")
    for prefix in _PREFIXES:
        if bare.startswith(prefix):
            return _PACKAGE + bare.removeprefix(prefix)
    return bare


def class_of(descriptor: Descriptor) -> type[Message]:
    """Return the class of a message type, with its nested types as attributes.

    protobuf's implementation in Python, which PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION chooses, does not set these.
    """
    made = message_factory.GetMessageClass(descriptor)
    for nested in descriptor.nested_types:
        if not hasattr(made, nested.name):
            setattr(made, nested.name, class_of(nested))
    return made


@functools.lru_cache(maxsize=1024)
def message_class(name: str) -> type[Message]:
    """Return the class of a message type.

    Accepts `gz.msgs.Twist`, `gz_msgs.Twist`, `.gz.msgs.Twist`, `ignition.msgs.Twist`, bare `Twist`, and nested types
    (`gz.msgs.Header.Map`). `ignition.msgs.IMU` is a class of its own, because its bytes differ. Raises
    UnknownTypeError with the nearest names for anything else.
    """
    bare = canonical_name(name).removeprefix(_PACKAGE)
    if name.removeprefix(".") == _FORTRESS_PACKAGE + bare and bare in _fortress_files():
        load_file(_fortress_files()[bare])
        return class_of(_pool.FindMessageTypeByName(_FORTRESS_PACKAGE + bare))
    kind, stem = _file_of_each_type().get(bare.partition(".")[0], ("", ""))
    if kind == "message":
        load_file(stem)
        try:
            return class_of(_pool.FindMessageTypeByName(_PACKAGE + bare))
        except KeyError:
            pass
    near = nearest_name(bare.rpartition(".")[2], (full.removeprefix(_PACKAGE) for full in type_names()))
    hint = f"did you mean '{_PACKAGE}{near}'?" if near else "`gz.msgs.type_names()` lists them all."
    raise UnknownTypeError(f"There is no message type {name!r} in gz.msgs; {hint}")
