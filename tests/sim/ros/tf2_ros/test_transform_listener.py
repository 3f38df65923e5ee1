"""Broadcasters, listener and Buffer over real DDS: what is sent is found, waited for, and told by a service."""

import threading
import time

import pytest
from rclpy.duration import Duration
from rclpy.time import Time

from gz_course.tests.sim.ros.tf2_py.transforms import stamped

DEADLINE = Duration(seconds=120.0)


@pytest.fixture
def listening(ros_node):
    """Return a Buffer that hears what the node hears."""
    from gz_course.sim.ros.tf2_ros import Buffer, TransformListener

    buffer = Buffer(node=ros_node)
    listener = TransformListener(buffer, ros_node)
    yield buffer
    listener.unregister()


@pytest.fixture
def other_node(ros_node):
    """Return a node in another participant than `ros_node`; nobody spins it."""
    import rclpy

    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_node.context.get_domain_id())
    node = rclpy.create_node("sender", namespace="/away", context=context)
    yield node
    node.destroy_node()
    context.try_shutdown()


def test_what_is_broadcast_is_found(listening, ros_node, other_node, spin_until):
    from tf2_msgs.srv import FrameGraph

    from gz_course.sim.ros.tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

    static, moving = StaticTransformBroadcaster(other_node), TransformBroadcaster(other_node)
    static.sendTransform([stamped("map", "odom", place=(1, 0, 0)), stamped("base", "lidar", place=(0, 0, 0.5))])
    stamps = iter(range(1, 10_000))
    spin_until(
        lambda: moving.sendTransform(stamped("odom", "base", next(stamps), (0, 2, 0))) or ("lidar" in listening._frames
        and listening.can_transform("map", "lidar", Time())),
        "the chain",
    )  # fmt: skip
    found = listening.lookup_transform("map", "lidar", Time())
    place = found.transform.translation
    assert (place.x, place.y, place.z) == (1.0, 2.0, 0.5)
    assert (found.header.frame_id, found.child_frame_id) == ("map", "lidar")
    assert listening.can_transform("map", "x", Time(), return_debug_tuple=True)[1].startswith("Invalid frame ID")

    client = other_node.create_client(FrameGraph, "/tf2_frames")
    spin_until(client.service_is_ready, "the service")
    answer = client.call_async(FrameGraph.Request())
    heard = threading.Thread(target=_spin_until_done, args=(other_node, answer))
    heard.start()
    spin_until(lambda: not heard.is_alive(), "an answer")
    heard.join()
    assert (
        "lidar: \n  parent: 'base'\n  broadcaster: 'default_authority'\n  rate: 10000.000" in answer.result().frame_yaml
    )


def _spin_until_done(node, future):
    from rclpy.executors import SingleThreadedExecutor

    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    executor.spin_until_future_complete(future, timeout_sec=120.0)
    executor.shutdown()


def test_quality_of_service(listening, ros_node):
    from rclpy.qos import DurabilityPolicy, ReliabilityPolicy

    from gz_course.sim.ros.tf2_ros import StaticTransformBroadcaster, TransformBroadcaster

    static, moving = StaticTransformBroadcaster(ros_node).pub_tf, TransformBroadcaster(ros_node).pub_tf
    listeners = {each.topic_name: each for each in ros_node.subscriptions if each.topic_name.startswith("/tf")}
    for endpoint, topic, depth, durability in (
        (moving, "/tf", 100, DurabilityPolicy.VOLATILE),
        (static, "/tf_static", 1, DurabilityPolicy.TRANSIENT_LOCAL),
        (listeners["/tf"], "/tf", 100, DurabilityPolicy.VOLATILE),
        (listeners["/tf_static"], "/tf_static", 100, DurabilityPolicy.TRANSIENT_LOCAL),
    ):
        profile = endpoint.qos_profile
        assert (endpoint.topic_name, profile.depth, profile.durability) == (topic, depth, durability)
        assert profile.reliability == ReliabilityPolicy.RELIABLE


def test_a_lookup_waits_while_a_thread_listens(ros_node):

    from gz_course.sim.ros.tf2_ros import Buffer, StaticTransformBroadcaster, TransformListener

    buffer = Buffer()
    listener = TransformListener(buffer, ros_node, spin_thread=True)
    try:
        static = StaticTransformBroadcaster(ros_node)
        static.sendTransform(stamped("a", "b", place=(3, 0, 0)))
        assert buffer.lookup_transform("a", "b", Time(), DEADLINE).transform.translation.x == 3.0
        assert buffer.can_transform_full("a", Time(), "b", Time(), "a", DEADLINE)
    finally:
        listener.executor.shutdown()
        listener.dedicated_listener_thread.join(120.0)
    assert not listener.dedicated_listener_thread.is_alive()


def test_who_waits_is_woken_or_gives_up():
    from gz_course.sim.ros.tf2_ros import Buffer, LookupException

    buffer = Buffer()
    began = time.monotonic()
    with pytest.raises(LookupException, match='"a" passed to lookupTransform argument target_frame does not exist'):
        buffer.lookup_transform("a", "b", Time(), Duration(seconds=0.05))
    assert time.monotonic() - began >= 0.05
    sender = threading.Thread(target=buffer.set_transform, args=(stamped("a", "b", 1.0), "me"))
    sender.start()
    found = buffer.lookup_transform_full("a", Time(), "b", Time(), "a", DEADLINE)
    sender.join()
    assert found.child_frame_id == "b"


def test_futures():
    from gz_course.sim.ros.tf2_ros import Buffer

    buffer = Buffer()
    future = buffer.wait_for_transform_async("a", "b", Time())
    later = buffer.wait_for_transform_async("a", "b", Time(nanoseconds=15 * 10**8))
    full = buffer.wait_for_transform_full_async("a", Time(), "b", Time(), "a")
    waiting = buffer.lookup_transform_async("a", "b", Time())
    assert waiting.send(None) is None and not future.done()
    buffer.set_transform(stamped("a", "b", 1.0, (1, 0, 0)), "me")
    assert future.result().transform.translation.x == 1.0
    assert full.done() and not later.done()
    with pytest.raises(StopIteration) as ended:
        waiting.send(None)
    assert ended.value.value.child_frame_id == "b"
    buffer.set_transform(stamped("a", "b", 2.0, (2, 0, 0)), "me")
    assert later.result().transform.translation.x == 1.5
    assert buffer.wait_for_transform_async("a", "b", Time()).done()
    assert buffer._waiting == []


def test_a_clock_that_jumps_back_clears_the_buffer(ros_node):
    from rclpy.parameter import Parameter

    from gz_course.sim.ros.tf2_ros import Buffer

    ros_node.set_parameters([Parameter("use_sim_time", value=True)])
    buffer = Buffer(node=ros_node)
    clock = ros_node.get_clock()
    clock.set_ros_time_override(Time(seconds=10, clock_type=clock.clock_type))
    buffer.set_transform(stamped("a", "b", 9.0), "me")
    clock.set_ros_time_override(Time(seconds=11, clock_type=clock.clock_type))
    assert buffer.can_transform("a", "b", Time())
    clock.set_ros_time_override(Time(seconds=1, clock_type=clock.clock_type))
    assert not buffer.can_transform("a", "b", Time())


def test_an_interface_without_lookups():
    from gz_course.sim.ros.tf2_ros import BufferInterface, NotImplementedException

    interface = BufferInterface()
    for call in (interface.lookup_transform, interface.can_transform):
        with pytest.raises(NotImplementedException, match="CanTransform or LookupTransform not implemented"):
            call("a", "b", Time())
