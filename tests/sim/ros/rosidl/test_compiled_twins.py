"""Every installed interface, made at run time from its text, is compared with its compiled twin."""

import inspect
import json

import pytest
from rclpy.serialization import deserialize_message, serialize_message

from gz_course.sim.ros.rosidl.cdr_reader import decoder
from gz_course.sim.ros.rosidl.cdr_writer import encoder
from gz_course.sim.ros.rosidl.definitions import definition
from gz_course.sim.ros.rosidl.type_description import full_description, individual_descriptions, type_hash
from gz_course.tests.sim.ros.rosidl.messages import as_values, compiled, fill, installed, made, message_pairs, seeded

HEADER = b"\0\1\0\0"  # little endian, XCDR version 1


def public(thing):
    return {name for name in dir(thing) if not name.startswith("_")}


def test_a_good_many_interfaces_are_compared():
    assert len(installed()) > 150
    assert len(list(message_pairs())) > 200


def test_every_module_has_the_same_classes():
    for package, path in installed():
        ours, theirs = made(package, path), compiled(package, path)
        wanted = {
            name for name, each in vars(theirs).items() if inspect.isclass(each) and each.__module__ == theirs.__name__
        }
        assert set(ours) == wanted
        for name in wanted:
            assert ours[name].__module__ == theirs.__name__
            assert ours[name].__qualname__ == getattr(theirs, name).__qualname__


def test_messages_have_the_same_fields_defaults_and_constants():
    for ours, theirs in message_pairs():
        assert ours.__slots__ == theirs.__slots__
        assert ours.SLOT_TYPES == theirs.SLOT_TYPES
        assert ours.get_fields_and_field_types() == theirs.get_fields_and_field_types()
        assert public(ours) == public(theirs) and public(type(ours)) == public(type(theirs))
        assert (ours.__doc__ or "").split() == (theirs.__doc__ or "").split()
        mine, twin = ours(), theirs()
        assert repr(mine) == repr(twin)
        assert as_values(mine) == as_values(twin)
        for name in public(type(theirs)) - public(type):
            assert getattr(ours, name) == getattr(theirs, name)
            assert getattr(mine, name) == getattr(twin, name)


def test_services_and_actions_hold_the_same_classes():
    for package, path in installed():
        if path.parent.name != "msg":
            ours, theirs = made(package, path)[path.stem], getattr(compiled(package, path), path.stem)
            assert public(ours) == public(theirs)
            with pytest.raises(NotImplementedError, match="classes can not be instantiated"):
                ours()


def test_descriptions_and_hashes_are_those_of_the_installed_files():
    known, compared = {}, 0
    for package, path in installed():
        known |= {each["type_name"]: each for each in individual_descriptions(definition(path, package))}
    for _, path in installed():
        there = json.loads(path.with_suffix(".json").read_text())
        name = there["type_description_msg"]["type_description"]["type_name"]
        ours = full_description(name, known)
        assert ours == there["type_description_msg"]
        for each in there["type_hashes"]:
            assert type_hash(full_description(each["type_name"], known)) == each["hash_string"]
            compared += 1
    assert compared > 200


def equal_bytes(rounds):
    pick = seeded()
    for ours, theirs in message_pairs():
        for _ in range(rounds):
            state = pick.getstate()
            mine = fill(ours(), pick)
            pick.setstate(state)
            twin = fill(theirs(), pick)
            data = serialize_message(twin)
            written = encoder(ours)(mine)
            assert as_values(deserialize_message(HEADER + written, theirs)) == as_values(twin), ours
            assert as_values(decoder(ours)(data[4:])) == as_values(twin)
            assert repr(mine) == repr(twin)


def test_random_values_have_the_same_bytes():
    equal_bytes(1)


@pytest.mark.proof
def test_many_random_values_have_the_same_bytes():
    equal_bytes(40)


@pytest.mark.proof
def test_random_values_pass_through_the_type_support():
    pick = seeded(1)
    for ours, theirs in message_pairs():
        state = pick.getstate()
        mine = fill(ours(), pick)
        pick.setstate(state)
        twin = fill(theirs(), pick)
        assert as_values(deserialize_message(serialize_message(twin), ours)) == as_values(twin)
        assert as_values(deserialize_message(serialize_message(mine), theirs)) == as_values(twin)


@pytest.mark.filterwarnings("ignore:.*ByteString:DeprecationWarning")  # of the compiled setters
def test_setters_check_and_say_the_same():
    tried = [None, 1, -1, 2**70, 1.5, 1e300, "text", b"x", b"xy", [1, 2], ["a"], [1.5] * 9, [b"x"], object()]
    for ours, theirs in message_pairs():
        mine, twin = ours(check_fields=True), theirs(check_fields=True)
        for name in ours.get_fields_and_field_types():
            for wrong in tried:
                assert said(mine, name, wrong) == said(twin, name, wrong), (ours, name, wrong)
        with pytest.raises(AssertionError, match="Invalid arguments passed to constructor: nothing_like_it"):
            ours(check_fields=True, nothing_like_it=1)


def said(message, name, wrong):
    try:
        setattr(message, name, wrong)
    except Exception as error:
        return type(error), str(error).partition("\n")[0]  # pytest adds to asserts in modules called `..._test`
    return None
