"""One end of bench_bridge: publishes on Gazebo's side, on ROS's side or on a bare socket, or listens, as ordered."""

import array
import contextlib
import gc
import json
import sys
import threading
import time

import rclpy
import zmq
from geometry_msgs.msg import Twist as RosTwist
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from sensor_msgs.msg import Image as RosImage
from sensor_msgs.msg import LaserScan as RosScan

from gz_course.sim.gz.msgs.clock_pb2 import Clock as GzClock
from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzScan
from gz_course.sim.gz.msgs.twist_pb2 import Twist as GzTwist
from gz_course.sim.gz.transport import Node
from gz_course.tests.bench.transport_pair import paced

GZ = {"Twist": GzTwist, "LaserScan": GzScan, "Image": GzImage, "HD": GzImage, "Clock": GzClock}
ROS = {"Twist": RosTwist, "LaserScan": RosScan, "Image": RosImage, "HD": RosImage}
BEAMS = 720
SIZES = {"Image": (640, 480), "HD": (1920, 1080)}
PER_S = 10**9


def gz_example(kind):
    """A message of Gazebo."""
    if kind in SIZES:
        width, height = SIZES[kind]
        size = width * height * 3
        return GzImage(width=width, height=height, step=width * 3, pixel_format_type="RGB_INT8", data=bytes(size))
    if kind == "LaserScan":
        return GzScan(
            frame="lidar",
            angle_min=-3.0,
            angle_max=3.0,
            angle_step=6.0 / (BEAMS - 1),
            count=BEAMS,
            ranges=[1.0 + i / 512 for i in range(BEAMS)],
            intensities=[0.5] * BEAMS,
        )
    return GZ[kind]()


def ros_example(kind):
    """The same for ROS."""
    if kind in SIZES:
        width, height = SIZES[kind]
        pixels = array.array("B", bytes(width * height * 3))
        return RosImage(width=width, height=height, step=width * 3, encoding="rgb8", data=pixels)
    if kind == "LaserScan":
        return RosScan(ranges=[1.0 + i / 512 for i in range(BEAMS)], intensities=[0.5] * BEAMS)
    return ROS[kind]()


def stamp(message):
    """Write the time of sending into a message of either side: the header, or linear.x of a Twist [ns]."""
    now = time.monotonic_ns()
    if isinstance(message, RosTwist | GzTwist):
        message.linear.x = float(now)
    elif isinstance(message, GzClock):
        message.sim.sec, message.sim.nsec = divmod(now, PER_S)
    elif isinstance(message, GzImage | GzScan):
        message.header.stamp.sec, message.header.stamp.nsec = divmod(now, PER_S)
    else:
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(now, PER_S)


def sent(message):
    """The time of sending [ns] of what arrives, of either side."""
    if isinstance(message, RosTwist | GzTwist):
        return int(message.linear.x)
    if isinstance(message, GzImage | GzScan):
        return message.header.stamp.sec * PER_S + message.header.stamp.nsec
    return message.header.stamp.sec * PER_S + message.header.stamp.nanosec


class Ros:
    """A spinning node."""

    def __init__(self):
        self.context = rclpy.Context()
        rclpy.init(context=self.context)
        self.node = rclpy.create_node("bench", context=self.context, start_parameter_services=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.thread = threading.Thread(target=self._spin, daemon=True)
        self.thread.start()

    def _spin(self):
        with contextlib.suppress(ExternalShutdownException):
            self.executor.spin()

    def close(self):
        self.executor.shutdown()
        self.thread.join(5)
        self.node.destroy_node()
        self.context.try_shutdown()


def until(condition, seconds=30):
    pause, end = threading.Event(), time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "discovery took too long"
        pause.wait(0.01)


class Pair:
    """The orders this process understands; endpoints stay, once made."""

    def __init__(self):
        self.ros, self.node, self.bare = Ros(), Node(), zmq.Context().socket(zmq.XPUB)
        self.bare.sndhwm = 0
        self.port = self.bare.bind_to_random_port("tcp://127.0.0.1")
        self.publishers, self.heard, self.taken, self.bare_topics = {}, {}, {}, set()

    def gz(self, order):
        """Publish with gz.transport."""
        message = gz_example(order["kind"])
        if ("gz", order["topic"]) not in self.publishers:
            self.publishers["gz", order["topic"]] = self.node.advertise(order["topic"], type(message))
        publisher = self.publishers["gz", order["topic"]]
        assert publisher.wait_for_subscribers(timeout=30)
        self._send(order, message, publisher.publish)

    def direct(self, order):
        """Publish with rclpy."""
        message = ros_example(order["kind"])
        if ("ros", order["topic"]) not in self.publishers:
            self.publishers["ros", order["topic"]] = self.ros.node.create_publisher(type(message), order["topic"], 10)
        publisher = self.publishers["ros", order["topic"]]
        until(publisher.get_subscription_count)
        self._send(order, message, publisher.publish)

    def zeromq(self, order):
        """Publish on the bare socket, with the frames that Gazebo's messages have."""
        message, topic = gz_example(order["kind"]), order["topic"].encode()
        while topic not in self.bare_topics:
            self.bare_topics.add(self.bare.recv()[1:])
        address, kind = f"tcp://127.0.0.1:{self.port}".encode(), message.DESCRIPTOR.full_name.encode()
        self._send(
            order,
            message,
            lambda message: self.bare.send_multipart((topic, address, message.SerializeToString(), kind)),
        )

    def _send(self, order, message, send):
        def stamped():
            stamp(message)
            send(message)

        threading.Thread(target=paced, args=(order["count"], order["rate"], stamped)).start()

    def listen(self, order):
        """Hear a topic of Gazebo."""
        heard = self.heard[order["topic"]] = []
        self.node.subscribe(
            GZ[order["kind"]], order["topic"], lambda message: heard.append(time.monotonic_ns() - sent(message))
        )

    def latencies(self, order):
        """Tell what was heard since the last time [ns], once so many messages have come or 5 s have passed."""
        heard, pause, end = self.heard[order["topic"]], threading.Event(), time.monotonic() + 5
        while len(heard) < order["count"] and time.monotonic() < end:
            pause.wait(0.005)
        print(json.dumps({"latencies": heard}), flush=True)
        heard.clear()

    def take(self, order):
        """Count the messages of a topic of ROS."""
        taken = self.taken[order["topic"]] = []
        self.ros.node.create_subscription(ROS[order["kind"]], order["topic"], lambda _: taken.append(1), 10)

    def count(self, order):
        """Tell how many were taken."""
        print(json.dumps({"count": len(self.taken[order["topic"]])}), flush=True)


def main():
    gc.freeze()
    pair = Pair()
    print(json.dumps({"port": pair.port}), flush=True)
    for line in sys.stdin:
        order = json.loads(line)
        getattr(pair, order["do"])(order)
    pair.ros.close()


if __name__ == "__main__":
    main()
