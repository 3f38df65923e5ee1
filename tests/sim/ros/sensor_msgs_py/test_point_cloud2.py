"""Point clouds are read and made as in ROS 2; the expectations unpack the bytes with struct."""

import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

from gz_course.sim.ros.sensor_msgs_py import point_cloud2
from gz_course.sim.ros.sensor_msgs_py.numpy_compat import structured_to_unstructured

CODES = {
    PointField.INT8: "b",
    PointField.UINT8: "B",
    PointField.INT16: "h",
    PointField.UINT16: "H",
    PointField.INT32: "i",
    PointField.UINT32: "I",
    PointField.FLOAT32: "f",
    PointField.FLOAT64: "d",
}
HEADER = Header(frame_id="lidar")
NAN = float("nan")


def field(name, offset, datatype=PointField.FLOAT32, count=1):
    return PointField(name=name, offset=offset, datatype=datatype, count=count)


XYZ = [field("x", 0), field("y", 4), field("z", 8)]


def cloud_of(rows, fields, step, *, big=False, height=1, dense=False):
    """Return a cloud whose bytes are packed one value after another."""
    data = bytearray(step * len(rows))
    for number, row in enumerate(rows):
        for each, value in zip(fields, row, strict=True):
            code = (">" if big else "<") + CODES[each.datatype]
            struct.pack_into(code, data, number * step + each.offset, value)
    width = len(rows) // height
    return PointCloud2(
        header=HEADER, height=height, width=width, fields=fields, is_bigendian=big, point_step=step,
        row_step=step * width, data=bytes(data), is_dense=dense,
    )  # fmt: skip


def value_of(datatype):
    code = CODES[datatype]
    if code in "fd":
        return st.floats(width=32 if code == "f" else 64, allow_nan=False)
    size = 8 * struct.calcsize(code)
    return st.integers(-(2 ** (size - 1)), 2 ** (size - 1) - 1) if code.islower() else st.integers(0, 2**size - 1)


@st.composite
def clouds(draw):
    types = draw(st.lists(st.sampled_from(sorted(CODES)), min_size=1, max_size=4))
    fields, offset = [], 0
    for number, datatype in enumerate(types):
        offset += draw(st.integers(0, 3))
        fields.append(field(f"f{number}", offset, datatype))
        offset += struct.calcsize(CODES[datatype])
    rows = draw(st.lists(st.tuples(*map(value_of, types)), max_size=4))
    return rows, fields, offset + draw(st.integers(0, 4))


@given(clouds(), st.booleans())
def test_every_layout_is_read(cloud, big):
    rows, fields, step = cloud
    message = cloud_of(rows, fields, step, big=big)
    for _ in range(2):  # reading does not change the message
        assert [tuple(point) for point in point_cloud2.read_points(message).tolist()] == rows
    last = fields[-1].name
    assert point_cloud2.read_points(message, [last])[last].tolist() == [row[-1] for row in rows]
    assert [point._asdict()[last] for point in point_cloud2.read_points_list(message)] == [row[-1] for row in rows]


@given(clouds())
def test_what_is_made_is_read(cloud):
    rows, fields, step = cloud
    made = point_cloud2.create_cloud(HEADER, fields, rows, step)
    assert bytes(made.data) == bytes(cloud_of(rows, fields, step).data)
    assert (made.header, made.height, made.width, made.point_step) == (HEADER, 1, len(rows), step)
    assert (made.row_step, made.is_dense, made.is_bigendian, made.fields) == (step * len(rows), False, False, fields)
    array = np.array(rows, point_cloud2.dtype_from_fields(fields, step))
    assert bytes(point_cloud2.create_cloud(HEADER, fields, array, step).data) == bytes(made.data)


