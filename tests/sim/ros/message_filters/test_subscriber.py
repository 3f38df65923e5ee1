"""Filters over DDS, in one process: two topics become pairs."""

import threading

import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.time import Time
from sensor_msgs.msg import CameraInfo, Image

from gz_course.grader.run.domain import Domain
from gz_course.sim.ros.message_filters import ApproximateTimeSynchronizer, Cache, Subscriber, TimeSynchronizer

DEADLINE = 120.0


@pytest.fixture
def node(monkeypatch):
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    monkeypatch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
    with Domain() as domain:
        context = rclpy.Context()
        rclpy.init(context=context, domain_id=domain.id)
        node = rclpy.create_node("viewer", context=context)
        yield node
        node.destroy_node()
        context.try_shutdown()


def test_pictures_and_their_camera_info_come_together(node):
    done = threading.Event()
    pairs, near, alone = [], [], []

    def pair(image, info, word):
        pairs.append((image.header.stamp.nanosec, info.width, word))
        if len(pairs) == 3:
            done.set()

    images = Subscriber(node, Image, "image", qos_profile=QoSProfile(depth=5, reliability=ReliabilityPolicy.RELIABLE))
    infos = Subscriber(node, CameraInfo, "info")
    TimeSynchronizer([images, infos], 10).registerCallback(pair, "and a word")
    ApproximateTimeSynchronizer([images, infos], 10, 0.001).registerCallback(lambda *both: near.append(both))
    cache = Cache(images, 2)
    images.registerCallback(alone.append)
    assert images.getTopic() == "image" and images.topic_name == "/image" and images.msg_type is Image
    with pytest.raises(AttributeError):
        _ = images.no_such_attribute
    senders = node.create_publisher(Image, "image", 10), node.create_publisher(CameraInfo, "info", 10)
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    numbers = iter(range(3))

    def send():
        if all(each.get_subscription_count() for each in senders) and (number := next(numbers, None)) is not None:
            stamp = Time(nanoseconds=number * 100).to_msg()
            for each, message in zip(senders, (Image(), CameraInfo(width=number)), strict=True):
                message.header.stamp = stamp
                each.publish(message)

    timer = node.create_timer(0.01, send)
    clock = node.get_clock()
    end = clock.now().nanoseconds + DEADLINE * 1e9
    while not done.is_set():
        assert clock.now().nanoseconds < end, pairs
        executor.spin_once(timeout_sec=1.0)
    timer.cancel()
    executor.shutdown()
    assert pairs == [(0, 0, "and a word"), (100, 1, "and a word"), (200, 2, "and a word")]
    assert len(near) >= 2 and len(alone) == 3
    assert [each.header.stamp.nanosec for each in cache.cache_msgs] == [100, 200]


def test_arguments_are_those_of_create_subscription(node):
    with pytest.raises(TypeError):
        Subscriber(node, Image, "image", 10)  # the QoS has a name here, as in ROS 2
