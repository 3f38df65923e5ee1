"""The running bridge, over real DDS and a Gazebo node of this process."""

import itertools
import math
import threading

import pytest
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image, JointState, LaserScan

from gz_course.sim.bridge.ros_gz_bridge.arguments import read_arguments
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, BridgeError, Direction, HeaderOverrides
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import QOS_PROFILES
from gz_course.sim.gz.msgs.clock_pb2 import Clock as GzClock
from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz_course.sim.gz.msgs.model_pb2 import Model as GzModel
from gz_course.sim.gz.msgs.twist_pb2 import Twist as GzTwist
from gz_course.sim.gz.transport import MessageInfo
from gz_course.tests.sim.bridge.ros_gz_bridge.stage import SCAN, TWIST, with_and_without_threads

JOINTS = ("sensor_msgs/msg/JointState", "gz.msgs.Model")


@with_and_without_threads
def test_a_command_reaches_gazebo(stage, inbox, eventually, threaded):
    bridge = stage.bridge(stage.entry(direction=Direction.ROS_TO_GZ), threaded=threaded)
    commands = inbox()
    stage.gz.subscribe(GzTwist, stage.topic, commands)
    twist = Twist()
    twist.linear.x, twist.angular.z = 0.5, -0.25
    stage.ros_publisher(Twist).publish(twist)
    (command,) = commands.wait(1)
    assert (command.linear.x, command.angular.z) == (0.5, -0.25)
    eventually(lambda: bridge.status()[0].ros_to_gz, "it is counted")
    (status,) = bridge.status()
    assert (status.ros_to_gz, status.gz_to_ros, status.dropped, status.last_error) == (1, 0, 0, None)


@pytest.mark.parametrize("reliability", [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT])
def test_a_scan_reaches_both_kinds_of_ros_subscriber(stage, inbox, eventually, reliability):
    bridge = stage.bridge(stage.entry(SCAN, Direction.GZ_TO_ROS))
    scans = inbox()
    stage.ros_subscription(LaserScan, scans, QoSProfile(depth=10, reliability=reliability))
    to_ros = bridge._to_ros[0].publisher
    eventually(lambda: to_ros.get_subscription_count() == 1, "the bridge knows its subscriber")
    stage.gz.advertise(stage.topic, GzLaserScan).publish(
        GzLaserScan(frame="robot::lidar", count=2, ranges=[1.0, math.inf], angle_step=0.5)
    )
    (scan,) = scans.wait(1)
    assert (scan.header.frame_id, list(scan.ranges), scan.angle_increment) == (
        "robot/lidar",
        [1.0, math.inf],
        0.5,
    )
    assert bridge.status()[0].gz_to_ros == 1


def test_conversion_to_ros_is_done_before_gz_publish_returns(stage):
    held = []
    stage.bridge(
        stage.entry(("rosgraph_msgs/msg/Clock", "gz.msgs.Clock"), Direction.GZ_TO_ROS),
        publish=lambda publisher, message: held.append((publisher, message)),
    )
    clock = GzClock()
    clock.sim.sec = 7
    stage.gz.advertise(stage.topic, GzClock).publish(clock)
    ((publisher, message),) = held
    assert (publisher.topic_name, type(message), message.clock.sec) == (stage.topic, Clock, 7)


def handled(bridge):
    return bridge.status()[0].dropped + bridge.status()[0].ros_to_gz


def test_a_command_that_is_not_finite_is_dropped_counted_and_reported_once_a_second(stage, inbox, eventually, capfd):
    now = [0.0]
    bridge = stage.bridge(stage.entry(direction=Direction.ROS_TO_GZ), monotonic=lambda: now[0])
    commands = inbox()
    stage.gz.subscribe(GzTwist, stage.topic, commands)
    publisher = stage.ros_publisher(Twist)
    bad, worse = Twist(), Twist()
    bad.angular.z, worse.linear.x = math.nan, -math.inf
    sent = 0
    for second, messages in enumerate([[bad], [bad, bad, Twist(), bad, worse], [bad]]):
        for message in messages:
            now[0] = second * 0.6
            publisher.publish(message)
            sent += 1
            eventually(lambda sent=sent: handled(bridge) == sent, "the command is counted")
    commands.wait(1)
    (status,) = bridge.status()
    assert (status.dropped, status.ros_to_gz, len(commands.messages)) == (6, 1, 1)
    assert status.last_error.startswith(f"geometry_msgs/msg/Twist on {stage.topic} was not bridged: angular.z is nan")
    bridge.say_unsaid()
    lines: list[str] = []

    def warned(count):
        lines.extend(line for line in capfd.readouterr().err.splitlines() if "[WARN]" in line)
        return len(lines) >= count

    eventually(lambda: warned(2), "two warnings are written")  # after the messages are counted
    assert [stage.topic in line and "angular.z is nan" in line for line in lines] == [True, True]
    assert lines[1].endswith("(5 messages since the last such line, and another reason)")
    publisher.publish(worse)
    eventually(lambda: bridge.status()[0].dropped == 7, "counted")
    bridge.close()
    eventually(lambda: warned(3), "the last one, too")
    assert len(lines) == 3 and "linear.x is -inf" in lines[2]


