"""Interfaces made at run time over real DDS: topics, services with their events, actions, and bytes that are wrong."""

import gc
import logging
import sys
import threading

import pytest
from rclpy.action import ActionClient, ActionServer
from rclpy.qos import qos_profile_services_default
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.service_introspection import ServiceIntrospectionState

from gz_course.sim.ros.rosidl import message_type_support
from gz_course.tests.sim.ros.rosidl import every_kind
from gz_course.tests.sim.ros.rosidl.messages import as_values, fill, message_pairs, seeded


@pytest.fixture(scope="module")
def modules(tmp_path_factory, packages_in):
    with pytest.MonkeyPatch.context() as patch:
        prefix = tmp_path_factory.mktemp("prefix")
        patch.setenv("AMENT_PREFIX_PATH", str(prefix), prepend=":")
        made = packages_in(prefix).load(every_kind.TEXTS)
        yield made


def carry(ros, sent_class, taken_class, topic, messages):
    """Publish messages from one node to the other; return what arrives."""
    got = []
    publisher = ros.nodes[0].create_publisher(sent_class, topic, 100)
    subscription = ros.nodes[1].create_subscription(taken_class, topic, got.append, 100)
    ros.until(lambda: publisher.get_subscription_count() and subscription.get_publisher_count(), "a match")
    for message in messages:
        publisher.publish(message)
    ros.until(lambda: len(got) == len(messages), "all messages")
    ros.nodes[0].destroy_publisher(publisher)
    ros.nodes[1].destroy_subscription(subscription)
    return got


def test_every_kind_of_field_arrives(ros, modules):
    pick = seeded()
    for name in every_kind.MESSAGES:
        made = getattr(modules[0], name)
        sent = [made(), *(fill(made(), pick) for _ in range(3))]
        got = carry(ros, made, made, f"kind_{name.lower()}", sent)
        assert [as_values(each) for each in got] == [as_values(each) for each in sent]
        assert type(got[0]) is made


def twins_exchange(ros, pairs, rounds):
    pick = seeded(3)
    for index, (ours, theirs) in enumerate(pairs):
        state = pick.getstate()
        mine = [fill(ours(), pick) for _ in range(rounds)]
        pick.setstate(state)
        twins = [fill(theirs(), pick) for _ in range(rounds)]
        wanted = [as_values(each) for each in twins]
        assert [as_values(each) for each in carry(ros, ours, theirs, f"to{index}", mine)] == wanted
        assert [as_values(each) for each in carry(ros, theirs, ours, f"from{index}", twins)] == wanted


def test_compiled_twins_understand_each_other(ros):
    pairs = {f"{ours.__module__}.{ours.__name__}": (ours, theirs) for ours, theirs in message_pairs()}
    some = ("sensor_msgs.msg._point_cloud2.PointCloud2", "nav_msgs.msg._odometry.Odometry")
    twins_exchange(ros, [pairs[name] for name in some], 2)


@pytest.mark.proof
def test_all_compiled_twins_understand_each_other(ros):
    twins_exchange(ros, list(message_pairs()), 3)


def test_a_service_answers_and_publishes_its_events(ros, modules):
    ask = modules[1].Ask
    server, client_node = ros.nodes
    pick = seeded(5)
    answer = fill(ask.Response(), pick)
    client, service = client_node.create_client(ask, "ask"), server.create_service(ask, "ask", lambda _, __: answer)
    events = []
    server.create_subscription(ask.Event, "ask/_service_event", events.append, 10)
    for end in (client, service):
        end.configure_introspection(
            server.get_clock(), qos_profile_services_default, ServiceIntrospectionState.CONTENTS
        )
    assert client.wait_for_service(60)
    ros.until(lambda: server.count_publishers("ask/_service_event") == 2, "both ends of the service")
    question = fill(ask.Request(), pick)
    assert as_values(ros.result(client.call_async(question))) == as_values(answer)
    ros.until(lambda: len(events) == 4, "the four events of a call")
    assert sorted(each.info.event_type for each in events) == [0, 1, 2, 3]
    for each in events:
        held = each.request or each.response
        assert as_values(held[0]) == as_values(question if each.request else answer)
    client.destroy()
    service.destroy()


