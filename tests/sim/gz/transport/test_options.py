"""Options: the accessors of the official binding, copies, limits; the effect of the names of Fortress on a topic."""

import copy

import pytest

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.msgs.imu_pb2 import IMU
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.transport import (
    UNTHROTTLED,
    AdvertiseMessageOptions,
    AdvertiseOptions,
    AdvertiseServiceOptions,
    Node,
    NodeOptions,
    Scope,
    SubscribeOptions,
)


@pytest.mark.parametrize(
    "options",
    [
        AdvertiseMessageOptions(scope=Scope.HOST, msgs_per_sec=3, fortress=True),
        AdvertiseServiceOptions(Scope.PROCESS),
        AdvertiseOptions(Scope.HOST),
        SubscribeOptions(msgs_per_sec=7, ignore_local_messages=True),
        NodeOptions(partition="p", namespace="n"),
    ],
)
def test_copies_are_equal_and_independent(options):
    for other in (copy.copy(options), copy.deepcopy(options), type(options)(options)):
        assert other == options
        assert type(other) is type(options)
        attribute, value = ("namespace", "m") if isinstance(options, NodeOptions) else ("msgs_per_sec", 9)
        setattr(other, attribute, value)
        assert other != options


def test_rates():
    for options in (AdvertiseMessageOptions(), SubscribeOptions()):
        assert (options.throttled, options.msgs_per_sec) == (False, UNTHROTTLED)
        options.msgs_per_sec = 10
        assert (options.throttled, options.msgs_per_sec) == (True, 10)
        for wrong in (0, -1, 1.5, True, 2**64):
            with pytest.raises(ValueError, match="msgs_per_sec"):
                options.msgs_per_sec = wrong


def test_scope():
    options = AdvertiseMessageOptions()
    assert options.scope is Scope.ALL
    options.scope = 1
    assert options.scope is Scope.HOST
    with pytest.raises(ValueError, match="7"):
        options.scope = 7


def test_remappings(capsys):
    options = NodeOptions()
    assert options.topic_remap("/a") == (False, "")
    assert options.add_topic_remap("/a", "/b")
    assert not options.add_topic_remap("/a", "/c")
    assert options.topic_remap("/a") == (True, "/b")
    other = NodeOptions(options)
    other.add_topic_remap("/d", "/e")
    assert options.topic_remap("/d") == (False, "")
    assert not options.add_topic_remap("/x", "/y z")
    assert "must not contain a space" in capsys.readouterr().err


def test_a_name_that_is_not_valid_leaves_the_option_as_it_was(capsys):
    options = NodeOptions(partition="class", namespace="robot")
    options.partition, options.namespace = "a@b", "x//y"
    assert (options.partition, options.namespace) == ("class", "robot")
    first, second = capsys.readouterr().err.splitlines()
    assert "It stays 'class'" in first
    assert "'//'" in second


@pytest.fixture
def node():
    with Node(NodeOptions(scope=Scope.PROCESS)) as each:
        yield each


@pytest.mark.parametrize("fortress", [False, True])
@pytest.mark.parametrize("wanted", ["gz.msgs.IMU", "ignition.msgs.IMU", "gz.msgs.Twist", "ignition.msgs.Twist"])
def test_old_and_new_names_meet_on_a_topic(node, inbox, new_inbox, fortress, wanted):
    kind = message_class(wanted.replace("ignition.", "gz."))
    raw = new_inbox()
    node.subscribe(message_class(wanted), "/topic", inbox)
    node.subscribe_raw("/topic", lambda data, info: raw((data, info.type)), wanted)
    publisher = node.advertise("/topic", kind, AdvertiseMessageOptions(fortress=fortress))
    message = kind()
    (message.angular if kind is Twist else message.angular_velocity).z = 0.5
    assert publisher.publish(message)
    (arrived,), ((data, said),) = inbox.take(), raw.take()
    assert (arrived.angular if kind is Twist else arrived.angular_velocity).z == 0.5
    assert message_class(said).FromString(data) == arrived


def test_what_is_announced(node):
    node.advertise("/new", IMU)
    node.advertise("/old", IMU, AdvertiseMessageOptions(fortress=True))
    names = {topic: node.topic_info(topic)[0][0].msg_type_name for topic in ("/new", "/old")}
    assert names == {"/new": "gz.msgs.IMU", "/old": "ignition.msgs.IMU"}
    assert node.topic_info("/old")[0][0].options == AdvertiseMessageOptions(Scope.PROCESS)


def test_broken_bytes_of_the_old_kind_reach_nobody(node, inbox):
    node.subscribe(IMU, "/topic", inbox)
    publisher = node.advertise("/topic", "ignition.msgs.IMU")
    assert publisher.publish_raw(b"\xff", "ignition.msgs.IMU")
    assert publisher.publish_raw(b"", "ignition.msgs.IMU")
    assert inbox.take() == [IMU()]
