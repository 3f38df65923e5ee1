"""image_bridge as a process: images of a Gazebo node arrive unchanged in ROS."""

import pytest

from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.image_pb2 import PixelFormatType

DEADLINE = 120.0


def picture(stamp):
    image = GzImage(width=3, height=2, step=9, data=bytes(range(18)), pixel_format_type=PixelFormatType.RGB_INT8)
    image.header.stamp.sec = stamp
    frame = image.header.data.add(key="frame_id")
    frame.value.append("robot::camera")
    return image


@pytest.fixture
def bridge(programs):
    running = []

    def start(*words):
        running.append(programs.ros2("run", "ros_gz_image", "image_bridge", *words))
        running[-1].wait_for("ready:")
        return running[-1]

    yield start
    for program in running:
        assert program.stop() == 0, program.said


def test_pictures_arrive_under_a_remapped_name(programs, bridge, ros_node, spin_until):
    from rclpy.qos import ReliabilityPolicy, qos_profile_sensor_data
    from sensor_msgs.msg import Image

    heard = []
    ros_node.create_subscription(Image, "/robot/image_raw", heard.append, qos_profile_sensor_data)
    words = ["/camera", "/depth", "--ros-args", "-r", "/camera:=/robot/image_raw", "-p", "qos:=sensor_data"]
    program = bridge(*words)
    assert "ready: 2 image topics" in program.said
    with programs.gz_node() as node:
        publisher = node.advertise("/camera", GzImage)
        numbers = iter(range(1, 10_000))

        def arrived():
            publisher.publish(picture(next(numbers)))
            return heard

        spin_until(arrived, "a picture")
    image = heard[0]
    assert (image.encoding, image.width, image.height, image.step) == ("rgb8", 3, 2, 9)
    assert bytes(image.data) == bytes(range(18))
    assert (image.header.frame_id, image.header.stamp.sec > 0) == ("robot/camera", True)
    (info,) = ros_node.get_publishers_info_by_topic("/robot/image_raw")
    assert info.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT
    (info,) = ros_node.get_publishers_info_by_topic("/depth")
    assert info.topic_type == "sensor_msgs/msg/Image"


def test_a_lazy_bridge_listens_only_while_it_is_listened_to(programs, bridge, ros_node, spin_until):
    from sensor_msgs.msg import Image

    bridge("/lazy", "--ros-args", "-p", "lazy:=true", "-p", "subscription_heartbeat:=50")
    with programs.gz_node() as node:
        publisher = node.advertise("/lazy", GzImage)
        assert not publisher.has_connections()
        heard = []
        subscription = ros_node.create_subscription(Image, "/lazy", heard.append, 10)
        spin_until(publisher.has_connections, "the bridge listens")
        spin_until(lambda: publisher.publish(picture(1)) and heard, "a picture")
        ros_node.destroy_subscription(subscription)
        spin_until(lambda: not publisher.has_connections(), "the bridge listens no more")


def test_a_picture_without_a_ros_format_is_told(programs, bridge):
    program = bridge("/odd")
    with programs.gz_node() as node:
        publisher = node.advertise("/odd", GzImage)
        assert publisher.wait_for_subscribers(1, DEADLINE)
        image = picture(1)
        image.pixel_format_type = PixelFormatType.UNKNOWN_PIXEL_FORMAT
        publisher.publish(image)
        program.wait_for("images on /odd are bridged, but the pixel format")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "there is no topic to bridge"),
        (["/a b"], "cannot bridge '/a b'"),
        (["/a@sensor_msgs/msg/Image[gz.msgs.Image"], "image_bridge takes names only"),
        (["/a", "--ros-args", "-p", "qos:=fast"], "the parameter qos must be default, system_default, sensor_data"),
        (["/a", "--ros-args", "-p", "lazy:=1"], "the parameter lazy must be true or false, not 1"),
        (["/a", "--ros-args", "-p", "subscription_heartbeat:=0"], "subscription_heartbeat must be above 0"),
    ],
)
def test_what_makes_no_sense(call, words, sentence):
    code, said = call("gz_course.sim.bridge.ros_gz_image.image_bridge", *words)
    assert (code, sentence in said) == (2, True), said
