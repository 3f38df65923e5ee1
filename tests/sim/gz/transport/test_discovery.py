"""One discovery channel with given datagrams and times."""

import contextlib

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import discovery, peers
from gz_course.sim.gz.transport.environment import NetworkSettings
from gz_course.sim.gz.transport.topic_discovery import TopicDiscovery
from gz_course.tests.own_time import OwnTime

OTHER = "11111111-1111-4111-8111-111111111111"
OWN = "22222222-2222-4222-8222-222222222222"
TOPIC = "@/p@/chat"


class Told:
    def __init__(self):
        self.advertised, self.gone, self.sent = [], [], []
        self.subscribers_changed = 0
        self.own = []


@pytest.fixture
def told():
    return Told()


@pytest.fixture
def clock(monkeypatch):
    class Clock:
        now = 1000.0

        def monotonic(self):
            return self.now

    clock = Clock()
    monkeypatch.setattr(discovery, "time", OwnTime(monotonic=clock.monotonic))
    return clock


@pytest.fixture
def channel(clock, told, monkeypatch):
    def changed():
        told.subscribers_changed += 1

    each = TopicDiscovery(
        OWN,
        NetworkSettings(),
        own=lambda topic: [record for record in told.own if topic in (None, record.topic)],
        own_subscriptions=lambda: [],
        own_address="tcp://127.0.0.1:1",
        on_advertise=lambda record, new: told.advertised.append((record.topic, new)),
        on_gone=lambda records: told.gone.extend(record.topic for record in records),
        on_subscribers=changed,
    )
    monkeypatch.setattr(each, "_send", told.sent.append)
    with contextlib.closing(each):
        yield each


def about(kind, topic=TOPIC, process=OTHER, node="n", scope=2, ctrl="", header_process=None):
    message = Discovery(version=10, process_uuid=header_process or process, type=kind)
    message.pub.topic = topic
    message.pub.address = "tcp://127.0.0.1:5"
    message.pub.process_uuid = process
    message.pub.node_uuid = node
    message.pub.scope = scope
    message.pub.msg_pub.msg_type = "gz.msgs.StringMsg"
    message.pub.msg_pub.ctrl = ctrl
    return message


def known(channel):
    return [record.topic for record in channel.all_known()]


def test_an_advertised_topic_is_new_once(channel, told):
    channel.handle(about(Discovery.ADVERTISE), "127.0.0.1")
    channel.handle(about(Discovery.ADVERTISE), "127.0.0.1")
    assert told.advertised == [(TOPIC, True), (TOPIC, False)]
    assert known(channel) == [TOPIC]


def test_unadvertise_forgets_only_that_node(channel, told):
    channel.handle(about(Discovery.ADVERTISE, node="a"), "127.0.0.1")
    channel.handle(about(Discovery.ADVERTISE, node="b"), "127.0.0.1")
    channel.handle(about(Discovery.UNADVERTISE, node="a"), "127.0.0.1")
    assert [record.node_uuid for record in channel.known(TOPIC)] == ["b"]


def test_bye_forgets_the_whole_process(channel, told):
    for topic in (TOPIC, "@/p@/other"):
        channel.handle(about(Discovery.ADVERTISE, topic), "127.0.0.1")
    channel.handle(about(Discovery.NEW_CONNECTION, ctrl=OWN), "127.0.0.1")
    channel.handle(Discovery(version=10, process_uuid=OTHER, type=Discovery.BYE), "127.0.0.1")
    assert known(channel) == []
    assert sorted(told.gone) == [TOPIC, "@/p@/other"]
    assert channel.subscriber_processes(TOPIC, "gz.msgs.StringMsg") == 0


def hear(channel, monkeypatch, message):
    """Let the channel read one datagram from its socket."""
    from gz_course.sim.gz.transport import datagram

    waiting = [datagram.encode(message)]

    class Socket:
        def recvfrom(self, size):
            if not waiting:
                raise BlockingIOError
            return waiting.pop(), ("127.0.0.1", 1)

        def close(self):
            pass

    with monkeypatch.context() as patch:
        patch.setattr(channel, "_socket", Socket())
        channel.receive()


