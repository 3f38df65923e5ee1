"""Shapes and poses read back from a recording: each corner where the simulator had it."""

import math

import numpy as np
import pytest
import rerun as rr
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.record.bodies import bodies, hull
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import shape

QUARTER = [0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4)]  # a quarter turn to the left: x, y, z, w


@pytest.fixture
def recorded(tmp_path):
    def make(write):
        with Recorder(tmp_path / "run.rrd", "robot") as recorder:
            write(recorder)
        return Recording(tmp_path / "run.rrd")

    return make


def one(recorded, kind, size, rgba=(0.2, 0.4, 0.6, 1.0)):
    (body,) = bodies(recorded(lambda recorder: recorder.static("/world/thing/link/visual", shape(kind, size, rgba))))
    return body


@pytest.mark.parametrize(
    ("kind", "size", "low", "high"),
    [
        ("box", [2, 4, 6], (-1, -2, -3), (1, 2, 3)),
        ("cylinder", [2, 2, 6], (-1, -1, -3), (1, 1, 3)),
        ("sphere", [2, 2, 2], (-1, -1, -1), (1, 1, 1)),
        ("ellipsoid", [2, 4, 6], (-1, -2, -3), (1, 2, 3)),
        ("capsule", [2, 2, 6], (-1, -1, -4), (1, 1, 4)),  # half spheres on both ends of a cylinder
    ],
)
def test_every_shape_has_its_size(recorded, kind, size, low, high):
    body = one(recorded, kind, size)
    assert body.corners.min(axis=0) == pytest.approx(low, abs=1e-5)
    assert body.corners.max(axis=0) == pytest.approx(high, abs=1e-5)
    assert (body.model, body.moves) == ("thing", False)
    assert body.rgba == (51, 102, 153, 255)


def test_the_ground_is_left_out(recorded):
    assert (
        bodies(recorded(lambda r: r.static("/world/ground/link/visual", shape("plane", [0, 0, 0], [1, 1, 1, 1])))) == []
    )


def test_a_surface(recorded):
    mesh = rr.Mesh3D(vertex_positions=[[0, 0, 0], [1, 0, 0], [0, 1, 1]], albedo_factor=[1, 2, 3, 4])
    (body,) = bodies(recorded(lambda recorder: recorder.static("/world/hill/link/visual", mesh)))
    assert body.corners.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 1]]
    assert body.rgba == (1, 2, 3, 4)


def test_poses_apply_from_the_inside_out(recorded):
    def write(recorder):
        recorder.static("/world/box/link/visual", shape("box", [2, 0.2, 0.2], [1, 1, 1, 1]))
        recorder.static("/world/box/link/visual", rr.Transform3D(translation=[1, 0, 0], quaternion=[0, 0, 0, 1]))
        recorder.static("/world/box/link", rr.Transform3D(translation=[0, 0, 2], quaternion=[0, 0, 0, 1]))
        recorder.static("/world/box", rr.Transform3D(translation=[10, 0, 0], quaternion=QUARTER))

    (body,) = bodies(recorded(write))
    corners = body.at(0)
    assert corners.min(axis=0) == pytest.approx([9.9, 0, 1.9], abs=1e-5)
    assert corners.max(axis=0) == pytest.approx([10.1, 2, 2.1], abs=1e-5)


def test_a_moving_body_is_where_it_last_was(recorded):
    def write(recorder):
        recorder.static("/world/robot/base/visual", shape("box", [2, 2, 2], [1, 1, 1, 1]))
        for second in (1, 2, 3):
            recorder.set_time(second * 10**9)
            recorder.pose("/world/robot", (10 * second, 0, 0), (1, 0, 0, 0))

    (body,) = bodies(recorded(write))
    assert body.moves
    places = [float(body.at(round(at * 1e9))[:, 0].mean()) for at in (0, 1, 1.99, 2, 9)]
    assert places == pytest.approx([10, 10, 10, 20, 30])


def test_points_and_pictures_are_those_of_the_moment(recorded):
    def write(recorder):
        for second in (1, 2):
            recorder.set_time(second * 10**9)
            recorder.points("/world/scan", np.full((second, 3), float(second)))
            recorder.picture("/topics/camera", bytes([0xFF, 0xD8, second]))

    recording = recorded(write)
    assert [len(recording.points_at("world/scan", at * 10**9)) for at in (0, 1, 2, 3)] == [0, 1, 2, 2]
    assert [recording.picture_at("topics/camera", at * 10**9)[2:] for at in (0, 1, 3)] == [b"", b"\x01", b"\x02"]
    assert recording.picture_at("topics/none", 10**9) == b""
    assert recording.entities("topics", "EncodedImage") == ["topics/camera"]


points = st.lists(st.tuples(*[st.floats(-100, 100)] * 2), min_size=1, max_size=30)


@given(points)
def test_a_hull_holds_every_point_and_turns_left(rows):
    corners = hull(np.array(rows))
    if len(corners) < 3:
        return
    after = np.roll(corners, -1, axis=0)
    edges = after - corners
    for x, y in rows:
        beside = edges[:, 0] * (y - corners[:, 1]) - edges[:, 1] * (x - corners[:, 0])
        assert (beside >= -1e-3).all()
    following = np.roll(edges, -1, axis=0)
    assert (edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] > 0).all()


def test_the_hull_of_a_square():
    square = np.array([[0, 0], [1, 1], [1, 0], [0.5, 0.5], [0, 1], [0.5, 0]])
    assert hull(square).tolist() == [[0, 0], [1, 0], [1, 1], [0, 1]]
    assert hull(np.array([[1.0, 2.0]])).tolist() == [[1, 2]]
