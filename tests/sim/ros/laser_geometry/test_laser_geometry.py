"""A scan becomes the points that trigonometry says."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sensor_msgs.msg import LaserScan, PointField
from std_msgs.msg import Header

from gz_course.sim.ros.laser_geometry import LaserProjection
from gz_course.sim.ros.sensor_msgs_py.point_cloud2 import read_points, read_points_list

OPTIONS = LaserProjection.ChannelOption
EVERY = OPTIONS.INTENSITY | OPTIONS.INDEX | OPTIONS.DISTANCE | OPTIONS.TIMESTAMP | OPTIONS.VIEWPOINT


def scan(ranges, **changes):
    values = {
        "angle_min": -1.0, "angle_max": 1.0, "angle_increment": 0.25, "range_min": 0.5, "range_max": 8.0,
        "time_increment": 0.125, "ranges": ranges,
    }  # fmt: skip
    return LaserScan(header=Header(frame_id="lidar"), **(values | changes))


def expected(message, cutoff):
    limit = message.range_max if cutoff < 0 else min(cutoff, message.range_max)
    return [
        (index, message.ranges[index] * math.cos(angle), message.ranges[index] * math.sin(angle))
        for index in range(len(message.ranges))
        if message.range_min <= message.ranges[index] < limit
        for angle in [message.angle_min + index * message.angle_increment]
    ]


distances = st.lists(st.floats(0, 10, width=32) | st.sampled_from([math.nan, math.inf, 0.5, 8.0]), max_size=9)


@given(st.lists(distances, min_size=1, max_size=3), st.sampled_from([-1.0, 0.0, 4.0, 20.0]))
def test_points_lie_where_the_rays_ended(scans, cutoff):
    projection = LaserProjection()  # it remembers directions, which must not leak into the next scan
    for number, ranges in enumerate(scans):
        message = scan(ranges, angle_increment=0.25 + number / 8, intensities=[2.0 * n for n in range(len(ranges))])
        cloud = projection.projectLaser(message, cutoff, EVERY)
        wanted = expected(message, cutoff)
        points = read_points_list(cloud)
        assert [point.index for point in points] == [index for index, _, _ in wanted]
        for point, (index, x, y) in zip(points, wanted, strict=True):
            assert (point.x, point.y, point.z) == pytest.approx((x, y, 0), abs=1e-5)
            assert (point.intensity, point.distances, point.stamps) == (2 * index, ranges[index], index / 8)
            assert (point.vp_x, point.vp_y, point.vp_z) == (0, 0, 0)
        assert cloud.header == message.header and cloud.height == 1 and not cloud.is_dense


@pytest.mark.parametrize(
    ("options", "intensities", "names"),
    [
        (None, [1.0, 2.0], ["x", "y", "z", "intensity", "index"]),
        (None, [], ["x", "y", "z", "index"]),
        (OPTIONS.NONE, [1.0, 2.0], ["x", "y", "z"]),
        (OPTIONS.DISTANCE | OPTIONS.TIMESTAMP, [], ["x", "y", "z", "distances", "stamps"]),
        (OPTIONS.VIEWPOINT, [], ["x", "y", "z", "vp_x", "vp_y", "vp_z"]),
    ],
)
def test_channels(options, intensities, names):
    arguments = {} if options is None else {"channel_options": options}
    cloud = LaserProjection().projectLaser(scan([1.0, 2.0], intensities=intensities), **arguments)
    assert [field.name for field in cloud.fields] == names
    assert [field.offset for field in cloud.fields] == list(range(0, 4 * len(names), 4))
    assert {field.datatype for field in cloud.fields if field.name != "index"} == {PointField.FLOAT32}
    assert all(field.datatype == PointField.INT32 for field in cloud.fields if field.name == "index")
    assert cloud.point_step == 4 * len(names) and cloud.width == 2


def test_empty_scans_and_missing_intensities():
    assert LaserProjection().projectLaser(scan([])).width == 0
    assert len(read_points(LaserProjection().projectLaser(scan([math.inf] * 3)))) == 0
    with pytest.raises(IndexError):
        LaserProjection().projectLaser(scan([1.0, 2.0], intensities=[1.0]))