def test_a_process_that_is_silent_for_three_seconds_is_gone(channel, told, clock, monkeypatch):
    hear(channel, monkeypatch, about(Discovery.ADVERTISE))
    clock.now += 2.9
    channel.tick()
    assert known(channel) == [TOPIC]
    hear(channel, monkeypatch, Discovery(version=10, process_uuid=OTHER, type=Discovery.HEARTBEAT))
    clock.now += 2.9
    channel.tick()
    assert known(channel) == [TOPIC]
    clock.now += 0.2
    channel.tick()
    assert known(channel) == []
    assert told.gone == [TOPIC]


def test_what_we_say_ourselves_and_what_relays_say_is_ignored(channel, monkeypatch):
    hear(channel, monkeypatch, about(Discovery.ADVERTISE, process=OWN))
    relayed = about(Discovery.ADVERTISE)
    relayed.flags.relay = True
    hear(channel, monkeypatch, relayed)
    assert known(channel) == []


def test_a_heartbeat_a_second_with_all_our_topics(channel, told, clock):
    told.own = [about(Discovery.ADVERTISE, process=OWN).pub]
    for _ in range(50):
        channel.tick()
        clock.now += 0.1
    kinds = [message.type for message in told.sent]
    assert kinds == [Discovery.HEARTBEAT, Discovery.ADVERTISE] * 5


def test_a_question_for_our_topic_is_answered(channel, told):
    told.own = [about(Discovery.ADVERTISE, process=OWN).pub]
    for topic in ("@/p@/chatter", TOPIC):
        question = Discovery(version=10, process_uuid=OTHER, type=Discovery.SUBSCRIBE)
        question.sub.topic = topic
        channel.handle(question, "127.0.0.1")
    assert [(message.type, message.pub.topic) for message in told.sent] == [(Discovery.ADVERTISE, TOPIC)]


@pytest.mark.parametrize(
    ("scope", "source", "accepted"),
    [(2, "10.1.1.1", True), (1, "10.1.1.1", False), (1, "127.0.0.1", True), (0, "127.0.0.1", False)],
)
def test_scopes(channel, scope, source, accepted):
    channel.handle(about(Discovery.ADVERTISE, scope=scope), source)
    assert known(channel) == ([TOPIC] if accepted else [])


def test_nobody_speaks_for_another_process(channel):
    channel.handle(about(Discovery.ADVERTISE), "127.0.0.1")
    stranger = "33333333-3333-4333-8333-333333333333"
    channel.handle(about(Discovery.UNADVERTISE, header_process=stranger), "127.0.0.1")
    assert known(channel) == [TOPIC]


def test_connections_are_counted_for_the_process_they_name(channel, told):
    told.own = [about(Discovery.ADVERTISE, process=OWN).pub]
    channel.handle(about(Discovery.NEW_CONNECTION, ctrl="another process"), "127.0.0.1")
    assert channel.subscriber_processes(TOPIC, "gz.msgs.StringMsg") == 0
    channel.handle(about(Discovery.NEW_CONNECTION, ctrl=OWN, node="a"), "127.0.0.1")
    channel.handle(about(Discovery.NEW_CONNECTION, ctrl=OWN, node="b"), "127.0.0.1")
    assert channel.subscriber_processes(TOPIC, "gz.msgs.StringMsg") == 1
    assert channel.subscriber_processes(TOPIC, "gz.msgs.Twist") == 0
    channel.handle(about(Discovery.END_CONNECTION, ctrl=OWN, node="a"), "127.0.0.1")
    assert channel.subscriber_processes(TOPIC, "gz.msgs.StringMsg") == 1
    channel.handle(about(Discovery.END_CONNECTION, ctrl="", node="b"), "127.0.0.1")
    assert channel.subscriber_processes(TOPIC, "gz.msgs.StringMsg") == 0
    assert told.subscribers_changed == 4


