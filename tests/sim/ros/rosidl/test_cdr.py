"""Messages as bytes: every kind of field, values that do not fit, and bytes that are no message."""

import array
import random
import struct
import tracemalloc

import numpy
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.ros.rosidl.cdr_reader import MalformedError, decoder
from gz_course.sim.ros.rosidl.cdr_writer import encoder
from gz_course.tests.sim.ros.rosidl import every_kind
from gz_course.tests.sim.ros.rosidl.messages import as_values, fill, message_pairs, seeded


@pytest.fixture(scope="module")
def classes(tmp_path_factory, packages_in):
    with pytest.MonkeyPatch.context() as patch:
        prefix = tmp_path_factory.mktemp("prefix")
        patch.setenv("AMENT_PREFIX_PATH", str(prefix), prepend=":")
        (module, *_) = packages_in(prefix).load(every_kind.TEXTS)
        yield {name: getattr(module, name) for name in every_kind.MESSAGES}


@given(seed=st.integers(0, 2**32))
def test_what_is_written_is_read_again(classes, seed):
    for made in classes.values():
        message = fill(made(), random.Random(seed))
        data = encoder(made)(message)
        assert as_values(decoder(made)(data)) == as_values(message)
        assert encoder(made)(decoder(made)(data)) == data


def test_alignment_counts_from_the_first_byte(packages):
    (module,) = packages.load({"msg/A.msg": "uint8 a\nfloat64 b\nuint8 c\nuint16[] d\nstring e\nint64[] f\nwstring g"})
    data = encoder(module.A)(module.A(a=1, b=2.0, c=3, d=[4], e="xy", f=[], g="ü"))
    assert data == struct.pack("<B7xdB3xIH2xI3sxII", 1, 2.0, 3, 1, 4, 3, b"xy\0", 0, 1) + "ü".encode("utf-32-le")


def test_a_sender_of_the_other_byte_order_is_understood(packages):
    (module,) = packages.load({"msg/A.msg": "int32 a\nfloat32[] b\nint16[2] c\nstring d\nwstring e"})
    data = struct.pack(">iIffhhI2s2xI", 5, 2, 1.5, -2.0, 3, -4, 2, b"x\0", 1) + "ü".encode("utf-32-be")
    message = decoder(module.A, ">")(data)
    assert (message.a, message.b, message.d, message.e) == (5, array.array("f", [1.5, -2.0]), "x", "ü")
    assert message.c.tolist() == [3, -4] and message.c.dtype == numpy.int16


def test_a_text_ends_at_its_zero_as_in_c(packages):
    (module,) = packages.load({"msg/A.msg": "string a"})
    assert decoder(module.A)(encoder(module.A)(module.A(a="ab\0cd"))).a == "ab"
    assert decoder(module.A)(struct.pack("<I", 0)).a == ""
    assert decoder(module.A)(struct.pack("<I3s", 3, b"a\xff\0")).a == "a�"


def test_arrays_are_those_of_the_fields(packages):
    (module,) = packages.load({"msg/A.msg": "uint8[] a\nfloat64[4] b\nuint8[<=2] c"})
    sent = module.A(a=b"\1\2", b=numpy.arange(8.0).reshape(4, 2)[:, 0], c=(1, 2))
    got = decoder(module.A)(encoder(module.A)(sent))
    assert (got.a, got.b.tolist(), got.c) == (array.array("B", [1, 2]), [0, 2, 4, 6], array.array("B", [1, 2]))
    got.b[0] = 5  # it is writable, and nothing that other messages share


@pytest.mark.parametrize(
    ("text", "values", "words"),
    [
        ("float64[4] a", {"a": [1.0, 2.0]}, "expected 4 elements, found 2"),
        ("uint8[<=2] a", {"a": [1, 2, 3]}, "expected at most 2 elements, found 3"),
        ("string[2] a", {"a": ["x"]}, "expected 2 elements, found 1"),
        ("byte[] a", {"a": [b"ab"]}, "type 'bytes' with length 1"),
        ("int8 a", {"a": 200}, "format requires"),
    ],
)
def test_values_that_do_not_fit_are_refused(packages, text, values, words):
    (module,) = packages.load({"msg/A.msg": text})
    with pytest.raises((ValueError, struct.error), match=words):
        encoder(module.A)(module.A(**values))


def test_a_count_is_checked_before_anything_of_that_size_is_made(packages):
    kinds = ["float64", "string", "N", "bool", "wstring", "byte"]
    texts = {f"msg/K{i}.msg": f"{kind}[] a" for i, kind in enumerate(kinds)}
    (module,) = packages.load({**texts, "msg/N.msg": ""})
    tracemalloc.start()
    try:
        for name in module.__all__:
            if name != "N":
                with pytest.raises(MalformedError, match=r"2147483647 elements are announced, \d bytes follow"):
                    decoder(getattr(module, name))(struct.pack("<I", 2**31 - 1) + bytes(4))
        assert tracemalloc.get_traced_memory()[1] < 1_000_000
    finally:
        tracemalloc.stop()


def test_a_bound_holds_for_what_arrives(packages):
    (module,) = packages.load({"msg/A.msg": "uint8[<=2] a"})
    with pytest.raises(MalformedError, match="a sequence has 3 elements, at most 2 are allowed"):
        decoder(module.A)(struct.pack("<I3B", 3, 1, 2, 3))


def damaged(data, pick):
    """Return bytes with an error: cut off, changed, made longer, or without a meaning from the beginning."""
    kind = pick.randrange(4)
    if kind == 0:
        return data[: pick.randrange(len(data))]
    changed = bytearray(data)
    for _ in range(pick.randint(1, 4)):
        place = pick.randrange(len(changed))
        if kind == 1:
            changed[place] = pick.randrange(256)
        else:
            changed[place : place + 4] = struct.pack("<I", pick.choice([0, 1, 255, 2**31, 2**32 - 1]))
    return bytes(changed) if kind < 3 else pick.randbytes(pick.randrange(200))


def read_damaged(classes, count):
    pick = seeded(7)
    refused = 0
    for number in range(count):
        made = classes[number % len(classes)]
        data = damaged(encoder(made)(fill(made(), pick)), pick)
        try:
            message = decoder(made, pick.choice("<>"))(data)
        except MalformedError:
            refused += 1
            continue
        assert len(encoder(made)(message)) <= 3 * len(data) + 64
    assert count > refused > count / 10


def test_damaged_bytes_are_refused_or_read(classes):
    read_damaged(list(classes.values()), 1000)


@pytest.mark.proof
def test_a_hundred_thousand_damaged_messages(classes):
    read_damaged([*classes.values(), *(ours for ours, _ in message_pairs())], 100_000)
