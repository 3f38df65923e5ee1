"""MCAP: what a reader without ROS and Rerun's own loader find is what the recording holds."""

import dataclasses
import io

import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from gz_course.grader.record.messages import record_message
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.report.formats.mcap import as_mcap
from gz_course.sim.ros.rosbag2.storage.bag import Bag

pytestmark = pytest.mark.usefixtures("without_blueprint")


@pytest.fixture
def written(tmp_path, make_report):
    """Record messages, one every 0.1 s; return the bytes of the MCAP file."""

    def write(*messages, log=""):
        path = tmp_path / "run.rrd"
        with Recorder(path, "robot") as recorder:
            for number, (topic, message) in enumerate(messages):
                recorder.set_time(number * 100_000_000)
                record_message(recorder, topic, message)
            if log:
                recorder.text("log/student", log, "ERROR")
        return as_mcap(dataclasses.replace(make_report(world=False), recording=path, trials=()))

    return write


def read(data):
    reader = make_reader(io.BytesIO(data), decoder_factories=[DecoderFactory()])
    left_out = next(iter(reader.iter_metadata())).metadata["topics_left_out"].split()
    return [(c.topic, s.name, m.log_time, decoded) for s, c, m, decoded in reader.iter_decoded_messages()], left_out


def test_messages_are_those_of_the_recording(written, tmp_path):
    from geometry_msgs.msg import Twist
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import Image, JointState, LaserScan
    from std_msgs.msg import Bool, Int64, String

    twist, odometry, scan = Twist(), Odometry(), LaserScan(range_max=6.0)
    twist.linear.x, twist.angular.z = 0.5, -0.25
    odometry.header.frame_id, odometry.child_frame_id = "odom", "base_link"
    odometry.pose.pose.orientation.w, odometry.pose.covariance[35] = 1.0, 0.5
    scan.ranges = [1.0, 2.5, float("inf")]
    image = Image(height=2, width=2, encoding="rgb8", step=6, data=bytes(range(12)))
    data = written(
        *(("/cmd_vel", twist), ("/odom", odometry), ("/lidar/scan", scan), ("/camera/image", image)),
        *(("/said", String(data="a")), ("/said", String(data="b")), ("/flag", Bool(data=True))),
        *(("/count", Int64(data=-7)), ("/joints", JointState(name=["left"], position=[1.0]))),
        log="boom",
    )
    found, left_out = read(data)
    by_topic = {topic: message for topic, _, _, message in found}
    assert [(topic, time) for topic, _, time, _ in found][:2] == [("/cmd_vel", 0), ("/odom", 100_000_000)]
    assert (by_topic["/cmd_vel"].linear.x, by_topic["/cmd_vel"].angular.z) == (0.5, -0.25)
    odom = by_topic["/odom"]
    assert (odom.header.frame_id, odom.child_frame_id, odom.header.stamp.nanosec) == ("odom", "base_link", 100_000_000)
    assert (odom.pose.pose.orientation.w, odom.pose.covariance[35]) == (1.0, 0.5)
    assert list(by_topic["/lidar/scan"].ranges) == [1.0, 2.5, float("inf")]
    assert list(by_topic["/lidar/scan"].intensities) == []
    assert [m.data for topic, _, _, m in found if topic == "/said"] == ["a", "b"]
    assert (by_topic["/flag"].data, by_topic["/count"].data) == (True, -7)
    assert bytes(by_topic["/camera/image/compressed"].data)[:2] == b"\xff\xd8"
    assert (by_topic["/rosout"].msg, by_topic["/rosout"].level) == ("boom", 40)
    assert (list(by_topic["/joints"].name), list(by_topic["/joints"].position)) == (["left"], [1.0])
    assert left_out == []
    path = tmp_path / "run.mcap"
    path.write_bytes(data)
    bag = Bag(path)
    assert bag.complaints == []
    assert bag.metadata.count == len(found)


def test_lists_of_messages_are_whole_or_left_out(written, tmp_path):
    from geometry_msgs.msg import Point32, PolygonStamped, TransformStamped
    from sensor_msgs.msg import PointCloud2, PointField
    from tf2_msgs.msg import TFMessage
    from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

    def transforms(*names):
        message = TFMessage()
        for number, name in enumerate(names):
            message.transforms.append(TransformStamped(child_frame_id=name))
            message.transforms[-1].header.frame_id = "base"
            message.transforms[-1].transform.translation.x = float(number)
        return message

    cloud = PointCloud2(height=1, width=2, point_step=4, row_step=8, data=bytes(range(8)))
    cloud.fields = [PointField(name="x", datatype=PointField.FLOAT32, count=1)]
    outline = PolygonStamped()
    outline.polygon.points = [Point32(x=1.0), Point32(x=2.0)]
    path = JointTrajectory(joint_names=["a"], points=[JointTrajectoryPoint(positions=[1.0])])
    found, left_out = read(
        written(
            *(("/tf", transforms("left", "right")), ("/tf", transforms()), ("/tf", transforms("arm"))),
            *(("/cloud", cloud), ("/outline", outline), ("/path", path)),
        )
    )
    heard = _of(found, "/tf")
    seen = [[(t.child_frame_id, t.header.frame_id, t.transform.translation.x) for t in m.transforms] for m in heard]
    assert seen == [[("left", "base", 0.0), ("right", "base", 1.0)], [], [("arm", "base", 0.0)]]
    assert heard[2].transforms[0].header.stamp.nanosec == 200_000_000
    seen = _of(found, "/cloud")[0]
    assert (seen.fields[0].name, seen.fields[0].datatype, bytes(seen.data)) == (
        "x",
        PointField.FLOAT32,
        bytes(range(8)),
    )
    assert [point.x for point in _of(found, "/outline")[0].polygon.points] == [1.0, 2.0]
    assert left_out == ["/path"]


def _of(found, topic):
    return [message for name, _, _, message in found if name == topic]


def test_rerun_reads_it(written, tmp_path):
    from geometry_msgs.msg import Twist
    from rerun.chunk import McapReader

    path = tmp_path / "run.mcap"
    path.write_bytes(written(("/cmd_vel", Twist()), ("/cmd_vel", Twist())))
    chunks = list(McapReader(path).stream())
    names = {
        name for chunk in chunks if "cmd_vel" in chunk.entity_path for name in chunk.to_record_batch().schema.names
    }
    assert any("Twist" in name or "linear" in name for name in names), names