def test_invented_processes_do_not_displace_real_ones(channel, clock, monkeypatch):
    monkeypatch.setattr(peers, "MOST_PROCESSES", 20)
    hear(channel, monkeypatch, about(Discovery.ADVERTISE))
    clock.now += 1.0
    hear(channel, monkeypatch, about(Discovery.ADVERTISE))
    for number in range(100):
        hear(channel, monkeypatch, about(Discovery.ADVERTISE, f"@/p@/{number}", process=f"invented {number}"))
    assert TOPIC in known(channel)
    assert len(known(channel)) == 20
    hear(channel, monkeypatch, about(Discovery.ADVERTISE, "@/p@/late", process="a real one that comes late"))
    assert {TOPIC, "@/p@/late"} <= set(known(channel))
    clock.now += 3.1
    channel.tick()
    assert known(channel) == []
    assert len(channel._peers) == len(channel._topics_of) == len(channel._addresses) == 0


def test_long_invented_names_do_not_fill_the_memory(channel, told, monkeypatch):
    monkeypatch.setattr(peers, "MOST_BYTES", 500_000)
    monkeypatch.setattr(peers, "MOST_BYTES_OF_ONE", 200_000)
    long = "@/p@/" + 60_000 * "x"
    for number in range(30):
        hear(channel, monkeypatch, about(Discovery.ADVERTISE, f"{long}{number}", process=f"invented {number}"))
        hear(channel, monkeypatch, about(Discovery.ADVERTISE, f"{long}{number}", process="one of many words"))
        hear(channel, monkeypatch, about(Discovery.NEW_CONNECTION, f"{long}{number}", ctrl=OWN))
        hear(channel, monkeypatch, Discovery(version=10, process_uuid=f"{long}{number}", type=Discovery.HEARTBEAT))
    assert sum(len(topic) for topic in known(channel)) <= 500_000
    assert sum(record.process_uuid == "one of many words" for record in channel.all_known()) <= 3
    assert channel.subscribers() == []
    assert all(len(process) < 100 for process in channel._peers._new)


def test_many_publishers_of_one_topic_displace_the_silent_ones(channel, monkeypatch):
    monkeypatch.setattr(discovery, "_MOST_OF_ONE_TOPIC", 5)
    for number in range(10):
        hear(channel, monkeypatch, about(Discovery.ADVERTISE, process=f"invented {number}"))
        hear(channel, monkeypatch, about(Discovery.ADVERTISE))
    assert OTHER in {record.process_uuid for record in channel.known(TOPIC)}
    assert len(channel.known(TOPIC)) == 5


def test_an_address_is_known_until_its_last_publisher_has_gone(channel):
    channel.handle(about(Discovery.ADVERTISE), "127.0.0.1")
    channel.handle(about(Discovery.ADVERTISE, process="a thief of the address"), "127.0.0.1")
    channel.handle(Discovery(version=10, process_uuid="a thief of the address", type=Discovery.BYE), "127.0.0.1")
    assert channel.is_known_address("tcp://127.0.0.1:5")
    channel.handle(about(Discovery.UNADVERTISE), "127.0.0.1")
    assert not channel.is_known_address("tcp://127.0.0.1:5")


fields = st.text(max_size=20)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200)
@given(
    st.integers(-(2**31), 2**31 - 1),
    fields,
    st.sampled_from([TOPIC, "@@/x"]) | fields,
    fields,
    st.integers(-5, 5),
    fields,
)
def test_no_message_whatever_is_in_it_is_an_error(channel, kind, process, topic, node, scope, ctrl):
    channel.handle(about(kind, topic, process, node, scope, ctrl), "127.0.0.1")
    channel.handle(Discovery(version=10, process_uuid=process, type=kind), "127.0.0.1")
    assert all(topic.startswith("@") for topic in known(channel))
    channel.subscribers()
