"""Topics between processes, as seen from both sides."""

import threading

import pytest
import zmq

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, NodeOptions, inlet
from gz_course.sim.gz.transport.naming import fully_qualified


@pytest.fixture
def node():
    with Node() as each:
        yield each


def test_publisher_here_first_then_subscriber_there(node, start_peer):
    publisher = node.advertise("/chat", StringMsg)
    assert not publisher.has_connections()
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    assert publisher.wait_for_subscribers(timeout=120)
    assert publisher.has_connections()
    assert publisher.publish(StringMsg(data="first"))
    assert peer.heard() == [("/chat", "first")]


def test_subscriber_here_first_then_publisher_there(node, start_peer, inbox):
    node.subscribe(StringMsg, "/chat", inbox)
    peer = start_peer()
    peer.ask("advertise", topic="/chat")
    assert peer.ask("wait", topic="/chat")
    assert peer.ask("publish", topic="/chat", text="first")
    assert [message.data for message in inbox.take()] == ["first"]


def test_the_first_message_after_waiting_is_never_lost(node, start_peer):
    peer = start_peer()
    for number in range(30):
        topic = f"/round{number}"
        publisher = node.advertise(topic, StringMsg)
        peer.ask("subscribe", topic=topic)
        assert publisher.wait_for_subscribers(timeout=120)
        publisher.publish(StringMsg(data="first"))
        assert peer.heard() == [(topic, "first")]


def test_a_publisher_waits_for_as_many_processes_as_it_wants(node, start_peer):
    publisher = node.advertise("/chat", StringMsg)
    first, second = start_peer(), start_peer()
    first.ask("subscribe", topic="/chat")
    assert publisher.wait_for_subscribers(timeout=120)
    assert not publisher.wait_for_subscribers(count=2, timeout=0.05)
    second.ask("subscribe", topic="/chat")
    assert publisher.wait_for_subscribers(count=2, timeout=120)
    publisher.publish(StringMsg(data="both"))
    assert first.heard() == second.heard() == [("/chat", "both")]


def test_a_killed_publisher_is_replaced_by_its_successor(node, start_peer, inbox):
    node.subscribe(StringMsg, "/chat", inbox)
    for text in ("before", "after"):
        peer = start_peer()
        peer.ask("advertise", topic="/chat")
        assert peer.ask("wait", topic="/chat")
        peer.ask("publish", topic="/chat", text=text)
        assert [message.data for message in inbox.take()] == [text]
        peer.kill()


def test_a_subscriber_that_unsubscribes_is_no_connection_any_more(node, start_peer):
    publisher = node.advertise("/chat", StringMsg)
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    assert publisher.wait_for_subscribers(timeout=120)
    assert peer.ask("unsubscribe", topic="/chat")
    from gz_course.sim.gz.transport.switchboard import SWITCHBOARD

    assert SWITCHBOARD.wait_for(lambda: not publisher.has_connections(), 20)


def test_a_killed_subscriber_is_no_connection_any_more(node, start_peer):
    from gz_course.sim.gz.transport.switchboard import SWITCHBOARD

    publisher = node.advertise("/chat", StringMsg)
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    assert publisher.wait_for_subscribers(timeout=120)
    peer.kill()
    assert SWITCHBOARD.wait_for(lambda: not publisher.has_connections(), 20)


def test_partitions_do_not_hear_one_another(start_peer, new_inbox):
    same, other = new_inbox(), new_inbox()
    with Node(NodeOptions(partition="left")) as left, Node(NodeOptions(partition="right")) as right:
        left.subscribe(StringMsg, "/chat", same)
        right.subscribe(StringMsg, "/chat", other)
        peer = start_peer()
        peer.ask("advertise", topic="/chat", partition="left")
        assert peer.ask("wait", topic="/chat")
        for text in ("one", "two"):
            peer.ask("publish", topic="/chat", text=text)
        assert [message.data for message in same.take(2)] == ["one", "two"]
        assert other.empty()
        assert right.topic_info("/chat")[0] == []


def test_lists_show_what_other_processes_have(node, start_peer):
    peer = start_peer()
    peer.ask("advertise", topic="/b_published")
    peer.ask("subscribe", topic="/a_subscribed")
    assert node.topic_list() == ["/b_published", "/a_subscribed"]
    (publisher,), subscribers = node.topic_info("/b_published")
    assert publisher.addr.startswith("tcp://127.0.0.1:")
    assert (publisher.topic, publisher.msg_type_name, subscribers) == (
        "/b_published",
        "gz.msgs.StringMsg",
        [],
    )
    publishers, (subscriber,) = node.topic_info("/a_subscribed")
    assert (subscriber.msg_type_name, publishers) == ("gz.msgs.StringMsg", [])


