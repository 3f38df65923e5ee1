"""Lookups in trees of frames, compared with products of matrices and with motions whose formula is known."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.duration import Duration
from rclpy.time import Time

from gz_course.sim.ros.tf2_py import (
    BufferCore,
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TransformException,
)
from gz_course.tests.sim.ros.tf2_py.transforms import matrix, matrix_of, poses, stamped


def at(seconds):
    return Time(nanoseconds=round(seconds * 1e9))


def buffer_of(*transforms, static=()):
    made = BufferCore()
    for transform in transforms:
        made.set_transform(transform, "tester")
    for transform in static:
        made.set_transform_static(transform, "tester")
    return made


@st.composite
def trees(draw):
    """Draw frames: each is (its parent among those before it, its pose there, static or not)."""
    parents = [draw(st.integers(0, number)) for number in range(draw(st.integers(1, 8)))]
    return [(parent, draw(poses), draw(st.booleans())) for parent in parents]


@settings(max_examples=40)
@given(trees(), st.data())
def test_any_two_frames_of_any_tree(tree, data):
    buffer = BufferCore()
    absolute = [np.identity(4)]
    for number, (parent, (place, turn), is_static) in enumerate(tree, 1):
        message = stamped(f"frame{parent}", f"frame{number}", 1.0, place, turn)
        (buffer.set_transform_static if is_static else buffer.set_transform)(message, "tester")
        absolute.append(absolute[parent] @ matrix(place, turn))
    target, source, fixed = (data.draw(st.integers(0, len(tree))) for _ in range(3))
    expected = np.linalg.inv(absolute[target]) @ absolute[source]
    names = f"frame{target}", f"frame{source}"
    for time in (at(1.0), Time()):
        assert matrix_of(buffer.lookup_transform_core(*names, time)) == pytest.approx(expected, abs=1e-9)
        assert buffer.can_transform_core(*names, time) == (True, "")
    by_way_of = buffer.lookup_transform_full_core(names[0], at(1.0), names[1], at(1.0), f"frame{fixed}")
    assert matrix_of(by_way_of) == pytest.approx(expected, abs=1e-9)
    assert (by_way_of.header.frame_id, by_way_of.child_frame_id) == names


@settings(max_examples=40)
@given(poses, poses, st.floats(0.0, 1.0))
def test_between_two_stamps_the_motion_is_even(first, second, share):
    """The way is straight; the turn is about one axis, at constant speed, and never by more than half a turn."""
    buffer = buffer_of(stamped("a", "b", 1.0, *first), stamped("a", "b", 3.0, *second))
    found = matrix_of(buffer.lookup_transform_core("a", "b", at(1.0 + 2.0 * share)))
    share = round(share * 2e9) / 2e9
    place = np.array(first[0]) * (1.0 - share) + np.array(second[0]) * share
    assert found[:3, 3] == pytest.approx(place, abs=1e-6)
    whole = math.acos(min(1.0, abs(np.dot(first[1], second[1]))))  # half the angle between the two
    if whole < math.pi / 2 - 1e-6:  # else two ways are equally short
        for end, part in ((first, share), (second, 1.0 - share)):
            relative = matrix((0, 0, 0), end[1])[:3, :3].T @ found[:3, :3]
            assert (np.trace(relative) - 1.0) / 2.0 == pytest.approx(math.cos(2.0 * whole * part), abs=1e-6)


@settings(max_examples=20)
@given(st.floats(0.0, 4.0), st.floats(-2.0, 2.0), st.floats(0.1, 2.0))
def test_a_robot_on_a_circle(time, speed, height):
    """`map -> odom -> base -> arm -> lidar`: a body that turns evenly carries a static chain."""
    buffer = buffer_of(
        static=[
            stamped("map", "odom", place=(5.0, 0.0, 0.0)),
            stamped("base", "arm", place=(1.0, 0.0, 0.0)),
            stamped("arm", "lidar", place=(0.0, 0.0, height)),
        ]
    )
    for tick in range(41):
        half = speed * tick / 10.0 / 2.0
        message = stamped("odom", "base", 1.0 + tick / 10.0, turn=(0.0, 0.0, math.sin(half), math.cos(half)))
        buffer.set_transform(message, "tester")
    place = buffer.lookup_transform_core("map", "lidar", at(1.0 + time)).transform.translation
    angle = speed * round(time * 1e9) / 1e9
    assert (place.x, place.y, place.z) == pytest.approx((5.0 + math.cos(angle), math.sin(angle), height), abs=1e-6)


def test_two_times_and_a_frame_that_stands_still():
    moves = [stamped("map", "robot", 1.0 + tick, place=(tick, 0.0, 0.0)) for tick in range(4)]
    found = buffer_of(*moves).lookup_transform_full_core("robot", at(4.0), "robot", at(1.0), "map")
    assert found.transform.translation.x == -3.0
    assert found.header.stamp.sec == 4


def test_time_zero_is_the_latest_time_that_all_have():
    buffer = buffer_of(
        *(stamped("a", "b", seconds, place=(seconds, 0, 0)) for seconds in (1.0, 2.0, 5.0)),
        *(stamped("b", "c", seconds, place=(0, seconds, 0)) for seconds in (1.0, 3.0)),
        static=[stamped("c", "d", place=(0, 0, 7))],
    )
    found = buffer.lookup_transform_core("a", "d", Time())
    place = found.transform.translation
    assert (found.header.stamp.sec, place.x, place.y, place.z) == (3, 3.0, 3.0, 7.0)
    assert buffer.get_latest_common_time("d", "a").nanoseconds == 3 * 10**9
    assert buffer.get_latest_common_time("c", "d").nanoseconds == 0
    same = buffer.lookup_transform_core("b", "b", Time())
    assert (same.header.stamp.sec, same.transform.rotation.w) == (5, 1.0)
    assert buffer.lookup_transform_core("nowhere", "nowhere", at(2.0)).header.stamp.sec == 2


def test_a_time_may_be_a_message():
    message = stamped("a", "b", 2.5)
    buffer = buffer_of(message)
    assert buffer.lookup_transform_core("a", "b", message.header.stamp).header == message.header
    with pytest.raises(TypeError, match=r"time must have sec and nanosec, or nanoseconds\."):
        buffer.can_transform_core("a", "b", 2.5)


@pytest.fixture
def two_trees():
    return buffer_of(
        stamped("map", "odom", 1.0),
        stamped("map", "odom", 2.0),
        stamped("odom", "base", 1.5),
        stamped("sea", "boat", 1.0),
    )


@pytest.mark.parametrize(
    ("target", "source", "seconds", "kind", "sentence"),
    [
        ("", "base", 1.5, InvalidArgumentException,
         'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty'),
        ("map", "/base", 1.5, InvalidArgumentException,
         'Invalid argument "/base" passed to lookupTransform argument source_frame '
         "- in tf2 frame_ids cannot start with a '/'"),
        ("mpa", "base", 1.5, LookupException,
         '"mpa" passed to lookupTransform argument target_frame does not exist. '),
        ("map", "basis", 1.5, LookupException,
         '"basis" passed to lookupTransform argument source_frame does not exist. '),
        ("map", "boat", 1.0, ConnectivityException,
         "Could not find a connection between 'map' and 'boat' because they are not part of the same tree."
         "Tf has two or more unconnected trees."),
        ("map", "boat", 0.0, ConnectivityException,
         "Could not find a connection between 'map' and 'boat' because they are not part of the same tree."
         "Tf has two or more unconnected trees."),
        ("map", "odom", 2.5, ExtrapolationException,
         "Lookup would require extrapolation into the future.  Requested time 2.500000 but the latest data is at time "
         "2.000000, when looking up transform from frame [odom] to frame [map]"),
        ("odom", "map", 0.5, ExtrapolationException,
         "Lookup would require extrapolation into the past.  Requested time 0.500000 but the earliest data is at time "
         "1.000000, when looking up transform from frame [map] to frame [odom]"),
        ("map", "base", 1.75, ExtrapolationException,
         "Lookup would require extrapolation at time 1.750000, but only time 1.500000 is in the buffer, "
         "when looking up transform from frame [base] to frame [map]"),
    ],
)  # fmt: skip
def test_exceptions_and_their_texts(two_trees, target, source, seconds, kind, sentence):
    with pytest.raises(TransformException) as caught:
        two_trees.lookup_transform_core(target, source, at(seconds))
    assert type(caught.value) is kind
    assert str(caught.value) == sentence
    possible, why_not = two_trees.can_transform_core(target, source, at(seconds))
    assert not possible
    if kind in (ConnectivityException, ExtrapolationException):
        assert why_not == sentence
    with pytest.raises(kind):
        two_trees.lookup_transform_full_core(target, at(seconds), source, at(seconds), "map")


def test_why_a_frame_cannot_be_transformed(two_trees):
    for name, reason in (
        ("", "in tf2 frame_ids cannot be empty"),
        ("/map", "in tf2 frame_ids cannot start with a '/'"),
        ("mpa", "frame does not exist"),
    ):
        _, text = two_trees.can_transform_core(name, "base", Time())
        assert text == f'Invalid frame ID "{name}" passed to canTransform argument target_frame - {reason}'
    with pytest.raises(LookupException, match='"x" passed to get_latest_common_time does not exist'):
        two_trees.get_latest_common_time("x", "map")
    assert LookupException.__module__ == "tf2"


def test_the_latest_is_known_where_the_source_branch_has_no_data():
    """What lies above the point where both ways meet does not matter."""
    buffer = buffer_of(
        stamped("map", "base", 1.0), stamped("base", "left", 5.0, (0, 1, 0)), stamped("base", "right", 5.0, (0, -1, 0))
    )
    assert buffer.lookup_transform_core("left", "right", at(5.0)).transform.translation.y == -2.0


def test_a_loop_is_found():
    buffer = buffer_of(static=[stamped("a", "b"), stamped("b", "c"), stamped("c", "a"), stamped("x", "y")])
    for time in (Time(), at(1.0)):
        with pytest.raises(
            LookupException, match=r"The tf tree is invalid because it contains a loop\.\nFrame b exists"
        ):
            buffer.lookup_transform_core("y", "b", time)


def test_what_is_older_than_the_cache_time_goes(capfd):
    buffer = BufferCore(Duration(seconds=2.0))
    for tick in range(1000):
        buffer.set_transform(stamped("a", "b", 10.0 + tick / 10.0), "tester")
    assert buffer.can_transform_core("a", "b", at(108.0))[0]
    assert not buffer.can_transform_core("a", "b", at(107.0))[0]
    buffer.set_transform(stamped("a", "b", 50.0), "late")
    assert "Warning: TF_OLD_DATA ignoring data from the past for frame b at time 50.000000" in capfd.readouterr().err
    buffer.set_transform(stamped("a", "b", 109.05, place=(1, 0, 0)), "tester")
    assert buffer.lookup_transform_core("a", "b", at(109.05)).transform.translation.x == 1.0


@pytest.mark.parametrize(
    ("message", "word"),
    [
        (stamped("a", "a"), "TF_SELF_TRANSFORM"),
        (stamped("a", ""), "TF_NO_CHILD_FRAME_ID"),
        (stamped("", "b"), "TF_NO_FRAME_ID"),
        (stamped("a", "b", place=(math.nan, 0, 0)), "TF_NAN_INPUT"),
        (stamped("a", "b", turn=(0, 0, 0, 0)), "TF_DENORMALIZED_QUATERNION"),
        (stamped("a", "b", turn=(0, 0, math.inf, 1)), "TF_DENORMALIZED_QUATERNION"),
    ],
)
def test_a_transform_that_makes_no_sense_is_ignored(message, word, capfd):
    assert buffer_of(message, static=[message])._getFrameStrings() == []
    said = capfd.readouterr().err
    assert said.startswith("Error:   TF_") and word in said


def test_quaternions_are_normalised_and_names_lose_their_slash():
    found = buffer_of(stamped("/a", "/b", 1.0, turn=(0, 0, 0, -2))).lookup_transform_core("a", "b", Time())
    assert found.transform.rotation.w == 1.0


def test_a_frame_changes_its_parent_and_its_kind():
    buffer = buffer_of(stamped("a", "c", 1.0, (1, 0, 0)), stamped("b", "c", 2.0, (2, 0, 0)), static=[stamped("a", "b")])
    assert buffer.lookup_transform_core("a", "c", at(1.5)).transform.translation.x == 1.0
    assert buffer.lookup_transform_core("a", "c", Time()).transform.translation.x == 2.0
    buffer.set_transform_static(stamped("a", "c", place=(9, 0, 0)), "tester")
    assert buffer.lookup_transform_core("a", "c", at(77.0)).transform.translation.x == 9.0


def test_clear_keeps_what_is_static():
    buffer = buffer_of(stamped("a", "b", 1.0), static=[stamped("b", "c")])
    buffer.clear()
    assert buffer.can_transform_core("b", "c", Time())[0] and not buffer.can_transform_core("a", "b", Time())[0]
    assert buffer._getFrameStrings() == ["b", "a", "c"] and buffer._frameExists("a") and not buffer._frameExists("x")


def test_the_chain_of_frames():
    buffer = buffer_of(static=[stamped("A", "B"), stamped("B", "C"), stamped("A", "D")])
    assert buffer._chain("D", Time(), "C", Time(), "A") == ["C", "B", "A", "D"]
    assert buffer._chain("A", Time(), "C", Time(), "A") == ["C", "B", "A"]
    assert buffer._chain("C", Time(), "A", Time(), "C") == ["A", "B", "C"]


def test_all_frames_as_text():
    assert (BufferCore().all_frames_as_yaml(), BufferCore().all_frames_as_string()) == ("[]", "")
    assert BufferCore()._allFramesAsDot() == 'digraph G {\n"no tf data recieved"}'
    buffer = buffer_of(*(stamped("a", "b", 1.0 + tick / 10.0) for tick in range(11)), static=[stamped("b", "c")])
    assert buffer.all_frames_as_yaml() == (
        "b: \n  parent: 'a'\n  broadcaster: 'tester'\n  rate: 11.000\n  most_recent_transform: 2.000000\n"
        "  oldest_transform: 1.000000\n  buffer_length: 1.000\n"
        "c: \n  parent: 'b'\n  broadcaster: 'tester'\n  rate: 10000.000\n  most_recent_transform: 0.000000\n"
        "  oldest_transform: 0.000000\n  buffer_length: 0.000\n"
    )
    assert buffer.all_frames_as_string() == "Frame b exists with parent a.\nFrame c exists with parent b.\n"
    dot = buffer._allFramesAsDot(at(3.0))
    assert '"a" -> "b"[label="Broadcaster: tester\\nAverage rate: 11.000 Hz\\n' in dot
    assert '"Recorded at time: 3.000000"' in dot and dot.endswith('}->"a";\n}')
