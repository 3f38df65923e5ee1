"""Arbitrary data sent to a real process: it continues, prints nothing and does not grow."""

import contextlib
import random
import socket
import uuid

import psutil
import pytest
import zmq

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node, datagram
from gz_course.sim.gz.transport.naming import fully_qualified

BATCH = 100
MOST_GROWTH_BYTES = 40_000_000
PORTS = (10317, 10318)
KINDS = list(Discovery.Type.values())


class Attacker:
    """Knows the addresses of a process and sends arbitrary data to it."""

    def __init__(self, peer, node, partition):
        self.peer, self.node, self.sent = peer, node, 0
        self.name = fully_qualified(partition, "", "/chat")
        self.context = zmq.Context()
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        self.process = str(uuid.uuid4())
        self.publisher = self.context.socket(zmq.PUB)
        self.publisher.bind("tcp://127.0.0.1:*")
        self.address = self.publisher.getsockopt_string(zmq.LAST_ENDPOINT)
        (provider,) = node.service_info("/echo")
        (talker,), _ = node.topic_info("/talk")
        self.replier, self.outlet = provider.addr, talker.addr
        self.known = [self.name, self.address, self.process, provider.socket_id, "gz.msgs.StringMsg"]
        self.dealer = self.context.socket(zmq.DEALER)
        self.dealer.connect(self.replier)
        self.subscriber = self.context.socket(zmq.XSUB)
        self.subscriber.connect(self.outlet)
        for each in (self.dealer, self.subscriber):
            each.setsockopt(zmq.LINGER, 0)

    def discovery(self, source):
        """Return a datagram: random bytes, or a valid or damaged message of the protocol."""
        if source.random() < 0.3:
            return source.randbytes(int(source.paretovariate(0.7)) % 65000)
        message = Discovery(version=source.choice([10, 10, 10, 9, 110, 0]), process_uuid=self.text(source))
        message.type = source.choice([*KINDS, 77])
        if source.random() < 0.2:
            message.sub.topic = self.text(source)
        elif source.random() < 0.9:
            message.pub.topic = self.text(source)
            message.pub.address = self.text(source)
            message.pub.process_uuid = source.choice([message.process_uuid, self.text(source)])
            message.pub.node_uuid = self.text(source)
            message.pub.scope = source.choice([0, 1, 2, 9])
            if source.random() < 0.5:
                message.pub.msg_pub.msg_type = self.text(source)
                message.pub.msg_pub.ctrl = self.text(source)
            else:
                message.pub.srv_pub.socket_id = self.text(source)
                message.pub.srv_pub.request_type = self.text(source)
                message.pub.srv_pub.response_type = self.text(source)
        return self.damaged(source, datagram.encode(message))

    def text(self, source):
        if source.random() < 0.6:
            return source.choice(self.known)
        return "".join(source.choices("@/~: :=aé\x00\n😀tcp127.0", k=source.randrange(60)))

    def damaged(self, source, data):
        damage = source.random()
        if damage < 0.6 or not data:
            return data
        at = source.randrange(len(data))
        if damage < 0.8:
            return data[:at]
        return data[:at] + source.randbytes(source.randrange(1, 9)) + data[at + 1 :]

    def frames(self, source):
        parts = [self.text(source).encode(), source.randbytes(source.randrange(40)), b"", b"gz.msgs.StringMsg"]
        return [self.damaged(source, source.choice(parts)) for _ in range(source.choice([1, 2, 4, 5, 6, 8, 8, 9, 12]))]

    def raw_connection(self, source):
        host, port = self.replier.removeprefix("tcp://").rsplit(":", 1)
        with contextlib.suppress(OSError), socket.create_connection((host, int(port)), timeout=5) as connection:
            connection.sendall(self.damaged(source, b"\xff" + bytes(8) + b"\x7f\x03" + source.randbytes(80)))

    def attack(self, seed):
        source = random.Random(seed)
        for _ in range(BATCH):
            self.sent += 1
            way = source.random()
            if way < 0.7:
                self.udp.sendto(self.discovery(source), ("239.255.0.7", source.choice(PORTS)))
            elif way < 0.8:
                self.dealer.send_multipart(self.frames(source))
            elif way < 0.9:
                self.publisher.send_multipart([self.name.encode(), *self.frames(source)])
            elif way < 0.99:
                self.subscriber.send(source.randbytes(1) + self.text(source).encode())
            else:
                self.raw_connection(source)

    def close(self):
        self.udp.close()
        self.context.destroy(linger=0)


def is_alive_and_well(node, talker, peer):
    """Return whether communication through every attacked socket still works."""
    done, response = node.request("/echo", StringMsg(data="ping"), StringMsg, StringMsg, 20_000)
    assert (done, response.data) == (True, "PING")
    talker.publish(StringMsg(data="ping"))
    while peer.heard() != [("/control", "ping")]:  # the effect of a random message on /chat
        pass


@pytest.fixture
def under_attack(start_peer, partition):
    peer = start_peer()
    peer.ask("advertise", topic="/talk")
    peer.ask("serve", service="/echo", answer="upper")
    for topic in ("/chat", "/control"):
        peer.ask("subscribe", topic=topic)
    with Node() as node:
        talker = node.advertise("/control", StringMsg)
        assert talker.wait_for_subscribers(timeout=120)
        with contextlib.closing(Attacker(peer, node, partition)) as attacker:
            yield peer, node, talker, attacker
    code, errors = peer.finish()
    assert code == 0
    assert [line for line in errors.splitlines() if "has an address that cannot be used" not in line] == []


def advertise_the_rogue(attacker):
    """Make the process connect to the attacker's publisher."""
    message = Discovery(version=10, process_uuid=attacker.process, type=Discovery.ADVERTISE)
    message.pub.topic, message.pub.address = attacker.name, attacker.address
    message.pub.process_uuid, message.pub.node_uuid, message.pub.scope = attacker.process, str(uuid.uuid4()), 2
    message.pub.msg_pub.msg_type = "gz.msgs.StringMsg"
    attacker.udp.sendto(datagram.encode(message), ("239.255.0.7", PORTS[0]))


def bombard(under_attack, batches):
    peer, node, talker, attacker = under_attack
    memory, before = psutil.Process(peer.process.pid), 0
    advertise_the_rogue(attacker)
    for seed in range(batches):
        attacker.attack(seed)
        is_alive_and_well(node, talker, peer)
        before = before or memory.memory_info().rss
    assert attacker.sent >= batches * BATCH
    assert memory.memory_info().rss - before < MOST_GROWTH_BYTES


def test_thousands_of_hostile_messages(under_attack):
    bombard(under_attack, 100)


@pytest.mark.proof
def test_a_hundred_thousand_hostile_messages(under_attack):
    bombard(under_attack, 1000)


def test_datagrams_that_were_taken_are_followed_by_silence(start_peer, eavesdropper):
    """A process that only sends invalid data is not remembered."""
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    for size in (0, 1, 2, 3, 100, 65507):
        eavesdropper.send_bytes(bytes(size))
    peer.ask("advertise", topic="/talk")
    assert eavesdropper.until(lambda message: message.pub.topic.endswith("@/talk"))
    assert peer.finish() == (0, "")
