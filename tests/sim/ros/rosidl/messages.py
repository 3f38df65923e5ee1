"""Every installed interface made at run time, and messages with random values."""

import functools
import math
import random
import struct
import sys
from pathlib import Path

from rosidl_parser import definition as idl

from gz_course.sim.ros.rosidl.field_checks import TYPE_CODES, is_number_array
from gz_course.sim.ros.rosidl.interface_classes import classes_of
from gz_course.sim.ros.rosidl.interface_text import KINDS
from gz_course.sim.ros.rosidl.nested_classes import module_name, nested_class

SHARE = Path(sys.prefix, "share")
TEXTS = ["", "a", "laser", "ü€𝄞", "x" * 17]


@functools.cache
def installed():
    """Return the texts of all compiled interfaces, as (package, file)."""
    return [(path.parents[1].name, path) for kind in KINDS for path in sorted(SHARE.glob(f"*/{kind}/*.{kind}"))]


@functools.cache
def made(package, path):
    """Return what is made from a text: names and classes."""
    return classes_of(path, package)


@functools.cache
def compiled(package, path):
    """Return the module of the compiled interface."""
    name = f"{package}.{path.parent.name}.{module_name(path.stem)}"
    return __import__(name, fromlist=["x"])


def message_pairs():
    """Yield (class made at run time, compiled class) for every message, those in services and actions too."""
    for package, path in installed():
        for name, ours in made(package, path).items():
            if hasattr(ours, "SLOT_TYPES"):
                yield ours, getattr(compiled(package, path), name)


def fill(message, pick):
    """Give every field a random value; `pick` is a random.Random."""
    for name, kind in zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True):
        setattr(message, name, value(kind, pick))
    return message


def value(kind, pick):
    if isinstance(kind, idl.Array):
        values = [value(kind.value_type, pick) for _ in range(kind.size)]
        return values
    if isinstance(kind, idl.AbstractNestedType):
        most = min(getattr(kind, "maximum_size", 5), 5)
        return [value(kind.value_type, pick) for _ in range(pick.randint(0, most))]
    if isinstance(kind, idl.NamespacedType):
        return fill(nested_class(kind)(), pick)
    if isinstance(kind, idl.BasicType):
        return plain(kind.typename, pick)
    return pick.choice(TEXTS)[: getattr(kind, "maximum_size", None)]


def plain(typename, pick):
    if typename == "boolean":
        return pick.random() < 0.5
    if typename == "octet":
        return bytes([pick.randrange(256)])
    if typename == "float":
        return struct.unpack("f", struct.pack("f", pick.gauss(0, 1e3)))[0]
    if typename == "double":
        return pick.choice([pick.gauss(0, 1e9), math.inf, -0.0])
    bits = struct.calcsize(TYPE_CODES[typename]) * 8
    low = 0 if typename.startswith("u") else -(2 ** (bits - 1))
    return pick.choice([low, low + 2**bits - 1, pick.randrange(low, low + 2**bits)])


def as_values(message):
    """Return a message as plain Python values, to compare messages of different classes."""
    return [
        as_plain(getattr(message, name), kind)
        for name, kind in zip(message.get_fields_and_field_types(), message.SLOT_TYPES, strict=True)
    ]


def as_plain(held, kind):
    if is_number_array(kind):
        return held.tolist()
    if isinstance(kind, idl.AbstractNestedType):
        return [as_plain(each, kind.value_type) for each in held]
    return as_values(held) if isinstance(kind, idl.NamespacedType) else held


def seeded(number=0):
    return random.Random(number)
