"""Messages in another frame, compared with matrices; a Buffer that transforms them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.time import Time

from gz_course.tests.sim.ros.tf2_py.transforms import coordinates, matrix, poses, stamped

vectors = st.tuples(*[coordinates] * 3)


def vector(message):
    return message.x, message.y, message.z


def pose_message(place, turn):
    from geometry_msgs.msg import Point, Pose, Quaternion

    x, y, z, w = turn
    return Pose(position=Point(**dict(zip("xyz", place, strict=True))), orientation=Quaternion(x=x, y=y, z=z, w=w))


@settings(max_examples=20)
@given(poses, poses, vectors)
def test_points_vectors_poses_twists_and_wrenches(frame, pose, other):
    from geometry_msgs.msg import PointStamped, Twist, Vector3, Vector3Stamped, Wrench

    from gz_course.sim.ros import tf2_geometry_msgs as tf2

    transform = stamped("a", "b", 1.0, *frame)
    whole = matrix(*frame)
    turn, place = whole[:3, :3], whole[:3, 3]
    first, second = (Vector3(**dict(zip("xyz", each, strict=True))) for each in (pose[0], other))

    point = PointStamped()
    point.point.x, point.point.y, point.point.z = pose[0]
    moved = tf2.do_transform_point(point, transform)
    assert vector(moved.point) == pytest.approx(turn @ pose[0] + place)
    assert moved.header == transform.header

    rotated = tf2.do_transform_vector3(Vector3Stamped(vector=first), transform)
    assert vector(rotated.vector) == pytest.approx(turn @ pose[0])
    assert vector(transform.transform.translation) == frame[0], "the transform is not changed"

    found = tf2.do_transform_pose(pose_message(*pose), transform)
    quaternion = *vector(found.orientation), found.orientation.w
    assert matrix(vector(found.position), quaternion) == pytest.approx(whole @ matrix(*pose), abs=1e-9)
    assert quaternion[3] >= 0.0

    wrench = tf2.do_transform_wrench(Wrench(force=first, torque=second), transform)
    assert vector(wrench.force) == pytest.approx(turn @ pose[0])
    assert vector(wrench.torque) == pytest.approx(turn @ other)

    twist = tf2.do_transform_twist(Twist(linear=first, angular=second), transform)
    assert vector(twist.angular) == pytest.approx(turn @ other)
    assert vector(twist.linear) == pytest.approx(turn @ pose[0] + np.cross(place, turn @ other), abs=1e-6)


def test_covariance_turns_with_the_frame():
    from geometry_msgs.msg import PoseWithCovarianceStamped

    from gz_course.sim.ros.tf2_geometry_msgs import do_transform_pose_with_covariance_stamped

    message = PoseWithCovarianceStamped()
    message.pose.covariance = np.diag((1.0, 4.0, 9.0, 16.0, 25.0, 36.0)).reshape(36)
    quarter = stamped("a", "b", turn=(0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)))
    found = do_transform_pose_with_covariance_stamped(message, quarter).pose.covariance.reshape(6, 6)
    assert found == pytest.approx(np.diag((4.0, 1.0, 9.0, 25.0, 16.0, 36.0)))


def test_a_buffer_transforms_stamped_messages():
    from geometry_msgs.msg import Point32, PointStamped, PolygonStamped, PoseStamped, TwistStamped

    import gz_course.sim.ros.tf2_geometry_msgs  # noqa: F401 - registers
    from gz_course.sim.ros.tf2_ros import Buffer, TypeException

    buffer = Buffer()
    for second in (1.0, 2.0):
        buffer.set_transform(stamped("map", "robot", second, place=(second, 0.0, 0.0)), "tester")
    for made in (PointStamped(), PoseStamped(), PolygonStamped(), TwistStamped()):
        made.header = stamped("robot", "", 1.5).header
        if isinstance(made, PolygonStamped):
            made.polygon.points = [Point32(x=1.0)]
        done = buffer.transform(made, "map")
        assert (done.header.frame_id, done.header.stamp) == ("map", made.header.stamp)
        if isinstance(made, PointStamped):
            assert done.point.x == 1.5
            assert buffer.transform(made, "map", new_type=PointStamped) == done
            full = buffer.transform_full(made, "robot", Time(nanoseconds=2 * 10**9), "map")
            assert full.point.x == -0.5
        if isinstance(made, PolygonStamped):
            assert done.polygon.points[0].x == 2.5
    with pytest.raises(TypeException, match="Type <class 'str'> is not loaded or supported"):
        buffer.transform("text", "map")