def test_an_action_gives_feedback_and_a_result_and_can_be_cancelled(ros, modules):
    do = modules[2].Do
    pick = seeded(6)
    result, step = fill(do.Result(), pick), fill(do.Feedback(), pick)
    cancelled = threading.Event()

    def execute(goal):
        goal.publish_feedback(step)
        if cancelled.is_set():
            goal.abort()
        else:
            goal.succeed()
        return result

    server = ActionServer(ros.nodes[0], do, "do", execute)
    client = ActionClient(ros.nodes[1], do, "do")
    assert client.wait_for_server(60)
    steps = []
    goal = ros.result(client.send_goal_async(fill(do.Goal(), pick), steps.append))
    assert goal.accepted
    answer = ros.result(goal.get_result_async())
    assert (answer.status, as_values(answer.result)) == (4, as_values(result))
    ros.until(lambda: steps, "the feedback")
    assert as_values(steps[0].feedback) == as_values(step)
    assert ros.result(goal.cancel_goal_async()).return_code != 0, "it has ended"
    client.destroy()
    server.destroy()


def test_bytes_that_are_no_message_are_dropped_with_one_warning(ros, modules, caplog):
    made = modules[0].Sequence
    good = serialize_message(fill(made(), seeded(8)))
    got = []
    publisher = ros.nodes[0].create_publisher(made, "damaged", 100)
    subscription = ros.nodes[1].create_subscription(made, "damaged", got.append, 100)
    ros.until(lambda: publisher.get_subscription_count() and subscription.get_publisher_count(), "a match")
    with caplog.at_level(logging.WARNING, "rosidl"):
        for wrong in (good[:40], good[:4], b"\0\7\0\0" + good[4:], good[:4] + b"\xff\xff\xff\x7f" + good[8:]):
            publisher.publish(wrong)
        publisher.publish(made(sequence5=[1, 2]))
        ros.until(lambda: got, "the message that is right")
    assert len(got) == 1 and got[0].sequence5.tolist() == [1, 2]
    (warning,) = caplog.messages
    assert f"A message that is no {made.__module__.split('.')[0]}/msg/Sequence was dropped: " in warning


def test_damaged_bytes_never_leave_the_type_support(modules):
    made, pick = modules[0].Sequence, seeded(9)
    for _ in range(200):
        data = bytearray(serialize_message(fill(made(), pick)))
        for _ in range(3):
            data[pick.randrange(len(data))] = pick.randrange(256)
        try:
            deserialize_message(bytes(data[: pick.randrange(4, len(data))]), made)
        except Exception as error:
            assert "failed to deserialize" in str(error)


def test_a_wrong_value_is_named_by_the_one_who_publishes(ros, modules):
    made = modules[0].Plain
    publisher = ros.nodes[0].create_publisher(made, "wrong", 1)
    message = made()
    message.plain17.d = 5
    with pytest.raises(TypeError, match=r"/msg/Plain cannot be sent: in plain17: The 'd' field must be of type 'str'"):
        publisher.publish(message)
    for field, wrong, wanted in (("plain4", 3, "float"), ("plain0", 1, "bool")):
        message = made(**{field: wrong})
        with pytest.raises(TypeError, match=f"cannot be sent: The '{field}' field must be of type '{wanted}'"):
            publisher.publish(message)
    message = made()
    message.plain5 = 1000
    with pytest.raises(TypeError, match=r"cannot be sent: The 'plain5' field must be an integer in \[-128, 127\]"):
        publisher.publish(message)


def test_threads_may_publish_on_one_publisher(ros, modules, in_thread):
    made = modules[0].Inner
    got = []
    publisher = ros.nodes[0].create_publisher(made, "threads", 2000)
    subscription = ros.nodes[1].create_subscription(made, "threads", got.append, 2000)
    ros.until(lambda: publisher.get_subscription_count() and subscription.get_publisher_count(), "a match")
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        threads = [in_thread(lambda: [publisher.publish(made(d="x" * 50)) for _ in range(300)]) for _ in range(3)]
        ros.until(lambda: len(got) == 900, "all messages")
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(interval)


def test_no_memory_is_kept(ros, modules):
    made = modules[0].Inner
    carry(ros, made, made, "kept", [made(d="x")] * 50)
    gc.collect()
    assert message_type_support._boxes == {}
