"""The sending socket alone, with subscribers made of plain sockets."""

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
        poller.poll(20000)
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