def test_selections():
    rows = [(1.0, 2.0, 3.0), (4.0, NAN, 6.0), (7.0, 8.0, NAN), (10.0, 11.0, 12.0)]
    message = cloud_of(rows, XYZ, 12)
    assert point_cloud2.read_points(message, skip_nans=True)["x"].tolist() == [1.0, 10.0]
    assert point_cloud2.read_points(message, ["x", "z"], skip_nans=True)["x"].tolist() == [1.0, 4.0, 10.0]
    assert point_cloud2.read_points(message, uvs=iter([3, 0]))["z"].tolist() == [12.0, 3.0]
    assert point_cloud2.read_points(message, uvs=np.array([1]))["x"].tolist() == [4.0]
    message.is_dense = True
    assert len(point_cloud2.read_points(message, skip_nans=True)) == 4
    plain = point_cloud2.read_points_numpy(message, ("x", "z"))
    assert (plain.dtype, plain.shape, plain[0].tolist()) == (np.float32, (4, 2), [1.0, 3.0])
    assert [point.x for point in point_cloud2.read_points_list(message, ["x"], uvs=[2])] == [7.0]


def test_organized_clouds_and_fields_with_several_values():
    rows = [(float(n), float(-n)) for n in range(6)]
    fields = [field("x", 0), field("y", 4)]
    message = cloud_of(rows, fields, 8, height=2)
    assert point_cloud2.read_points(message, reshape_organized_cloud=True).shape == (3, 2)
    made = point_cloud2.create_cloud(HEADER, fields, np.zeros((3, 2, 2), np.float32))
    assert (made.width, made.height, made.point_step, len(made.data)) == (3, 2, 8, 48)
    many = [field("", 0, count=2), field("n", 8, PointField.UINT8)]
    names = point_cloud2.dtype_from_fields(many).names
    assert names == ("unnamed_field_0_0", "unnamed_field_0_1", "n")


def test_points_with_three_coordinates():
    made = point_cloud2.create_cloud_xyz32(HEADER, [(1, 2, 3), [4, 5, 6]])
    assert made.fields == XYZ and made.point_step == 12
    assert struct.unpack("<6f", made.data) == (1, 2, 3, 4, 5, 6)
    array = np.arange(12, dtype=np.float64).reshape(4, 3)
    made = point_cloud2.create_cloud_xyz32(HEADER, array)
    assert structured_to_unstructured(point_cloud2.read_points(made)).tolist() == array.tolist()
    assert point_cloud2.create_cloud_xyz32(HEADER, []).width == 0


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda c: point_cloud2.read_points(HEADER), AssertionError, "Cloud is not a sensor_msgs.msg.PointCloud2"),
        (lambda c: point_cloud2.read_points(c, ["w"]), AssertionError, "Requests field is not in the fields"),
        (lambda c: point_cloud2.create_cloud(HEADER, XYZ, [(1, 2)]), ValueError, "tuple of length 2"),
        (
            lambda c: point_cloud2.create_cloud(HEADER, XYZ, np.zeros(2, "f4,f4,f4")),
            AssertionError,
            "dtype do not match for all fields",
        ),
        (
            lambda c: point_cloud2.create_cloud(HEADER, [*XYZ, field("i", 12, PointField.INT8)], np.zeros((2, 4))),
            AssertionError,
            "All fields need to have the same datatype",
        ),
        (
            lambda c: point_cloud2.create_cloud(HEADER, XYZ, np.zeros((2, 2, 2, 3))),
            AssertionError,
            "Too many dimensions",
        ),
        (lambda c: point_cloud2.dtype_from_fields([XYZ[0]] * 2), AssertionError, "Duplicate field names"),
        (lambda c: point_cloud2.dtype_from_fields([field("x", 0, count=0)]), AssertionError, "count = 0"),
        (lambda c: point_cloud2.dtype_from_fields([field("x", 0, 77)]), KeyError, "77"),
        (lambda c: point_cloud2.read_points(PointCloud2(width=9, height=9, point_step=12, fields=XYZ)),
         TypeError, "buffer is too small"),
    ],
)  # fmt: skip
def test_errors(call, error, words):
    with pytest.raises(error, match=words):
        call(cloud_of([(1.0, 2.0, 3.0)], XYZ, 12))


def test_mixed_types_have_no_plain_array():
    fields = [field("x", 0), field("n", 4, PointField.INT32), field("y", 8)]
    message = cloud_of([(1.0, 2, 3.0)], fields, 12)
    with pytest.raises(AssertionError, match="All fields need to have the same datatype"):
        point_cloud2.read_points_numpy(message)
    assert point_cloud2.read_points_numpy(message, ["x", "y"]).tolist() == [[1.0, 3.0]]
