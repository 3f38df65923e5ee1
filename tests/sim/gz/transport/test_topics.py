"""Topics within one process: synchronous delivery, copies, types, options, errors. See also test_local_delivery.py."""

import threading

import pytest

from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.transport import AdvertiseMessageOptions, Node, NodeOptions, Scope, SubscribeOptions
from gz_course.sim.gz.transport import throttle as throttle_module
from gz_course.sim.gz.transport.options import UNTHROTTLED
from gz_course.tests.own_time import OwnTime


@pytest.fixture(params=[Scope.PROCESS, Scope.ALL], ids=["process", "all"])
def node(request):
    with Node(NodeOptions(scope=request.param, synchronous=True)) as each:
        yield each


def test_a_message_has_arrived_when_publish_returns(node):
    heard = []
    node.subscribe(StringMsg, "/chat", lambda message: heard.append((message.data, threading.get_ident())))
    publisher = node.advertise("/chat", StringMsg, AdvertiseMessageOptions())
    for number in range(3):
        assert publisher.publish(StringMsg(data=str(number))) is True
        assert heard[-1] == (str(number), threading.get_ident())
    assert len(heard) == 3


def test_everybody_gets_a_copy_of_his_own(node):
    first, second = [], []
    node.subscribe(StringMsg, "/chat", first.append)
    node.subscribe(StringMsg, "/chat", second.append)
    message = StringMsg(data="original")
    node.advertise("/chat", StringMsg).publish(message)
    first[0].data = "spoilt"
    assert (message.data, second[0].data) == ("original", "original")


def test_nodes_of_one_process_hear_one_another_whatever_their_scope(node):
    heard = []
    for scope in (Scope.PROCESS, Scope.ALL):
        with Node(NodeOptions(scope=scope, synchronous=True)) as other:
            other.subscribe(StringMsg, "/chat", heard.append)
            node.advertise(f"/chat{int(scope)}", StringMsg)
            publisher = other.advertise("/back", StringMsg)
            node.subscribe(StringMsg, "/back", heard.append)
            publisher.publish(StringMsg(data="back"))
            node.unsubscribe("/back")
    assert len(heard) == 2


def test_another_type_is_not_delivered_but_raw_subscriptions_take_all(node, partition):
    typed, raw = [], []
    node.subscribe(Twist, "/chat", typed.append)
    node.subscribe_raw("/chat", lambda data, info: raw.append((data, info)))
    node.subscribe_raw("/chat", lambda data, info: typed.append(data), "gz.msgs.Twist")
    message = StringMsg(data="x")
    node.advertise("/chat", StringMsg).publish(message)
    assert typed == []
    ((data, info),) = raw
    assert data == message.SerializeToString()
    assert (info.topic, info.type, info.partition, info.intra_process) == (
        "/chat",
        "gz.msgs.StringMsg",
        partition,
        True,
    )


def test_publishing_another_type_than_advertised_says_so(node, capsys):
    heard = []
    publisher = node.advertise("/chat", StringMsg)
    node.subscribe_raw("/chat", lambda *arguments: heard.append(arguments))
    assert publisher.publish(Twist()) is False
    assert heard == []
    error = capsys.readouterr().err
    assert "gz.msgs.StringMsg" in error
    assert "gz.msgs.Twist" in error
    with pytest.raises(TypeError, match=r"gz\.msgs\.StringMsg message was expected"):
        publisher.publish("text")


def test_raw_bytes_that_are_no_message_reach_only_raw_subscriptions(node):
    typed, raw = [], []
    node.subscribe(StringMsg, "/chat", typed.append)
    node.subscribe_raw("/chat", lambda data, info: raw.append(data), "gz.msgs.StringMsg")
    assert node.advertise("/chat", "gz.msgs.StringMsg").publish_raw(b"\xff\xff", "gz.msgs.StringMsg")
    assert (typed, raw) == ([], [b"\xff\xff"])


def test_an_exception_in_a_callback_is_one_line_and_stops_nobody(node, capsys):
    heard = []

    def fail(message):
        raise KeyError("two\nlines")

    node.subscribe(StringMsg, "/chat", fail)
    node.subscribe(StringMsg, "/chat", heard.append)
    assert node.advertise("/chat", StringMsg).publish(StringMsg())
    assert len(heard) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "[/chat]" in line
    assert "KeyError" in line
    assert f"{__file__}:{fail.__code__.co_firstlineno + 1}" in line


def test_a_callback_may_subscribe_and_publish(node):
    heard = []
    answers = node.advertise("/answer", StringMsg)

    def answer(message):
        node.subscribe(StringMsg, "/answer", lambda message: heard.append(message.data))
        answers.publish(StringMsg(data=message.data + "!"))
        node.unsubscribe("/chat")

    node.subscribe(StringMsg, "/chat", answer)
    publisher = node.advertise("/chat", StringMsg)
    publisher.publish(StringMsg(data="a"))
    publisher.publish(StringMsg(data="b"))
    assert heard == ["a!"]


def test_a_subscription_that_ends_during_delivery_is_not_called(node):
    heard = []
    node.subscribe(StringMsg, "/chat", lambda message: node.unsubscribe("/chat"))
    node.subscribe(StringMsg, "/chat", heard.append)
    node.advertise("/chat", StringMsg).publish(StringMsg())
    assert heard == []


