"""Every kind of field, against a package that is compiled for the test with ROS's generators and a C compiler."""

import importlib
import shutil

import pytest
from rclpy.serialization import deserialize_message, serialize_message

from gz_course.sim.ros.rosidl.cdr_reader import decoder
from gz_course.sim.ros.rosidl.cdr_writer import encoder
from gz_course.sim.ros.rosidl.interface_classes import classes_of
from gz_course.tests.sim.ros.rosidl import compiled_package, every_kind
from gz_course.tests.sim.ros.rosidl.messages import as_values, fill, seeded

PACKAGE = "compiled_kinds_msgs"
HEADER = b"\0\1\0\0"


@pytest.fixture(scope="module")
def pairs(tmp_path_factory):
    if shutil.which("g++") is None:
        pytest.skip("there is no C++ compiler")
    folder = tmp_path_factory.mktemp("compiled")
    texts = {name[:-4]: text for name, text in every_kind.TEXTS.items() if name.endswith(".msg")}
    share = folder / "share" / PACKAGE
    for name, text in texts.items():
        (share / name).parent.mkdir(parents=True, exist_ok=True)
        (share / f"{name}.msg").write_text(text)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(compiled_package.build(folder, PACKAGE, texts))
        module = importlib.import_module(f"{PACKAGE}.msg")
        names = [name.partition("/")[2] for name in texts]
        yield [(classes_of(share / "msg" / f"{name}.msg", PACKAGE)[name], getattr(module, name)) for name in names]


@pytest.mark.proof
def test_classes_and_bytes_of_every_kind(pairs):
    pick = seeded()
    for ours, theirs in pairs:
        assert ours.SLOT_TYPES == theirs.SLOT_TYPES
        assert ours.get_fields_and_field_types() == theirs.get_fields_and_field_types()
        assert repr(ours()) == repr(theirs())
        for name in {name for name in dir(type(theirs)) if name.isupper()}:
            assert repr(getattr(ours, name)) == repr(getattr(theirs, name))
        for _ in range(300):
            state = pick.getstate()
            mine = fill(ours(), pick)
            pick.setstate(state)
            twin = fill(theirs(), pick)
            wanted = as_values(twin)
            assert as_values(deserialize_message(HEADER + encoder(ours)(mine), theirs)) == wanted, ours
            assert as_values(decoder(ours)(serialize_message(twin)[4:])) == wanted, ours