def test_a_message_that_cannot_be_converted_is_dropped_with_its_reason(stage):
    bridge = stage.bridge(stage.entry(("sensor_msgs/msg/Image", "gz.msgs.Image"), Direction.GZ_TO_ROS))
    publisher = stage.gz.advertise(stage.topic, GzImage)
    publisher.publish(GzImage(width=9, height=1, step=9, pixel_format_type="L_INT8", data=b"x"))
    publisher.publish(GzImage(width=1, height=1, step=1, pixel_format_type="L_INT8", data=b"x"))
    (status,) = bridge.status()
    assert (status.dropped, status.gz_to_ros) == (1, 1)
    assert f"gz.msgs.Image on {stage.topic} was not bridged: an image of 9x1 mono8 pixels" in status.last_error


def test_the_owner_may_hand_over_a_message_as_if_it_had_come_from_ros(stage, inbox):
    bridge = stage.bridge(stage.entry(direction=Direction.ROS_TO_GZ))
    commands = inbox()
    stage.gz.subscribe(GzTwist, stage.topic, commands)
    twist = Twist()
    twist.linear.x = 0.5
    assert bridge.take(stage.topic, twist)
    assert not bridge.take(stage.topic, TwistStamped()) and not bridge.take("/elsewhere", twist)
    assert [command.linear.x for command in commands.wait(1)] == [0.5]
    assert bridge.status()[0].ros_to_gz == 1


def test_a_message_that_fits_in_part_is_bridged_with_a_warning(stage, eventually, capfd):
    errors = []

    def said(words):
        errors.append(capfd.readouterr().err)
        return words in "".join(errors)

    bridge = stage.bridge(stage.entry(("sensor_msgs/msg/Image", "gz.msgs.Image")), monotonic=itertools.count().__next__)
    stage.gz.advertise(stage.topic, GzImage).publish(GzImage(pixel_format_type="RGB_FLOAT32"))
    assert said(f"gz.msgs.Image on {stage.topic} was bridged, but the pixel format RGB_FLOAT32")
    stage.ros_publisher(Image).publish(Image(encoding="yuv422"))
    warning = f"sensor_msgs/msg/Image on {stage.topic} was bridged, but the encoding 'yuv422'"
    eventually(lambda: said(warning), "the warning")
    (status,) = bridge.status()
    assert (status.gz_to_ros, status.ros_to_gz, status.dropped) == (1, 1, 0)


def test_frame_and_stamp_can_be_overridden(stage):
    held = []
    own = stage.entry(SCAN, Direction.GZ_TO_ROS, frame_id="own")
    general = BridgeEntry(f"{stage.topic}/b", stage.topic, *SCAN, Direction.GZ_TO_ROS)
    stage.bridge(
        own,
        general,
        publish=lambda _, message: held.append(message),
        overrides=HeaderOverrides(frame_id="general", wall_time=True),
    )
    stage.gz.advertise(stage.topic, GzLaserScan).publish(GzLaserScan(frame="lidar"))
    assert sorted(scan.header.frame_id for scan in held) == ["general", "own"]
    assert all(scan.header.stamp.sec > 1_600_000_000 for scan in held)


def test_the_owner_is_shown_what_comes_from_ros_even_if_it_is_dropped(stage, eventually):
    shown = []
    bridge = stage.bridge(
        stage.entry(direction=Direction.ROS_TO_GZ),
        heard=lambda entry, ros: shown.append((entry, ros.linear.x)),
    )
    twist = Twist()
    twist.linear.x = math.inf
    stage.ros_publisher(Twist).publish(twist)
    eventually(lambda: bridge.status()[0].dropped == 1, "the command is dropped")
    assert shown == [(bridge.entries[0], math.inf)]


