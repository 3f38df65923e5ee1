"""A listener passes ROS messages on in its own thread, independently of the node's executor."""

import threading
import uuid

import pytest
from geometry_msgs.msg import Twist
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32

from gz_course.sim.bridge.ros_gz_bridge.ros_listener import RosListener

DEADLINE = 120.0


def fails(error):
    raise AssertionError(error)


class Listened:
    """A node with a listener, on topics that no other program uses."""

    def __init__(self, ros, eventually):
        self.ros = ros
        self.node = ros.new_node(f"listened_{uuid.uuid4().hex}")
        self.listener = RosListener(ros.context)
        self.name = f"/t{uuid.uuid4().hex}"
        self._eventually = eventually

    def add(self, name, callback, message_type=Int32, failed=fails):
        subscription = self.node.create_subscription(
            message_type,
            self.name + name,
            lambda _: fails("an executor took it"),
            10,
            callback_group=self.listener.group,
        )
        self.listener.add(subscription, callback, failed)
        return subscription

    def publisher(self, name, message_type=Int32, qos=10):
        publisher = self.ros.node.create_publisher(message_type, self.name + name, qos)
        if qos == 10:
            self._eventually(publisher.get_subscription_count, "the listener's subscription is found")
        return publisher


@pytest.fixture
def listened(ros, eventually):
    new = Listened(ros, eventually)
    yield new
    new.listener.close()
    new.ros.drop_node(new.node)


def test_messages_of_several_topics_come_in_order_with_their_stamps_in_one_thread(listened, inbox):
    first, second, threads = inbox(), inbox(), set()

    def callback(box):
        def keep(message, info):
            threads.add(threading.current_thread())
            box((message.data, info["source_timestamp"]))

        return keep

    listened.add("/first", callback(first))
    listened.add("/second", callback(second))
    publishers = listened.publisher("/first"), listened.publisher("/second")
    for burst in range(5):
        for number in range(8 * burst, 8 * burst + 8):
            for publisher in publishers:
                publisher.publish(Int32(data=number))
        for box in (first, second):
            box.wait(8 * burst + 8)
    for box in (first, second):
        assert [number for number, _ in box.messages] == list(range(40))
        stamps = [stamp for _, stamp in box.messages]
        assert stamps == sorted(stamps) and stamps[0] > 0
    assert len(threads) == 1 and threads != {listened.ros._thread}


def test_a_busy_executor_delays_nothing(listened, inbox):
    entered, let_go, box = threading.Event(), threading.Event(), inbox()

    def busy():
        entered.set()
        let_go.wait(DEADLINE)

    listened.add("/command", lambda message, _: box(message), Twist)
    publisher = listened.publisher("/command", Twist)
    timer = listened.node.create_timer(0.001, busy)
    assert entered.wait(DEADLINE)
    publisher.publish(Twist())
    box.wait(1)
    listened.node.destroy_timer(timer)
    let_go.set()


def test_what_a_callback_raises_is_told_and_the_next_message_comes(listened, inbox):
    box, failures = inbox(), inbox()

    def callback(message, _):
        if message.data == 0:
            raise ValueError("nothing")
        box(message.data)

    listened.add("/number", callback, failed=lambda error: failures(str(error)))
    publisher = listened.publisher("/number")
    for number in (0, 1):
        publisher.publish(Int32(data=number))
    assert box.wait(1) == [1]
    assert failures.messages == ["nothing"]


def test_a_publisher_that_cannot_match_is_told_of(listened, eventually, capfd):
    listened.add("/wanted", lambda *_: None)
    listened.publisher("/wanted", qos=QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT))
    said = []

    def warned():
        said.append(capfd.readouterr().err)
        return "offering incompatible QoS" in "".join(said)

    eventually(warned, "the warning of rclpy")


def test_subscriptions_come_and_go(listened, inbox, eventually):
    old, new = inbox(), inbox()
    gone = listened.add("/number", lambda message, _: old(message))
    publisher = listened.publisher("/number")
    publisher.publish(Int32())
    old.wait(1)
    listened.listener.remove(gone)
    listened.node.destroy_subscription(gone)
    eventually(lambda: publisher.get_subscription_count() == 0, "the subscription is given back")
    listened.add("/number", lambda message, _: new(message))
    eventually(publisher.get_subscription_count, "the new one is found")
    publisher.publish(Int32())
    new.wait(1)
    assert len(old.messages) == 1


def test_one_that_was_destroyed_before_it_was_removed_disturbs_no_other(listened, inbox):
    box = inbox()
    listened.node.destroy_subscription(listened.add("/gone", lambda *_: None))
    listened.add("/number", lambda message, _: box(message))
    listened.publisher("/number").publish(Int32())
    box.wait(1)


def test_closing_ends_the_thread_and_may_be_repeated(listened):
    listened.add("/number", lambda *_: None)
    thread = listened.listener._thread
    assert thread.is_alive()
    listened.listener.close()
    listened.listener.close()
    assert not thread.is_alive()
