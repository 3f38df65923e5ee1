"""A node with scope PROCESS: no socket, no thread, no external messages."""

import subprocess
import sys

from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import AdvertiseMessageOptions, Node, NodeOptions, Scope

SCRIPT = """
import os, sys, threading
from gz.transport import Node, NodeOptions, Scope
from gz.msgs.stringmsg_pb2 import StringMsg

def sockets():
    found = []
    for entry in os.listdir("/proc/self/fd"):
        try:
            found.append(os.readlink("/proc/self/fd/" + entry))
        except FileNotFoundError:
            pass  # the descriptor of the listing itself
    return [each for each in found if each.startswith("socket:") or "eventfd" in each or "eventpoll" in each]

before = sockets()
heard = []
with Node(NodeOptions(scope=Scope.PROCESS)) as node:
    node.subscribe(StringMsg, "/chat", heard.append)
    publisher = node.advertise("/chat", StringMsg)
    assert publisher.wait_for_subscribers() and publisher.has_connections()
    assert publisher.publish(StringMsg(data="x"))
    assert node.topic_list() == ["/chat"] and len(node.topic_info("/chat")[0]) == 1
    node.unsubscribe("/chat")
    assert sockets() == before, sockets()
    assert threading.active_count() == 1
assert len(heard) == 1
assert sockets() == before and "zmq" not in sys.modules and "mujoco" not in sys.modules
if "ALL" in sys.argv:
    Node().advertise("/chat", StringMsg)
    assert sockets() != before and threading.active_count() == 3
"""


def test_it_opens_no_socket_and_starts_no_thread():
    subprocess.run([sys.executable, "-c", SCRIPT], check=True, timeout=600)


def test_the_check_above_would_see_a_socket():
    subprocess.run([sys.executable, "-c", SCRIPT, "ALL"], check=True, timeout=600)


def test_it_hears_nothing_from_outside(start_peer, inbox, new_inbox):
    private = new_inbox()
    with Node() as public, Node(NodeOptions(scope=Scope.PROCESS)) as hidden:
        hidden.subscribe(StringMsg, "/chat", private)
        public.subscribe(StringMsg, "/chat", inbox)
        peer = start_peer()
        peer.ask("advertise", topic="/chat")
        assert peer.ask("wait", topic="/chat")
        for text in ("one", "two"):
            peer.ask("publish", topic="/chat", text=text)
        assert [message.data for message in inbox.take(2)] == ["one", "two"]
        assert private.empty()
        with Node() as speaker:
            speaker.advertise("/chat", StringMsg).publish(StringMsg(data="from this process"))
        assert [message.data for message in private.take()] == ["from this process"]


def test_nobody_outside_hears_it(start_peer):
    peer = start_peer()
    peer.ask("subscribe", topic="/chat")
    with Node() as public, Node(NodeOptions(scope=Scope.PROCESS)) as hidden, Node() as third:
        limited = third.advertise("/chat", StringMsg, AdvertiseMessageOptions(scope=Scope.PROCESS))
        secret = hidden.advertise("/chat", StringMsg)
        publisher = public.advertise("/chat", StringMsg)
        assert publisher.wait_for_subscribers(timeout=120)
        assert not secret.has_connections()
        assert not limited.has_connections()
        secret.publish(StringMsg(data="secret"))
        limited.publish(StringMsg(data="secret too"))
        publisher.publish(StringMsg(data="public"))
        assert peer.heard() == [("/chat", "public")]


def test_nobody_outside_learns_of_it(start_peer, eavesdropper, partition):
    from gz_course.sim.gz.transport.naming import fully_qualified

    with Node() as public, Node(NodeOptions(scope=Scope.PROCESS)) as hidden:
        hidden.advertise("/secret", StringMsg)
        public.advertise("/public", StringMsg)
        names = {fully_qualified(partition, "", topic) for topic in ("/secret", "/public")}
        eavesdropper.until(lambda message: message.pub.topic in names)
        # the next one is repeated with the heartbeat, together with all other public records
        seen = eavesdropper.until(lambda message: message.pub.topic in names)
        assert {message.pub.topic for message in seen} & names == {fully_qualified(partition, "", "/public")}