def test_what_breaks_on_the_way_to_gazebo_is_counted_in_a_bridge_with_threads(stage, inbox, eventually):
    box, heard = inbox(), []

    def first_breaks(_, message):
        heard.append(message)
        if len(heard) == 1:
            raise RuntimeError("broken")

    stage.gz.subscribe(GzTwist, stage.topic, box)
    bridge = stage.bridge(stage.entry(direction=Direction.ROS_TO_GZ), heard=first_breaks, threaded=True)
    publisher = stage.ros_publisher(Twist)
    publisher.publish(Twist())
    publisher.publish(Twist())
    eventually(lambda: bridge.status()[0].ros_to_gz == 1, "the second one is counted")
    (status,) = bridge.status()
    assert (len(box.wait(1)), status.dropped, "broken" in status.last_error) == (1, 1, True)


def test_a_lazy_bridge_listens_only_while_somebody_listens_to_it(stage, inbox, eventually):
    bridge = stage.bridge(stage.entry(SCAN, Direction.GZ_TO_ROS, lazy=True), heartbeat=0.02)
    publisher = stage.gz.advertise(stage.topic, GzLaserScan)
    assert not publisher.has_connections()
    subscription = stage.ros_subscription(LaserScan, inbox())
    eventually(publisher.has_connections, "the bridge connects")
    stage.ros.node.destroy_subscription(subscription)
    eventually(lambda: not publisher.has_connections(), "the bridge disconnects")
    bridge.close()
    assert not list(stage.node.timers)


@with_and_without_threads
def test_a_lazy_bridge_to_gazebo_listens_only_while_somebody_listens_to_it(stage, inbox, eventually, threaded):
    stage.bridge(stage.entry(direction=Direction.ROS_TO_GZ, lazy=True), heartbeat=0.02, threaded=threaded)
    commands = inbox()
    publisher = stage.ros_publisher(Twist, listeners=0)
    assert publisher.get_subscription_count() == 0
    stage.gz.subscribe(GzTwist, stage.topic, commands)
    eventually(lambda: publisher.get_subscription_count() == 1, "the bridge connects")
    publisher.publish(Twist())
    commands.wait(1)
    stage.gz.unsubscribe(stage.topic)
    eventually(lambda: publisher.get_subscription_count() == 0, "the bridge disconnects")


@with_and_without_threads
def test_a_lazy_bridge_both_ways_is_not_kept_awake_by_itself(stage, inbox, eventually, threaded):
    bridge = stage.bridge(stage.entry(lazy=True), heartbeat=0.02, threaded=threaded)
    to_ros = bridge._to_ros[0]
    subscription = stage.ros_subscription(Twist, inbox())
    eventually(lambda: to_ros.connected and bridge._to_gz[0].connected, "both ways connect")
    stage.ros.node.destroy_subscription(subscription)
    eventually(lambda: not to_ros.connected, "nobody but the bridge itself listens to ROS")
    assert to_ros.publisher.get_subscription_count() <= 1


def endpoints(stage):
    return (
        len(list(stage.node.publishers)),
        len(list(stage.node.subscriptions)),
        len(list(stage.node.timers)),
        stage.gz_bridge.advertised_topics(),
        stage.gz_bridge.subscribed_topics(),
    )


@with_and_without_threads
def test_every_message_of_a_burst_reaches_a_subscription_with_room(stage, inbox, eventually, threaded):
    bridge = stage.bridge(stage.entry(JOINTS, Direction.GZ_TO_ROS), threaded=threaded)
    box = inbox()
    stage.ros_subscription(JointState, box, 1000)
    eventually(lambda: bridge._to_ros[0].publisher.get_subscription_count() == 1, "the bridge knows its subscriber")
    publisher = stage.gz.advertise(stage.topic, GzModel)
    for number in range(100):
        state = GzModel()
        state.joint.add(name="j").axis1.position = number
        publisher.publish(state)
    assert [message.position[0] for message in box.wait(100)] == list(range(100))
    assert bridge.status()[0].gz_to_ros == 100


@with_and_without_threads
def test_close_gives_everything_back_and_a_new_bridge_works(stage, inbox, threaded):
    before = endpoints(stage)
    entries = [stage.entry(lazy=True), BridgeEntry(f"{stage.topic}/s", f"{stage.topic}/s", *SCAN)]
    for _ in range(3):
        with stage.bridge(*entries, threaded=threaded) as bridge:
            assert endpoints(stage) != before
        bridge.close()
        assert endpoints(stage) == before
    commands = inbox()
    stage.gz.subscribe(GzTwist, stage.topic, commands)
    stage.gz.advertise(stage.topic, GzTwist).publish(GzTwist())
    assert bridge.status()[0].gz_to_ros == 0
    stage.bridge(stage.entry(direction=Direction.ROS_TO_GZ))
    stage.ros_publisher(Twist).publish(Twist())
    commands.wait(2)


