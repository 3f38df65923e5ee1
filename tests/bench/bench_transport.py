"""How fast messages and services of gz.transport are between two processes, against a bare pyzmq PUB/SUB pair.

The bare pair sends the same four frames and serializes and parses the same messages, in a loop without anything else.
"""

import contextlib
import json
import os
import queue
import statistics
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import zmq

from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.transport import Node
from gz_course.tests.bench.row import Row
from gz_course.tests.bench.transport_pair import KINDS

LATENCY = {"100 B": (1000, 500), "6 kB": (1000, 500), "0.9 MB": (200, 50)}
"""Kind -> (messages, hertz)"""
FLOOD = {"100 B": 30_000, "6 kB": 20_000, "0.9 MB": 600}
ROUNDS = 5
CONNECTIONS = 20
CALLS = 1000
PROOF = 100_000, 5000


class Pair:
    """The other process, and this one's ways to receive from it."""

    def __init__(self):
        self.process = subprocess.Popen(
            [sys.executable, str(Path(__file__).with_name("transport_pair.py"))],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=Path(__file__).parents[2],
        )
        self.port = self.answer()["port"]
        self.node = Node()
        self.context = zmq.Context()

    def order(self, **order):
        self.process.stdin.write(json.dumps(order) + "\n")
        self.process.stdin.flush()

    def answer(self):
        return json.loads(self.process.stdout.readline())

    def received(self, kind, count, rate):
        """Latencies [s] and the time from first to last [s] of messages that gz.transport brings."""
        times, done, topic = [], threading.Event(), f"/{uuid.uuid4()}"

        def take(message):
            now = time.monotonic_ns()
            times.append((now, now - message.header.stamp.sec))
            if len(times) == count:
                done.set()

        self.node.subscribe(KINDS[kind], topic, take)
        self.order(do="publish", kind=kind, topic=topic, count=count, rate=rate)
        done.wait(60)
        self.node.unsubscribe(topic)
        return _figures(times)

    def received_bare(self, kind, count, rate):
        times, topic = [], f"/{uuid.uuid4()}"
        with contextlib.closing(self.context.socket(zmq.SUB)) as socket:
            socket.rcvhwm = 0
            socket.rcvtimeo = 60_000
            socket.connect(f"tcp://127.0.0.1:{self.port}")
            socket.subscribe(topic.encode())
            self.order(do="bare", kind=kind, topic=topic, count=count, rate=rate)
            while len(times) < count:
                message = KINDS[kind].FromString(socket.recv_multipart()[2])
                now = time.monotonic_ns()
                times.append((now, now - message.header.stamp.sec))
        return _figures(times)

    def close(self):
        self.node.close()
        self.context.destroy(linger=0)
        self.process.stdin.close()
        self.process.wait(30)
        self.process.stdout.close()


def _figures(times):
    return len(times), statistics.median(latency for _, latency in times) * 1e-9, (times[-1][0] - times[0][0]) * 1e-9


def rows() -> Iterator[Row]:
    before = dict(os.environ)
    os.environ.update({"GZ_PARTITION": f"bench-{uuid.uuid4()}", "GZ_IP": "127.0.0.1"})
    os.environ.update({"GZ_TRANSPORT_SNDHWM": "0", "GZ_TRANSPORT_RCVHWM": "0"})
    try:
        with contextlib.closing(Pair()) as pair:
            for kind in KINDS:
                yield _latency(pair, kind)
            for kind in KINDS:
                yield _throughput(pair, kind)
            yield _first_message(pair)
            yield _proof(pair)
            yield _service(pair)
    finally:
        os.environ.clear()
        os.environ.update(before)


def _latency(pair, kind):
    count, rate = LATENCY[kind]
    ours, bare = [], []
    for _ in range(ROUNDS):  # by turns, so that both see the same machine
        bare.append(pair.received_bare(kind, count, rate)[1])
        ours.append(pair.received(kind, count, rate)[1])
    own, other = statistics.median(ours), statistics.median(bare)
    return Row(
        f"publish to callback, {kind}, median",
        f"{own * 1e6:.0f} us",
        f"bare pyzmq: {other * 1e6:.0f} us",
        f"{own / other:.2f}",
        "at most 1.5",
    )


def _throughput(pair, kind):
    count = FLOOD[kind]
    ours, bare = [], []
    for _ in range(ROUNDS):
        received, _, seconds = pair.received_bare(kind, count, 0)
        bare.append(received / seconds)
        received, _, seconds = pair.received(kind, count, 0)
        ours.append(received / seconds)
    own, other = statistics.median(ours), statistics.median(bare)
    return Row(
        f"throughput, {kind}",
        f"{own:.0f} msg/s",
        f"bare pyzmq: {other:.0f} msg/s",
        f"{own / other:.2f}",
        "at least 0.7",
    )


def _first_message(pair):
    took = []
    for _ in range(CONNECTIONS):
        topic, arrived = f"/{uuid.uuid4()}", queue.SimpleQueue()
        pair.node.subscribe(
            StringMsg, topic, lambda m, arrived=arrived: arrived.put(time.monotonic_ns() - m.header.stamp.sec)
        )
        with contextlib.closing(Pair()) as newcomer:  # a process that nobody knows yet
            newcomer.order(do="advertise", topic=topic)
            took.append(arrived.get(timeout=30) * 1e-6)
        pair.node.unsubscribe(topic)
    return Row(
        "advertise in a new process to first message delivered, median",
        f"{statistics.median(took):.1f} ms",
        f"slowest of {CONNECTIONS}: {max(took):.1f} ms",
        "-",
        "at most 20 ms",
    )


def _proof(pair):
    count, rate = PROOF
    received, latency, seconds = pair.received("100 B", count, rate)
    return Row(
        f"{count} messages at {rate} Hz",
        f"{count - received} lost",
        f"took {seconds:.1f} s, median latency {latency * 1e6:.0f} us",
        f"{received / count:.4f}",
        "0 lost",
    )


def _service(pair):
    pair.order(do="serve", topic="/echo")
    pair.answer()
    took = []
    for _ in range(CALLS):
        start = time.perf_counter()
        done, _ = pair.node.request("/echo", StringMsg(data="x"), StringMsg, StringMsg, 5000)
        assert done
        took.append(time.perf_counter() - start)
    later = statistics.median(took[1:])
    return Row(
        "service, first call",
        f"{took[0] * 1e3:.1f} ms",
        f"later calls: {later * 1e3:.2f} ms",
        f"{took[0] / later:.0f}",
        "at most 20 ms",
    )
