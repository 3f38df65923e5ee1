"""A bridge does not bridge its own messages back, whatever DDS makes of their values."""

from geometry_msgs.msg import Twist
from google.protobuf.descriptor import FieldDescriptor

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.bridge import contents
from gz_course.sim.bridge.ros_gz_bridge.echo_filter import delivered
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.gz.msgs.battery_state_pb2 import BatteryState as GzBatteryState
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg as GzStringMsg
from gz_course.sim.gz.msgs.twist_pb2 import Twist as GzTwist
from gz_course.tests.sim.bridge.ros_gz_bridge.stage import SCAN, with_and_without_threads

NOT_EXACT = 0.1
_VALUES = {
    FieldDescriptor.CPPTYPE_DOUBLE: NOT_EXACT,
    FieldDescriptor.CPPTYPE_FLOAT: NOT_EXACT,
    FieldDescriptor.CPPTYPE_BOOL: True,
    FieldDescriptor.CPPTYPE_STRING: "a\0b",
    FieldDescriptor.CPPTYPE_ENUM: 1,
}
_LENGTHS = {"covariance": 9, "k": 9, "rectification_matrix": 9, "p": 12}


def fill(gz, depth=0):
    """Set every field, lists to as many items as their conversion wants; return the message."""
    for field in gz.DESCRIPTOR.fields:
        inside = field.message_type
        if inside is not None and inside.GetOptions().map_entry:
            gz_map = getattr(gz, field.name)
            fill(gz_map["name"], depth + 1)
        elif inside is not None and field.is_repeated:
            if depth < 4:
                fill(getattr(gz, field.name).add(), depth + 1)
        elif inside is not None:
            if depth < 4:
                getattr(gz, field.name).SetInParent()
                fill(getattr(gz, field.name), depth + 1)
        elif field.is_repeated:
            value = _value(field)
            getattr(gz, field.name).extend([value] * _LENGTHS.get(field.name, 1))
        elif field.containing_oneof is None:
            setattr(gz, field.name, _value(field))
    return gz


def _value(field):
    if field.type == FieldDescriptor.TYPE_BYTES:
        return b"a\0b"
    return _VALUES.get(field.cpp_type, 1)


def test_every_pair_compares_what_dds_delivers():
    changed = set()
    for pair in type_pairs.pairs():
        arrived, sent = contents(pair)
        gz = fill(pair.gz_class())
        if pair.gz_type == "gz.msgs.Image":
            gz.step, gz.data = 1, b"a"
        ros = pair.to_ros(gz)
        name = f"{pair.ros_type}={pair.gz_type}"
        assert sent(ros) == arrived(delivered(ros)), name
        assert sent(ros) or pair.gz_type == "gz.msgs.Empty", f"{name} cannot be told from others"
        if arrived(ros) != sent(ros):
            changed.add(pair.ros_class.__name__)
    assert changed >= {"LaserScan", "Range", "BatteryState", "String"}


@with_and_without_threads
def test_both_ways_without_echo_and_without_losing_repeats(stage, inbox, eventually, threaded):
    bridge = stage.bridge(stage.entry(), threaded=threaded)
    at_gz, at_ros = inbox(), inbox()
    stage.gz.subscribe(GzTwist, stage.topic, at_gz)
    stage.ros_subscription(Twist, at_ros)
    from_ros, from_gz = stage.ros_publisher(Twist, listeners=2), stage.gz.advertise(stage.topic, GzTwist)
    eventually(lambda: bridge._to_ros[0].publisher.get_subscription_count() == 2, "the bridge sees both listeners")
    rounds = 40
    for number in range(1, rounds + 1):
        from_gz.publish(GzTwist())
        from_ros.publish(Twist())
        at_gz.wait(2 * number)
        at_ros.wait(2 * number)
        eventually(lambda wanted=number: bridge.status()[0].echoes == wanted, "the echo is recognised")
    (status,) = bridge.status()
    assert (status.ros_to_gz, status.gz_to_ros, status.dropped) == (rounds, rounds, 0)
    assert (len(at_gz.messages), len(at_ros.messages)) == (2 * rounds, 2 * rounds)


@with_and_without_threads
def test_numbers_that_dds_rounds_make_no_second_message(stage, inbox, eventually, threaded):
    types = [
        SCAN,
        ("sensor_msgs/msg/BatteryState", "gz.msgs.BatteryState"),
        ("std_msgs/msg/String", "gz.msgs.StringMsg"),
    ]
    entries = [BridgeEntry(f"{stage.topic}/n{n}", f"{stage.topic}/n{n}", *each) for n, each in enumerate(types)]
    bridge = stage.bridge(*entries, threaded=threaded)
    messages = [GzLaserScan(range_max=0.1, angle_step=0.1), GzBatteryState(voltage=0.1), GzStringMsg(data="a\0b")]
    for number, message in enumerate(messages):
        box = inbox()
        stage.gz.subscribe(type(message), f"{stage.topic}/n{number}", box)
        to_ros = bridge._to_ros[number].publisher
        eventually(lambda to_ros=to_ros: to_ros.get_subscription_count() == 1, "the bridge hears itself")
        stage.gz.advertise(f"{stage.topic}/n{number}", type(message)).publish(message)
        eventually(lambda n=number: bridge.status()[n].echoes + bridge.status()[n].ros_to_gz, "the echo has arrived")
        assert (bridge.status()[number].echoes, len(box.wait(1))) == (1, 1)


def test_an_echo_is_recognised_when_the_owner_releases_the_message_later(stage, eventually):
    held = []
    bridge = stage.bridge(stage.entry(), publish=lambda publisher, message: held.append((publisher, message)))
    from_gz = stage.gz.advertise(stage.topic, GzTwist)
    eventually(lambda: bridge._to_ros[0].publisher.get_subscription_count() == 1, "the bridge hears itself")
    for number in range(1, 6):
        from_gz.publish(GzTwist())
        publisher, message = held.pop()
        publisher.publish(message)
        eventually(lambda wanted=number: bridge.status()[0].echoes == wanted, "the echo is recognised")
    assert bridge.status()[0].ros_to_gz == 0


def test_two_opposite_entries_do_not_circulate(stage, inbox, eventually):
    bridge = stage.bridge(stage.entry(direction=Direction.GZ_TO_ROS), stage.entry(direction=Direction.ROS_TO_GZ))
    at_ros = inbox()
    stage.ros_subscription(Twist, at_ros)
    eventually(lambda: bridge._to_ros[0].publisher.get_subscription_count() == 2, "the bridge sees both listeners")
    stage.gz.advertise(stage.topic, GzTwist).publish(GzTwist())
    at_ros.wait(1)
    eventually(lambda: bridge.status()[1].echoes == 1, "the echo is recognised")
    assert [status.ros_to_gz for status in bridge.status()] == [0, 0]
