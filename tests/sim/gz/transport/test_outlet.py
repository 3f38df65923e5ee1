"""The sending socket alone, with subscribers made of plain sockets."""

import socket
import time

import pytest
import zmq

from gz_course.sim.gz.transport.outlet import Outlet

TOPIC = b"@/p@/chat"


@pytest.fixture
def context():
    context = zmq.Context()
    yield context
    context.destroy(linger=0)


class Changes:
    count = 0

    def __call__(self):
        self.count += 1


@pytest.fixture
def changes():
    return Changes()


@pytest.fixture
def outlet(context, changes):
    each = Outlet(context, "127.0.0.1", 0, changes)
    yield each
    each.close()


@pytest.fixture
def subscribe(context, outlet):
    def make(name=TOPIC):
        socket = context.socket(zmq.SUB)
        socket.setsockopt(zmq.RCVTIMEO, 20000)
        socket.setsockopt(zmq.SUBSCRIBE, name)
        socket.connect(outlet.address)
        return socket

    return make


def until(condition, outlet):
    """Do the work of the I/O thread until the condition holds."""
    poller = zmq.Poller()
    poller.register(outlet.fileno(), zmq.POLLIN)
    deadline = time.monotonic() + 120
    while not condition():
        assert time.monotonic() < deadline
        poller.poll(50)  # ZeroMQ closes a connection a little after its notice
        outlet.take_notices()


def test_listeners_are_counted_as_they_come_and_go(outlet, subscribe, changes):
    assert outlet.listeners(TOPIC) == 0
    first = subscribe()
    until(lambda: outlet.listeners(TOPIC) == 1, outlet)
    second, other = subscribe(), subscribe(b"@/p@/chatter")
    until(lambda: outlet.listeners(TOPIC) == 2 and outlet.listeners(b"@/p@/chatter") == 1, outlet)
    first.close()
    until(lambda: outlet.listeners(TOPIC) == 1, outlet)
    second.setsockopt(zmq.UNSUBSCRIBE, TOPIC)
    until(lambda: outlet.listeners(TOPIC) == 0, outlet)
    assert outlet.listeners(b"@/p@/chatter") == 1
    assert changes.count >= 4
    second.close()
    other.close()


def test_the_four_frames_of_a_message(outlet, subscribe):
    with subscribe() as socket:
        until(lambda: outlet.listeners(TOPIC) == 1, outlet)
        outlet.send(TOPIC, b"data", b"gz.msgs.StringMsg")
        assert socket.recv_multipart() == [TOPIC, outlet.address.encode(), b"data", b"gz.msgs.StringMsg"]


def test_a_busy_publisher_notices_new_listeners_by_itself(outlet, subscribe, changes):
    """Sending consumes the signal for which the I/O thread waits, so it must also do the work of that thread."""
    with subscribe() as first:
        until(lambda: outlet.listeners(TOPIC) == 1, outlet)
        before = changes.count
        with subscribe() as second:
            deadline = time.monotonic() + 120
            while outlet.listeners(TOPIC) < 2:
                assert time.monotonic() < deadline
                outlet.send(TOPIC, b"data", b"gz.msgs.StringMsg")
            assert changes.count == before + 1
            outlet.send(TOPIC, b"last", b"gz.msgs.StringMsg")
            assert second.recv_multipart()[2] in (b"data", b"last")
            assert first.recv_multipart()[2] == b"data"


def test_after_closing_nothing_is_sent(outlet, subscribe):
    with subscribe():
        until(lambda: outlet.listeners(TOPIC) == 1, outlet)
        outlet.close()
        outlet.send(TOPIC, b"data", b"gz.msgs.StringMsg")
        outlet.take_notices()


def test_nobody_ends_the_subscription_of_another(outlet, subscribe):
    """A peer that ends what it never began, again and again, silences nobody."""
    with subscribe() as legitimate:
        until(lambda: outlet.listeners(TOPIC) == 1, outlet)
        with zmtp_peer(outlet.address) as raw:
            for _ in range(3):
                raw.sendall(frame(b"\x00" + TOPIC))
            raw.sendall(frame(b"\x01@/p@/after"))
            until(lambda: outlet.listeners(b"@/p@/after") == 1, outlet)
            assert outlet.listeners(TOPIC) == 1
            for _ in range(2):
                raw.sendall(frame(b"\x01" + TOPIC))
            until(lambda: outlet.listeners(TOPIC) == 2, outlet)
            raw.sendall(frame(b"\x00" + TOPIC) * 5 + frame(b"\x01@/p@/end"))
            until(lambda: outlet.listeners(b"@/p@/end") == 1, outlet)
            assert outlet.listeners(TOPIC) == 1
            raw.sendall(frame(b"\x01" + TOPIC))
            until(lambda: outlet.listeners(TOPIC) == 2, outlet)
        until(lambda: outlet.listeners(TOPIC) == 1 and outlet.listeners(b"@/p@/end") == 0, outlet)
        outlet.send(TOPIC, b"data", b"gz.msgs.StringMsg")
        assert legitimate.recv_multipart()[2] == b"data"


def frame(body):
    return bytes((0, len(body))) + body


def zmtp_peer(address):
    """Return a TCP connection that has greeted as a SUB socket of ZMTP 3.0, whose frames are written by hand.

    Source: https://rfc.zeromq.org/spec/23/
    """
    host, port = address.removeprefix("tcp://").rsplit(":", 1)
    raw = socket.create_connection((host, int(port)), timeout=120)
    raw.sendall(b"\xff" + bytes(8) + b"\x7f\x03\x00" + b"NULL".ljust(20, b"\0") + bytes(32))
    ready = b"\x05READY\x0bSocket-Type\x00\x00\x00\x03SUB"
    raw.sendall(bytes((4, len(ready))) + ready)
    # ZeroMQ closes the connection of a peer that goes on before it has been greeted.
    with raw.makefile("rb") as answers:
        answers.read(64)
        _command, length = answers.read(2)
        assert answers.read(length).startswith(b"\x05READY")
    return raw


def test_messages_that_were_held_leave_in_their_order(outlet, subscribe):
    with subscribe() as socket:
        until(lambda: outlet.listeners(TOPIC), outlet)
        outlet.hold()
        for number in range(50):
            outlet.send(TOPIC, b"%d" % number, b"type")
        outlet.let_go()
        outlet.send(TOPIC, b"50", b"type")
        assert [int(socket.recv_multipart()[2]) for _ in range(51)] == list(range(51))


def test_a_message_is_not_held_for_longer_than_a_moment_while_others_follow(outlet, subscribe):
    with subscribe() as socket:
        until(lambda: outlet.listeners(TOPIC), outlet)
        outlet.hold()
        deadline = time.monotonic() + 120
        while not socket.poll(0):
            assert time.monotonic() < deadline
            outlet.send(TOPIC, b"data", b"type")