@pytest.mark.parametrize("ending", ["exit", "exception"])
def test_the_others_are_told_at_the_end(start_peer, eavesdropper, ending, partition):
    name = fully_qualified(partition, "", "/chat")
    peer = start_peer()
    peer.ask("advertise", topic="/chat")
    process = eavesdropper.until(lambda m: m.type == Discovery.ADVERTISE and m.pub.topic == name)[-1].process_uuid
    if ending == "exception":
        peer.order("crash")
    code, errors = peer.finish()
    assert (code, "as ordered" in errors) == ((1, True) if ending == "exception" else (0, False))
    seen = eavesdropper.until(lambda m: m.type == Discovery.BYE and m.process_uuid == process)
    assert any(m.type == Discovery.UNADVERTISE and m.pub.topic == name for m in seen)


def test_a_closed_publisher_disappears_from_lists(node, start_peer):
    peer = start_peer()
    peer.ask("advertise", topic="/chat")
    assert node.topic_list() == ["/chat"]
    peer.ask("close", topic="/chat")
    assert node.topic_list() == []


def test_a_forked_child_publishes_and_its_parent_goes_on(node, start_peer, inbox):
    node.subscribe(StringMsg, "/chat", inbox)
    peer = start_peer()
    peer.ask("advertise", topic="/chat")
    assert peer.ask("wait", topic="/chat")
    assert peer.ask("fork", topic="/chat", text="child") == 0
    assert [message.data for message in inbox.take()] == ["child"]
    peer.ask("publish", topic="/chat", text="parent")
    assert [message.data for message in inbox.take()] == ["parent"]
    code, errors = peer.finish()
    assert (code, errors) == (0, "")


def test_eight_threads_publish_at_once(start_peer):
    listener = start_peer(GZ_TRANSPORT_RCVHWM="0")
    listener.ask("subscribe", topic="/chat")
    speaker = start_peer(GZ_TRANSPORT_SNDHWM="0")
    speaker.ask("advertise", topic="/chat")
    assert speaker.ask("wait", topic="/chat")
    speaker.ask("threads", topic="/chat", threads=8, count=200)
    heard = [tuple(map(int, text.split())) for _, text in listener.heard(1600)]
    for thread in range(8):
        assert [number for each, number in heard if each == thread] == list(range(200))


def test_a_callback_may_use_the_node(node, start_peer, inbox):
    answered = threading.Event()

    def answer(message):
        publisher = node.advertise("/answer", StringMsg)
        node.subscribe(StringMsg, "/more", inbox)
        if publisher.wait_for_subscribers(timeout=120):
            publisher.publish(StringMsg(data=message.data + "!"))
            answered.set()

    node.subscribe(StringMsg, "/chat", answer)
    peer = start_peer()
    peer.ask("subscribe", topic="/answer")
    peer.ask("advertise", topic="/chat")
    peer.ask("advertise", topic="/more")
    assert peer.ask("wait", topic="/chat")
    peer.ask("publish", topic="/chat", text="hello")
    assert peer.heard() == [("/answer", "hello!")]
    assert answered.wait(120)
    assert peer.ask("wait", topic="/more")
    peer.ask("publish", topic="/more", text="again")
    assert [message.data for message in inbox.take()] == ["again"]


def test_the_publisher_is_told_when_a_subscription_ends(node, start_peer, eavesdropper, partition):
    name = fully_qualified(partition, "", "/chat")
    node.advertise("/chat", StringMsg)
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    here = eavesdropper.until(lambda m: m.type == Discovery.NEW_CONNECTION and m.pub.topic == name)[-1]
    assert here.pub.process_uuid == here.process_uuid
    assert here.pub.msg_pub.msg_type == "gz.msgs.StringMsg"
    peer.ask("unsubscribe", topic="/chat")
    end = eavesdropper.until(lambda m: m.type == Discovery.END_CONNECTION and m.pub.topic == name)[-1]
    assert (end.pub.process_uuid, end.pub.node_uuid) == (here.pub.process_uuid, here.pub.node_uuid)
    assert end.pub.msg_pub.ctrl == here.pub.msg_pub.ctrl


def test_an_address_that_is_not_of_this_machine_is_reported_and_replaced(node, start_peer, inbox):
    node.subscribe(StringMsg, "/chat", inbox)
    peer = start_peer(GZ_IP="203.0.113.9")
    peer.ask("advertise", topic="/chat")
    assert peer.ask("wait", topic="/chat")
    peer.ask("publish", topic="/chat", text="hello")
    assert [message.data for message in inbox.take()] == ["hello"]
    code, errors = peer.finish()
    assert code == 0
    assert "GZ_IP" in errors
    assert "203.0.113.9" in errors


