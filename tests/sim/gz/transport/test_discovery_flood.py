"""A flood of invented processes and names, over a real port that only this test uses."""

import socket
import uuid

import psutil
import pytest

from gz_course.sim.gz.msgs.discovery_pb2 import Discovery
from gz_course.sim.gz.transport import datagram

PORTS = {"GZ_DISCOVERY_MSG_PORT": "21317", "GZ_DISCOVERY_SRV_PORT": "21318"}
AT_ONCE = 200
MOST_GROWTH_BYTES = 30_000_000
pytestmark = pytest.mark.proof  # tens of thousands of datagrams


@pytest.fixture
def flood():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp:
        udp.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))

        def send(topic):
            process = str(uuid.uuid4())
            message = Discovery(version=10, process_uuid=process, type=Discovery.ADVERTISE)
            message.pub.topic, message.pub.address = topic, "tcp://127.0.0.1:9"
            message.pub.process_uuid, message.pub.node_uuid, message.pub.scope = process, str(uuid.uuid4()), 2
            message.pub.msg_pub.msg_type = "gz.msgs.StringMsg"
            udp.sendto(datagram.encode(message), ("239.255.0.7", int(PORTS["GZ_DISCOVERY_MSG_PORT"])))

        yield send


def resident(peer):
    return psutil.Process(peer.process.pid).memory_info().rss


def test_a_topic_stays_audible_after_thirty_thousand_invented_processes(start_peer, flood):
    listener = start_peer(**PORTS)
    listener.ask("subscribe", topic="/chat")
    for number in range(30_000):
        flood(f"@/flood@/invented{number}")
        if number % AT_ONCE == 0:
            listener.ask("unsubscribe", topic="/nothing")  # gives it the processor
    talker = start_peer(**PORTS)
    talker.ask("advertise", topic="/chat")
    assert talker.ask("wait", topic="/chat")
    talker.ask("publish", topic="/chat", text="heard")
    assert listener.heard() == [("/chat", "heard")]


def test_six_thousand_long_names_leave_the_memory_as_it_was(start_peer, flood):
    listener = start_peer(**PORTS)
    listener.ask("subscribe", topic="/chat")
    before = resident(listener)
    for number in range(6000):
        flood(f"@/flood@/{number}" + 60_000 * "x")
        if number % AT_ONCE == 0:
            listener.ask("unsubscribe", topic="/nothing")
    assert resident(listener) - before < MOST_GROWTH_BYTES