def test_two_entries_may_share_a_gazebo_topic(stage):
    held = []
    bridge = stage.bridge(
        stage.entry(direction=Direction.GZ_TO_ROS),
        BridgeEntry(f"{stage.topic}/s", stage.topic, "geometry_msgs/msg/TwistStamped", "gz.msgs.Twist"),
        BridgeEntry(f"{stage.topic}/third", stage.topic, *TWIST, Direction.ROS_TO_GZ),
        publish=lambda _, message: held.append(type(message)),
    )
    stage.gz.advertise(stage.topic, GzTwist).publish(GzTwist())
    assert sorted(held, key=str) == [Twist, TwistStamped]
    assert [status.gz_to_ros for status in bridge.status()] == [1, 1, 0]


def test_entries_that_cannot_work_are_all_named_and_nothing_stays(stage):
    before = endpoints(stage)
    wrong = BridgeEntry("/a", "/a", "std_msgs/msg/Bol", "gz.msgs.Boolean", source="b.yaml:1")
    also = BridgeEntry("/b", "/b", "std_msgs/msg/Bool", "gz.msgs.Bolean", source="b.yaml:9")
    with pytest.raises(BridgeError) as caught:
        stage.bridge(stage.entry(), wrong, also)
    assert [sentence.split(": ")[0] for sentence in caught.value.errors] == ["b.yaml:1", "b.yaml:9"]
    with pytest.raises(BridgeError, match=r"carries gz\.msgs\.Twist already, not gz\.msgs\.LaserScan"):
        stage.bridge(
            stage.entry(direction=Direction.ROS_TO_GZ),
            BridgeEntry("/other", stage.topic, *SCAN, Direction.ROS_TO_GZ, source="b.yaml:3"),
        )
    with pytest.raises(BridgeError, match=r"b\.yaml:4: cannot bridge /1a"):
        stage.bridge(stage.entry(), BridgeEntry("/1a", "/a", *TWIST, source="b.yaml:4"))
    assert endpoints(stage) == before


def test_an_entry_from_the_command_line_runs(stage, inbox, eventually):
    bridge = stage.bridge(*read_arguments([f"{stage.topic}@sensor_msgs/msg/Image[gz.msgs.Image"]).topics)
    stage.ros_subscription(Image, images := inbox())
    eventually(lambda: bridge._to_ros[0].publisher.get_subscription_count() == 1, "the bridge knows its subscriber")
    pixels = bytes(range(12))
    stage.gz.advertise(stage.topic, GzImage).publish(
        GzImage(width=2, height=2, step=6, pixel_format_type="RGB_INT8", data=pixels)
    )
    (image,) = images.wait(1)
    assert (image.encoding, image.step, bytes(image.data)) == ("rgb8", 6, pixels)


def test_a_heavy_message_does_not_delay_another_topic(stage, inbox):
    entered, let_go, clocks, images = threading.Event(), threading.Event(), inbox(), inbox()

    def publish(publisher, message):
        if isinstance(message, Clock):
            clocks(message)
        else:
            entered.set()
            assert let_go.wait(120)
            images(message)

    image = BridgeEntry("/image", f"{stage.topic}/image", "sensor_msgs/msg/Image", "gz.msgs.Image", Direction.GZ_TO_ROS)
    clock = stage.entry(("rosgraph_msgs/msg/Clock", "gz.msgs.Clock"), Direction.GZ_TO_ROS)
    bridge = stage.bridge(image, clock, publish=publish, threaded=True)
    camera, time = bridge._to_ros
    picture = GzImage(width=200, height=200, step=600, pixel_format_type="RGB_INT8", data=bytes(120_000))
    from_another_process = MessageInfo(stage.topic, "gz.msgs.Image", "", False)
    for _ in range(20):
        camera._on_data(picture.SerializeToString(), from_another_process)
        assert entered.wait(120)
    time._on_data(GzClock().SerializeToString(), from_another_process)
    clocks.wait(1)
    assert images.messages == []
    let_go.set()
    images.wait(11)
    assert bridge.status()[0].skipped == 9, "a queue of ten, and the one it was at"
    bridge.close()
    assert not camera._worker._thread.is_alive()


@pytest.mark.parametrize("profile", sorted(QOS_PROFILES))
def test_every_profile_makes_endpoints(stage, profile):
    stage.bridge(stage.entry(SCAN, qos_profile=profile, publisher_queue=7))
    assert stage.topic in [publisher.topic_name for publisher in stage.node.publishers]
    assert stage.topic in [subscription.topic_name for subscription in stage.node.subscriptions]
