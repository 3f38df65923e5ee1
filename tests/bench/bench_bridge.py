"""How fast parameter_bridge is, against what the two hops it joins cost without it, and how steady under a camera.

A hop of Gazebo's wire is measured with a bare ZeroMQ pair, a hop of ROS with rclpy alone, both with the same payload; a
bridged message makes both, so their sum is the reference.
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

from tests.bench.bridge_pair import GZ, ROS, Ros, sent, stamp, until
from tests.bench.row import Row

ROUNDS = 5
PLAN = {"Twist": (300, 200), "LaserScan": (300, 200), "Image": (60, 30)}
"""Kind -> (messages, hertz) of one round."""
WANTED = {"Twist": 1.5, "LaserScan": 1.5, "Image": 2.0}
HD_SECONDS, HD_HERTZ, CLOCK_HERTZ = 10, 30, 1000
IDLE_SECONDS = 10
ROOT = Path(__file__).parents[2]
BRIDGES = [
    "/b/twist@geometry_msgs/msg/Twist[gz.msgs.Twist",
    "/b/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan",
    "/b/image@sensor_msgs/msg/Image[gz.msgs.Image",
    "/b/hd@sensor_msgs/msg/Image[gz.msgs.Image",
    "/b/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock",
    "/b/command@geometry_msgs/msg/Twist]gz.msgs.Twist",
]
TOPICS = {"Twist": "/b/twist", "LaserScan": "/b/scan", "Image": "/b/image"}


class Process:
    """A bridge_pair that takes orders."""

    def __init__(self):
        self.process = subprocess.Popen(
            [sys.executable, "-m", "tests.bench.bridge_pair"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            start_new_session=True,
        )
        self.port = self.answer()["port"]

    def order(self, do, kind="Twist", topic="", **more):
        self.process.stdin.write(json.dumps({"do": do, "kind": kind, "topic": topic, **more}) + "\n")
        self.process.stdin.flush()

    def answer(self):
        return json.loads(self.process.stdout.readline())

    def close(self):
        self.process.stdin.close()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait(10)
        self.process.stdout.close()


@contextlib.contextmanager
def running_bridge(*arguments):
    """A parameter_bridge that is ready."""
    process = subprocess.Popen(
        [sys.executable, "-m", "ros_gz_bridge.parameter_bridge", *arguments],
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
        start_new_session=True,
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


class Bench:
    """The two sides of a bridge: this process is ROS's, another one Gazebo's."""

    def __init__(self, other):
        self.other = other
        self.ros = Ros()
        self.context = zmq.Context()

    def ros_hop(self, kind, topic, do):
        """Median [s] from sending in the other process to the callback here."""
        count, rate = PLAN[kind]
        took, done = [], threading.Event()

        def take(message):
            took.append(time.monotonic_ns() - sent(message))
            if len(took) == count:
                done.set()

        subscription = self.ros.node.create_subscription(ROS[kind], topic, take, 10)
        until(subscription.get_publisher_count if do == "gz" else lambda: True)
        self.other.order(do, kind, topic, count=count, rate=rate)
        done.wait(60)
        self.ros.node.destroy_subscription(subscription)
        return statistics.median(took) * 1e-9

    def bare_hop(self, kind):
        count, rate = PLAN[kind]
        took, topic = [], f"/{uuid.uuid4()}"
        with contextlib.closing(self.context.socket(zmq.SUB)) as socket:
            socket.rcvhwm = 0
            socket.rcvtimeo = 60_000
            socket.connect(f"tcp://127.0.0.1:{self.other.port}")
            socket.subscribe(topic.encode())
            self.other.order("bare", kind, topic, count=count, rate=rate)
            while len(took) < count:
                took.append(sent(GZ[kind].FromString(socket.recv_multipart()[2])))
                took[-1] = time.monotonic_ns() - took[-1]
        return statistics.median(took) * 1e-9

    def to_gazebo(self, publisher):
        count, rate = PLAN["Twist"]
        message = ROS["Twist"]()
        pause = threading.Event()
        self.other.order("listen", "Twist", "/b/command", count=count)
        pause.wait(1.5)  # nothing tells on this side that the other process listens to the bridge
        for _ in range(count):
            stamp(message)
            publisher.publish(message)
            pause.wait(1 / rate)
        return statistics.median(self.other.answer()["latencies"]) * 1e-9

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
    with environment():
        with contextlib.closing(Process()) as other, contextlib.closing(Bench(other)) as bench:
            with running_bridge(*BRIDGES):
                yield from _latencies(bench)
            yield from _camera_and_clock(bench, other)
        yield _idle()


def _latencies(bench):
    commands = []
    for kind in PLAN:
        rounds = []
        for _ in range(ROUNDS):  # by turns, so that all see the same machine
            hops = bench.bare_hop(kind) + bench.ros_hop(kind, f"/direct/{kind.lower()}", "ros")
            rounds.append((bench.ros_hop(kind, TOPICS[kind], "gz"), hops))
        yield _row(f"Gazebo to ROS, {kind}, median", rounds, WANTED[kind])
    publisher = bench.ros.node.create_publisher(ROS["Twist"], "/b/command", 10)
    until(publisher.get_subscription_count)
    for _ in range(ROUNDS):
        hops = bench.bare_hop("Twist") + bench.ros_hop("Twist", "/direct/twist", "ros")
        commands.append((bench.to_gazebo(publisher), hops))
    yield _row("ROS to Gazebo, Twist, median", commands, WANTED["Twist"])


def _row(name, rounds, wanted):
    """Each round is compared with its own reference: what else runs on the machine comes and goes."""
    measured, reference = (statistics.median(each) for each in zip(*rounds, strict=True))
    ratio = statistics.median(own / hops for own, hops in rounds)
    return Row(
        name,
        f"{measured * 1e6:.0f} us",
        f"a ZeroMQ hop and an rclpy hop: {reference * 1e6:.0f} us",
        f"{ratio:.2f}",
        f"at most {wanted}",
    )


def _camera_and_clock(bench, other):
    """A full HD camera and a fast clock at once; camera, its listener and clock in processes of their own."""
    with (
        running_bridge(*BRIDGES),
        contextlib.closing(Process()) as camera,
        contextlib.closing(Process()) as viewer,
    ):
        times = []

        def tick(message: Clock) -> None:
            times.append(time.monotonic())

        subscription = bench.ros.node.create_subscription(Clock, "/b/clock", tick, 1000)
        until(subscription.get_publisher_count)
        alone = _camera_alone(camera, viewer)
        viewer.order("take", "HD", "/b/hd")
        threading.Event().wait(2)  # for DDS and Gazebo to find one another; nothing announces it
        frames, ticks = HD_SECONDS * HD_HERTZ, (HD_SECONDS + 5) * CLOCK_HERTZ
        other.order("gz", "Clock", "/b/clock", count=ticks, rate=CLOCK_HERTZ)
        until(lambda: len(times) > 100)
        camera.order("gz", "HD", "/b/hd", count=frames, rate=HD_HERTZ)
        started = time.monotonic()
        threading.Event().wait(HD_SECONDS)
        arrived = _all_taken(viewer, frames)
        within = [each for each in times if started <= each <= started + HD_SECONDS]
        gaps = sorted(later - before for before, later in itertools.pairwise(within))
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


def _camera_alone(camera, viewer):
    """How many frames arrive without bridge and clock."""
    frames = HD_SECONDS * HD_HERTZ
    viewer.order("take", "HD", "/direct/hd")
    camera.order("ros", "HD", "/direct/hd", count=frames, rate=HD_HERTZ)
    threading.Event().wait(HD_SECONDS)
    return _all_taken(viewer, frames)


def _all_taken(viewer, frames):
    """How many frames have arrived, once all have or none came for 3 s."""
    arrived, last = 0, time.monotonic()
    while arrived < frames and time.monotonic() - last < 3:
        threading.Event().wait(0.2)
        viewer.order("taken")
        now = viewer.answer()["arrived"]
        if now > arrived:
            arrived, last = now, time.monotonic()
    return arrived


def _idle():
    with running_bridge(*BRIDGES) as bridge:
        pause = threading.Event()
        pause.wait(6.5)  # until it has said what it misses
        before = bridge.cpu_times()
        pause.wait(IDLE_SECONDS)
        after = bridge.cpu_times()
    busy = (after.user + after.system - before.user - before.system) / IDLE_SECONDS
    return Row(f"idle bridge of {len(BRIDGES)} topics", f"{busy * 100:.2f} % of a core", "-", "-", "at most 1 %")
