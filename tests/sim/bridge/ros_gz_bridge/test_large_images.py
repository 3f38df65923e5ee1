"""Large images reach subscribers without special settings, through the publisher's segment of shared memory."""

from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_msgs.msg import Int32

from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.int32_pb2 import Int32 as GzInt32
from gz_course.sim.gz.transport import Node

SETTINGS = (
    "FASTRTPS_DEFAULT_PROFILES_FILE",
    "FASTDDS_DEFAULT_PROFILES_FILE",
    "FASTDDS_BUILTIN_TRANSPORTS",
    "RMW_IMPLEMENTATION",
)
WIDTH, HEIGHT, PICTURES = 1920, 1080, 8


def test_large_pictures_reach_a_best_effort_subscriber(start, ros, inbox, eventually, monkeypatch):
    for name in SETTINGS:
        monkeypatch.delenv(name, raising=False)
    bridge = start("/hd@sensor_msgs/msg/Image[gz.msgs.Image", "/number@std_msgs/msg/Int32[gz.msgs.Int32")
    bridge.wait_for("ready: 2 bridges")
    pictures, numbers = inbox(), inbox()
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    subscriptions = [
        ros.node.create_subscription(Image, "/hd", pictures, best_effort),
        ros.node.create_subscription(Int32, "/number", numbers, 10),
    ]
    step = WIDTH * 3
    picture = GzImage(width=WIDTH, height=HEIGHT, step=step, data=bytes(step * HEIGHT), pixel_format_type="RGB_INT8")
    try:
        with Node() as gz:
            number = gz.advertise("/number", GzInt32)
            # Small images show when DDS has connected the two processes, independently of the large ones.
            eventually(lambda: (number.publish(GzInt32(data=1)), numbers.messages)[1], "a small message arrives")
            eventually(lambda: subscriptions[0].get_publisher_count() == 1, "the bridge publishes pictures")
            publisher = gz.advertise("/hd", GzImage)
            assert publisher.wait_for_subscribers(timeout=120)
            # The other half of the connection causes no event, so the first image may be too early.
            eventually(lambda: (publisher.publish(picture), pictures.messages)[1], "the first picture", timeout=120)
            for count in range(len(pictures.messages), len(pictures.messages) + PICTURES):
                publisher.publish(picture)
                pictures.wait(count + 1, timeout=120)
    finally:
        for subscription in subscriptions:
            ros.node.destroy_subscription(subscription)
    assert len(pictures.messages[-1].data) == step * HEIGHT