def test_what_is_published_right_before_the_end_arrives(node, start_peer, inbox):
    node.subscribe(StringMsg, "/chat", inbox)
    peer = start_peer()
    peer.ask("advertise", topic="/chat")
    assert peer.ask("wait", topic="/chat")
    peer.ask("threads", topic="/chat", threads=1, count=100)
    assert peer.finish() == (0, "")
    assert [message.data for message in inbox.take(100)] == [f"0 {number}" for number in range(100)]


@pytest.fixture
def foreign_publisher(partition, eavesdropper):
    """Return a publisher made of plain sockets, which can also send invalid messages."""
    context = zmq.Context()
    with context.socket(zmq.XPUB) as publisher:
        publisher.setsockopt(zmq.LINGER, 0)
        publisher.setsockopt(zmq.RCVTIMEO, 20000)
        publisher.bind("tcp://127.0.0.1:*")
        yield publisher
    context.destroy(linger=0)


def test_only_well_formed_messages_of_the_exact_topic_and_type_are_delivered(
    node, inbox, partition, eavesdropper, foreign_publisher, capfd
):
    name = fully_qualified(partition, "", "/foo")
    endpoint = foreign_publisher.getsockopt_string(zmq.LAST_ENDPOINT)
    node.subscribe(StringMsg, "/foo", inbox)
    eavesdropper.advertise(name, endpoint, "gz.msgs.StringMsg")
    assert foreign_publisher.recv() == b"\x01" + name.encode()
    topic, address = name.encode(), endpoint.encode()
    data, kind = StringMsg(data="bad").SerializeToString(), b"gz.msgs.StringMsg"
    for frames in (
        [topic + b"bar", address, data, kind],  # ZeroMQ's filter passes longer names
        [topic],
        [topic, address],
        [topic, address, data],
        [topic, address, data, b"gz.msgs.Twist"],
        [topic, address, data, b"\xff\xfe"],
        [topic + b"\xff", address, data, kind],
        [topic, address, b"\xff\xff\xff", kind],
        [topic, address, StringMsg(data="good").SerializeToString(), kind, b"extra frame"],
    ):
        foreign_publisher.send_multipart(frames)
    assert [message.data for message in inbox.take()] == ["good"]
    assert inbox.empty()
    assert capfd.readouterr().err == ""


def test_rubbish_on_the_discovery_port_changes_nothing(node, inbox, partition, eavesdropper, foreign_publisher):
    name = fully_qualified(partition, "", "/foo")
    endpoint = foreign_publisher.getsockopt_string(zmq.LAST_ENDPOINT)
    node.subscribe(StringMsg, "/foo", inbox)
    eavesdropper.send_bytes(b"")
    eavesdropper.send_bytes(b"\x05\x00abc")
    eavesdropper.send_bytes(b"\x03\x00\xff\xff\xff")
    for address in ("", "rubbish", "tcp://nowhere", "inproc://x", "tcp://127.0.0.1:99999999"):
        eavesdropper.advertise(name, address, "gz.msgs.StringMsg")
    eavesdropper.advertise("no such form", endpoint, "gz.msgs.StringMsg")
    eavesdropper.advertise(name, endpoint, "gz.msgs.StringMsg")
    assert foreign_publisher.recv() == b"\x01" + name.encode()
    data = StringMsg(data="good").SerializeToString()
    foreign_publisher.send_multipart([name.encode(), endpoint.encode(), data, b"gz.msgs.StringMsg"])
    assert [message.data for message in inbox.take()] == ["good"]


def test_the_connection_to_a_publisher_that_is_gone_is_given_up_and_made_again(
    node, inbox, partition, eavesdropper, foreign_publisher, monkeypatch
):
    monkeypatch.setattr(inlet, "LEAVE_AFTER_S", 0.0)
    name = fully_qualified(partition, "", "/foo")
    endpoint = foreign_publisher.getsockopt_string(zmq.LAST_ENDPOINT)
    node.subscribe(StringMsg, "/foo", inbox)
    eavesdropper.advertise(name, endpoint, "gz.msgs.StringMsg")
    assert foreign_publisher.recv() == b"\x01" + name.encode()
    eavesdropper.bye()
    assert foreign_publisher.recv() == b"\x00" + name.encode()
    eavesdropper.advertise(name, endpoint, "gz.msgs.StringMsg")
    assert foreign_publisher.recv() == b"\x01" + name.encode()


def test_a_large_message_arrives_whole(node, start_peer):
    publisher = node.advertise("/chat", StringMsg)
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    assert publisher.wait_for_subscribers(timeout=120)
    text = "0123456789" * 100_000
    publisher.publish(StringMsg(data=text))
    assert peer.heard() == [("/chat", text)]