def test_a_node_can_ignore_itself(node):
    heard = []
    node.subscribe(StringMsg, "/chat", heard.append, SubscribeOptions(ignore_local_messages=True))
    node.advertise("/chat", StringMsg).publish(StringMsg(data="own"))
    with Node(NodeOptions(scope=Scope.PROCESS)) as other:
        other.advertise("/chat", StringMsg).publish(StringMsg(data="other"))
    assert [message.data for message in heard] == ["other"]


@pytest.mark.parametrize("side", ["publisher", "subscriber"])
def test_a_rate_limit_drops_what_is_too_much(node, side, monkeypatch):
    class Clock:
        now = 10**12

        def monotonic_ns(self):
            return self.now

    clock = Clock()
    monkeypatch.setattr(throttle_module, "time", OwnTime(monotonic_ns=clock.monotonic_ns))
    heard = []
    limit, free = 10, UNTHROTTLED
    rates = (limit, free) if side == "publisher" else (free, limit)
    publisher = node.advertise("/chat", StringMsg, AdvertiseMessageOptions(msgs_per_sec=rates[0]))
    options = SubscribeOptions(msgs_per_sec=rates[1])
    node.subscribe(StringMsg, "/chat", lambda message: heard.append(int(message.data)), options)
    for millisecond in range(300):
        assert publisher.publish(StringMsg(data=str(millisecond)))
        clock.now += 10**6
        if side == "publisher":
            assert publisher.throttled_update_ready() == (millisecond % 100 == 99)
    assert heard == [0, 100, 200]


@pytest.mark.parametrize("rate", [0, -1, 1.5, True, 2**64])
def test_an_impossible_rate_is_refused(rate):
    with pytest.raises(ValueError, match="msgs_per_sec"):
        SubscribeOptions(msgs_per_sec=rate)


def test_a_node_advertises_a_topic_once(node, capsys):
    publisher = node.advertise("/chat", StringMsg)
    second = node.advertise("/chat", Twist)
    assert "already advertised" in capsys.readouterr().err
    assert (second.valid(), second.publish(Twist()), second.has_connections()) == (False, False, False)
    second.close()
    assert publisher.valid()
    publisher.close()
    assert not publisher.valid()
    assert publisher.publish(StringMsg()) is False
    assert node.advertise("/chat", Twist).valid()


def test_names_that_break_a_rule_are_refused_in_a_line(node, capsys):
    assert not node.advertise("/my chat", StringMsg).valid()
    assert "a space" in capsys.readouterr().err
    assert node.subscribe(StringMsg, "//chat", print) is False
    assert "'//'" in capsys.readouterr().err
    assert node.unsubscribe("/a b") is False
    assert node.topic_info("/a b") == ([], [])
    assert node.service_info("/a b") == []
    assert node.request("/a b", StringMsg(), StringMsg, StringMsg, 10) == (False, StringMsg())
    assert len(capsys.readouterr().err.splitlines()) == 4
    assert node.request("/chat", Twist(), StringMsg, StringMsg, 10) == (False, StringMsg())
    assert "is a gz.msgs.Twist" in capsys.readouterr().err
    with pytest.raises(ValueError, match="partition name 'a@b'"):
        NodeOptions(partition="a@b")
    assert (node.advertised_topics(), node.subscribed_topics()) == ([], [])


def test_swapped_arguments_are_explained(node):
    with pytest.raises(TypeError, match="message class first and the topic second"):
        node.subscribe("/chat", StringMsg, print)
    with pytest.raises(TypeError, match="cannot be called"):
        node.subscribe(StringMsg, "/chat", "callback")
    with pytest.raises(TypeError, match="message class"):
        node.advertise("/chat", 5)


def test_namespaces_and_remappings(node):
    heard = []
    options = NodeOptions(namespace="robot1", scope=Scope.PROCESS)
    assert options.add_topic_remap("cmd", "drive")
    assert not options.add_topic_remap("cmd", "again")
    with Node(options) as robot:
        robot.subscribe(StringMsg, "cmd", heard.append)
        assert robot.subscribed_topics() == ["/robot1/drive"]
        node.advertise("/robot1/drive", StringMsg).publish(StringMsg())
    assert len(heard) == 1


def test_lists_and_closing(node):
    publisher = node.advertise("/b", StringMsg)
    node.subscribe(StringMsg, "/a", print)
    assert (node.advertised_topics(), node.subscribed_topics()) == (["/b"], ["/a"])
    assert node.topic_list() == ["/b", "/a"]
    assert not publisher.has_connections()
    node.close()
    node.close()
    assert (node.advertised_topics(), node.subscribed_topics(), publisher.valid()) == ([], [], False)
    with pytest.raises(RuntimeError, match="closed"):
        node.advertise("/c", StringMsg)


def test_waiting_for_a_subscriber_of_this_process(node):
    publisher = node.advertise("/chat", StringMsg)
    assert not publisher.wait_for_subscribers(timeout=0.01)
    subscriber = threading.Thread(target=lambda: node.subscribe(StringMsg, "/chat", print))
    subscriber.start()
    assert publisher.wait_for_subscribers(timeout=120)
    subscriber.join()


def test_eight_threads_publish_and_none_is_lost(node):
    heard, lock = [], threading.Lock()

    def keep(message):
        with lock:
            heard.append(message.data)

    node.subscribe(StringMsg, "/chat", keep)
    publisher = node.advertise("/chat", StringMsg)

    def work(thread):
        for number in range(200):
            publisher.publish(StringMsg(data=f"{thread} {number}"))

    threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sorted(heard) == sorted(f"{thread} {number}" for thread in range(8) for number in range(200))
