"""How fast parameter_bridge is, against what the two hops it joins cost without it, and how steady under a camera.

A hop of Gazebo's wire is measured with a bare ZeroMQ pair, a hop of ROS with rclpy alone, both with the same payload; a
bridged message makes both, so their sum is the reference. The three take turns many times, each time for a moment, so
that all see the same machine.
"""

import contextlib
import itertools
import json
import os
import statistics
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import psutil
import zmq
from rosgraph_msgs.msg import Clock

from gz_course.tests.bench.bridge_pair import GZ, ROS, Ros, sent, stamp, until
from gz_course.tests.bench.row import Row
from gz_course.tests.bench.transport_pair import paced

TURNS = 10
PLAN = {"Twist": (50, 200), "LaserScan": (50, 200), "Image": (12, 30)}
"""Kind -> (messages, hertz) of one turn."""
WANTED = {"Twist": 1.5, "LaserScan": 1.5, "Image": 2.0}
HD_SECONDS, HD_HERTZ, CLOCK_HERTZ = 5, 30, 1000
PATIENCE_S = 3.0
ROOT = Path(__file__).parents[2]
BRIDGES = [
    "/b/twist@geometry_msgs/msg/Twist[gz.msgs.Twist",
    "/b/laserscan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
    "/b/image@sensor_msgs/msg/Image[gz.msgs.Image",
    "/b/hd@sensor_msgs/msg/Image[gz.msgs.Image",
    "/b/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
    "/b/command@geometry_msgs/msg/Twist]gz.msgs.Twist",
]


class Process:
    """A bridge_pair that takes orders."""

    def __init__(self):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "gz_course.tests.bench.bridge_pair"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            start_new_session=True,
        )
        self.port = self.answer()["port"]

    def order(self, do, kind, topic, **more):
        self.process.stdin.write(json.dumps({"do": do, "kind": kind, "topic": topic, **more}) + "\n")
        self.process.stdin.flush()

    def answer(self):
        return json.loads(self.process.stdout.readline())

    def ask(self, do, topic, **more):
        self.order(do, "", topic, **more)
        (answer,) = self.answer().values()
        return answer

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait(10)
        self.process.stdout.close()


