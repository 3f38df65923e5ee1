"""Reads and makes PointCloud2 messages with NumPy.

Source: sensor_msgs_py/point_cloud2.py of common_interfaces 5.3 (Jazzy), the texts of its assertions included;
definitions of sensor_msgs/msg/PointCloud2 and PointField.
"""

from __future__ import annotations

import sys
from collections import namedtuple
from collections.abc import Iterable
from typing import Any, cast

import numpy as np
from numpy.lib.recfunctions import structured_to_unstructured, unstructured_to_structured
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import Header

DUMMY_FIELD_PREFIX = "unnamed_field"
_DATATYPES: dict[int, np.dtype[Any]] = {
    PointField.INT8: np.dtype(np.int8),
    PointField.UINT8: np.dtype(np.uint8),
    PointField.INT16: np.dtype(np.int16),
    PointField.UINT16: np.dtype(np.uint16),
    PointField.INT32: np.dtype(np.int32),
    PointField.UINT32: np.dtype(np.uint32),
    PointField.FLOAT32: np.dtype(np.float32),
    PointField.FLOAT64: np.dtype(np.float64),
}


def read_points(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> np.ndarray:
    """Return the points as a structured array with the fields `field_names` (default: all).

    It is a view of the message if its byte order is that of the machine and nothing is selected. `skip_nans` omits
    points with NaN in one of these fields, unless the cloud is dense; `uvs` selects points by their indices;
    `reshape_organized_cloud` gives an array of shape (width, height), as in ROS 2. Raises AssertionError for something
    that is no PointCloud2, for a field that does not exist and for a field name that occurs twice, and TypeError if
    the message has less data than it says.
    """
    assert isinstance(cloud, PointCloud2), "Cloud is not a sensor_msgs.msg.PointCloud2"
    points: np.ndarray = np.ndarray(
        shape=(cloud.width * cloud.height,),
        dtype=dtype_from_fields(cloud.fields, point_step=cloud.point_step),
        buffer=cloud.data,
    )
    if field_names is not None:
        field_names = list(field_names)
        assert all(name in (points.dtype.names or ()) for name in field_names), (
            "Requests field is not in the fields of the PointCloud!"
        )
        points = points[field_names]
    if (sys.byteorder != "little") != bool(cloud.is_bigendian):
        points = points.byteswap()  # a copy: the message stays as it is
    if skip_nans and not cloud.is_dense:
        missing = np.zeros(len(points), dtype=bool)
        for name in points.dtype.names or ():
            missing |= np.isnan(points[name])
        points = points[~missing]
    if uvs is not None:
        points = points[uvs if isinstance(uvs, np.ndarray) else np.fromiter(uvs, int)]
    if reshape_organized_cloud and cloud.height > 1:
        points = points.reshape(cloud.width, cloud.height)
    return points


def read_points_numpy(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
    reshape_organized_cloud: bool = False,
) -> np.ndarray:
    """Return the points as a plain array (n, number of fields), for fields that have the type of the first field.

    The arguments are those of `read_points`. Raises its errors, and AssertionError if the types differ.
    """
    field_names = None if field_names is None else list(field_names)
    used = [field for field in cloud.fields[1:] if field_names is None or field.name in field_names]
    assert all(field.datatype == cloud.fields[0].datatype for field in used), (
        "All fields need to have the same datatype. Use `read_points()` otherwise."
    )
    points: np.ndarray = structured_to_unstructured(
        read_points(cloud, field_names, skip_nans, uvs, reshape_organized_cloud)
    )
    return points


def read_points_list(
    cloud: PointCloud2,
    field_names: Iterable[str] | None = None,
    skip_nans: bool = False,
    uvs: Iterable[int] | None = None,
) -> list[Any]:
    """Return the points as a list of named tuples; arguments and errors are those of `read_points`."""
    assert isinstance(cloud, PointCloud2), "cloud is not a sensor_msgs.msg.PointCloud2"
    names = [field.name for field in cloud.fields] if field_names is None else list(field_names)
    point = namedtuple("Point", names)  # type: ignore[misc]
    return [point._make(each) for each in read_points(cloud, names, skip_nans, uvs)]


def dtype_from_fields(fields: Iterable[PointField], point_step: int | None = None) -> np.dtype:
    """Return the structured type of a point with these fields, `point_step` [byte] long.

    A field without a name is `unnamed_field_INDEX`; the values of a field with a `count` above 1 are `NAME_0` and so
    on. Raises AssertionError for a name that occurs twice and for a `count` of 0, and KeyError for an unknown datatype.
    """
    names: list[str] = []
    formats: list[str] = []
    offsets: list[int] = []
    for index, field in enumerate(fields):
        datatype = _DATATYPES[field.datatype]
        name = field.name or f"{DUMMY_FIELD_PREFIX}_{index}"
        assert field.count > 0, "Can't process fields with count = 0."
        for number in range(field.count):
            own_name = f"{name}_{number}" if field.count > 1 else name
            assert own_name not in names, "Duplicate field names are not allowed!"
            names.append(own_name)
            formats.append(datatype.str)
            offsets.append(field.offset + number * datatype.itemsize)
    description: dict[str, Any] = {"names": names, "formats": formats, "offsets": offsets}
    if point_step is not None:
        description["itemsize"] = point_step
    return np.dtype(description)  # type: ignore[call-overload]


def create_cloud(
    header: Header, fields: Iterable[PointField], points: Iterable[Any], point_step: int | None = None
) -> PointCloud2:
    """Return a cloud of points: rows of values in the order of `fields`, or a structured or plain array.

    An array of shape (width, height, ...) becomes an organized cloud. `point_step` [byte] is the length of a point,
    by default that of its fields. Raises AssertionError for an array whose type is not that of the fields.
    """
    fields = list(fields)
    point_type = dtype_from_fields(fields, point_step)
    if not isinstance(points, np.ndarray):
        rows = [tuple(each) for each in points]
        points = np.zeros(len(rows), dtype=point_type)
        points[:] = rows
    elif points.dtype.names is None:
        assert all(field.datatype == fields[0].datatype for field in fields[1:]), (
            "All fields need to have the same datatype. Pass a structured NumPy array with multiple dtypes otherwise."
        )
        values = unstructured_to_structured(points, dtype=point_type)
        points = np.zeros(values.shape, dtype=point_type)  # gaps between fields hold no stray memory
        points[...] = values
    else:
        assert points.dtype == point_type, (
            "PointFields and structured NumPy array dtype do not match for all fields! "
            "Check their field order, names and types."
        )
    assert points.ndim <= 2, (
        "Too many dimensions for organized cloud! Points can only be organized in max. two dimensional space"
    )
    width = points.shape[0]
    cloud = PointCloud2(
        header=header,
        height=points.shape[1] if points.ndim == 2 else 1,
        width=width,
        is_dense=False,
        is_bigendian=sys.byteorder != "little",
        fields=fields,
        point_step=points.dtype.itemsize,
        row_step=points.dtype.itemsize * width,
    )
    cloud.data.frombytes(memoryview(cast(Any, points)).cast("B"))  # assigned data would be copied once more
    return cloud


def create_cloud_xyz32(header: Header, points: Iterable[Any]) -> PointCloud2:
    """Return a cloud of points (x, y, z) [m] with fields of type FLOAT32."""
    fields = [
        PointField(name=name, offset=4 * index, datatype=PointField.FLOAT32, count=1)
        for index, name in enumerate("xyz")
    ]
    return create_cloud(header, fields, points)