@contextlib.contextmanager
def running_bridge(*arguments, **environment):
    """A parameter_bridge that is ready."""
    process = subprocess.Popen(
        [sys.executable, "-m", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge", *arguments],
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
        env={**os.environ, **environment},
    )
    try:
        for line in process.stderr:
            if "ready:" in line:
                break
        threading.Thread(target=process.stderr.read, daemon=True).start()
        yield psutil.Process(process.pid)
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait(10)


class Arrivals:
    """How long each message took that arrived here [ns]; `take` waits for the next so many."""

    def __init__(self):
        self._took = []
        self._changed = threading.Condition()

    def add(self, message):
        took = time.monotonic_ns() - sent(message)
        with self._changed:
            self._took.append(took)
            self._changed.notify()

    def take(self, count):
        """Median [s] of what arrived until so many have, or none more has for some seconds."""
        with self._changed:
            known = -1
            while known < len(self._took) < count:
                known = len(self._took)
                self._changed.wait(PATIENCE_S)
            took, self._took = self._took, []
        return statistics.median(took) * 1e-9


class Bench:
    """The two sides of a bridge: this process is ROS's, another one Gazebo's."""

    def __init__(self, other):
        self.other = other
        self.ros = Ros()
        self.context = zmq.Context()
        self.sockets, self.arrivals = {}, {}
        for kind in PLAN:
            self.sockets[kind] = socket = self.context.socket(zmq.SUB)
            socket.rcvhwm = 0
            socket.rcvtimeo = 60_000
            socket.connect(f"tcp://127.0.0.1:{other.port}")
            socket.subscribe(f"/bare/{kind}".encode())
            for topic in (f"/b/{kind.lower()}", f"/direct/{kind.lower()}"):
                self.arrivals[topic] = Arrivals()
                self.ros.node.create_subscription(ROS[kind], topic, self.arrivals[topic].add, 10)
        other.order("listen", "Twist", "/b/command")
        self.publisher = self.ros.node.create_publisher(ROS["Twist"], "/b/command", 10)
        until(self.publisher.get_subscription_count)

    def hop(self, kind, topic, do):
        """Median [s] from sending in the other process to the callback here."""
        count, rate = PLAN[kind]
        self.other.order(do, kind, topic, count=count, rate=rate)
        return self.arrivals[topic].take(count)

    def both_hops(self, kind):
        return self.bare_hop(kind) + self.hop(kind, f"/direct/{kind.lower()}", "direct")

    def bare_hop(self, kind):
        count, rate = PLAN[kind]
        took, receive = [], self.sockets[kind].recv_multipart
        self.other.order("zeromq", kind, f"/bare/{kind}", count=count, rate=rate)
        for _ in range(count):
            message = GZ[kind].FromString(receive()[2])
            took.append(time.monotonic_ns() - sent(message))
        return statistics.median(took) * 1e-9

    def to_gazebo(self):
        count, rate = PLAN["Twist"]
        message = ROS["Twist"]()

        def send():
            stamp(message)
            self.publisher.publish(message)

        paced(count, rate, send)  # as the other process sends
        return statistics.median(self.other.ask("latencies", "/b/command", count=count)) * 1e-9

    def close(self):
        self.ros.close()
        self.context.destroy(linger=0)


@contextlib.contextmanager
def environment():
    before = dict(os.environ)
    os.environ.update({"GZ_PARTITION": f"bench-{uuid.uuid4()}", "GZ_IP": "127.0.0.1"})
    os.environ.update({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"})
    os.environ.setdefault("ROS_DOMAIN_ID", str(102 + uuid.uuid4().int % 100))
    try:
        yield
    finally:
        os.environ.clear()
        os.environ.update(before)


def rows() -> Iterator[Row]:
    with environment(), contextlib.ExitStack() as stack:
        idle = stack.enter_context(running_bridge(*BRIDGES, GZ_PARTITION=f"idle-{uuid.uuid4()}", ROS_DOMAIN_ID="101"))
        ready = time.monotonic()
        stack.enter_context(running_bridge(*BRIDGES))
        other = stack.enter_context(contextlib.closing(Process()))
        bench = stack.enter_context(contextlib.closing(Bench(other)))
        for _ in range(2):  # each path once: endpoints find one another, caches fill
            _turn(bench)
        turns = [_turn(bench) for _ in range(TURNS // 2)]
        busy = _busy(idle), time.monotonic()  # it has said by now what it misses
        assert busy[1] - ready > 7, "the idle bridge is still starting"
        turns += [_turn(bench) for _ in range(TURNS // 2)]
        for name, wanted in (
            *((f"Gazebo to ROS, {kind}", WANTED[kind]) for kind in PLAN),
            ("ROS to Gazebo, Twist", 1.5),
        ):
            yield _row(name, [turn[name] for turn in turns], wanted)
        yield from _camera_and_clock(bench, other)
        share = (_busy(idle) - busy[0]) / (time.monotonic() - busy[1])
        yield Row(f"idle bridge of {len(BRIDGES)} topics", f"{share * 100:.2f} % of a core", "-", "-", "at most 1 %")


def _turn(bench):
    """Everything once: name of the row -> (bridged, its two hops) [s]."""
    took = {}
    for kind in PLAN:
        hops = bench.both_hops(kind)
        took[f"Gazebo to ROS, {kind}"] = bench.hop(kind, f"/b/{kind.lower()}", "gz"), hops
        if kind == "Twist":
            took["ROS to Gazebo, Twist"] = bench.to_gazebo(), hops
    return took


def _busy(process):
    times = process.cpu_times()
    return times.user + times.system


def _row(name, turns, wanted):
    """Each turn is compared with its own reference: what else runs on the machine comes and goes."""
    measured, reference = (statistics.median(each) for each in zip(*turns, strict=True))
    ratio = statistics.median(own / hops for own, hops in turns)
    return Row(
        f"{name}, median",
        f"{measured * 1e6:.0f} us",
        f"a ZeroMQ hop and an rclpy hop: {reference * 1e6:.0f} us",
        f"{ratio:.2f}",
        f"at most {wanted}",
    )


def _camera_and_clock(bench, other):
    """A full HD camera and a fast clock at once; camera, its two listeners and clock in processes of their own."""
    frames = HD_SECONDS * HD_HERTZ
    with contextlib.closing(Process()) as camera, contextlib.closing(Process()) as viewer:
        alone = _camera_alone(camera, viewer, frames)
        times = []
        subscription = bench.ros.node.create_subscription(
            Clock, "/b/clock", lambda _: times.append(time.monotonic()), 1000
        )
        until(subscription.get_publisher_count)
        viewer.order("take", "HD", "/b/hd")
        other.order("gz", "Clock", "/b/clock", count=(HD_SECONDS + 3) * CLOCK_HERTZ, rate=CLOCK_HERTZ)
        until(lambda: len(times) > CLOCK_HERTZ)  # time enough for DDS to connect the viewer; nothing announces it
        camera.order("gz", "HD", "/b/hd", count=frames, rate=HD_HERTZ)
        started = time.monotonic()
        arrived = _all_taken(viewer, "/b/hd", frames)
        ended = started + HD_SECONDS
        gaps = sorted(b - a for a, b in itertools.pairwise(each for each in times if started <= each <= ended))
        bench.ros.node.destroy_subscription(subscription)
    yield Row(
        f"1920x1080 rgb8 at {HD_HERTZ} Hz for {HD_SECONDS} s",
        f"{frames - arrived} of {frames} lost",
        f"rclpy alone: {frames - alone} of {frames} lost",
        f"{arrived / frames:.3f}",
        "0 lost",
    )
    yield Row(
        f"meanwhile /clock at {CLOCK_HERTZ} Hz, gap of 99 in 100",
        f"{gaps[int(len(gaps) * 0.99)] * 1e3:.1f} ms",
        f"longest: {gaps[-1] * 1e3:.1f} ms, {len(gaps) / HD_SECONDS:.0f} Hz arrived",
        "-",
        "at most 5 ms",
    )


def _camera_alone(camera, viewer, frames):
    """How many frames arrive without bridge and clock."""
    viewer.order("take", "HD", "/direct/hd")
    camera.order("direct", "HD", "/direct/hd", count=frames, rate=HD_HERTZ)
    return _all_taken(viewer, "/direct/hd", frames)


def _all_taken(viewer, topic, frames):
    """How many frames have arrived when they have been sent, and all are there or none came for a second."""
    sent_by, arrived, last = time.monotonic() + HD_SECONDS, 0, time.monotonic()
    while arrived < frames and (time.monotonic() < sent_by or time.monotonic() - last < 1):
        threading.Event().wait(0.1)
        if (now := viewer.ask("count", topic)) > arrived:
            arrived, last = now, time.monotonic()
    return arrived
