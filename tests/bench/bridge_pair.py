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
from gz.msgs.clock_pb2 import Clock as GzClock
from gz.msgs.image_pb2 import Image as GzImage
from gz.msgs.laserscan_pb2 import LaserScan as GzScan
from gz.msgs.twist_pb2 import Twist as GzTwist
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from sensor_msgs.msg import Image as RosImage
from sensor_msgs.msg import LaserScan as RosScan

from gz.transport import Node
from tests.bench.transport_pair import paced

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


def main():
    gc.freeze()
    ros, node, context, publishers = Ros(), Node(), zmq.Context(), {}
    bare = context.socket(zmq.XPUB)
    bare.sndhwm = 0
    port = bare.bind_to_random_port("tcp://127.0.0.1")
    print(json.dumps({"port": port}), flush=True)
    for line in sys.stdin:
        order = json.loads(line)
        kind, topic = order["kind"], order["topic"]
        match order["do"]:
            case "gz":
                message = gz_example(kind)
                publisher = publishers.setdefault(("gz", topic), None) or node.advertise(topic, type(message))
                publishers["gz", topic] = publisher
                assert publisher.wait_for_subscribers(timeout=30)
                send = publisher.publish
            case "ros":
                message = ros_example(kind)
                publisher = publishers.get(("ros", topic)) or ros.node.create_publisher(type(message), topic, 10)
                publishers["ros", topic] = publisher
                until(publisher.get_subscription_count)
                send = publisher.publish
            case "bare":
                message = gz_example(kind)
                while b"\x01" + topic.encode() != bare.recv():
                    pass
                frames = topic.encode(), f"tcp://127.0.0.1:{port}".encode(), message.DESCRIPTOR.full_name.encode()

                def send(message, frames=frames):
                    bare.send_multipart((frames[0], frames[1], message.SerializeToString(), frames[2]))

            case "listen":  # on Gazebo's side; tells the latencies when all have come
                times = []

                def take(message, times=times, count=order["count"]):
                    times.append(time.monotonic_ns() - sent(message))
                    if len(times) == count:
                        print(json.dumps({"latencies": times}), flush=True)

                node.unsubscribe(topic)
                node.subscribe(GZ[kind], topic, take)
                continue
            case "take":  # on ROS's side; tells how many have come when asked
                arrived = []
                ros.node.create_subscription(ROS[kind], topic, lambda data, arrived=arrived: arrived.append(1), 10)
                continue
            case "taken":
                print(json.dumps({"arrived": len(arrived)}), flush=True)
                continue

        def stamped(message=message, send=send):
            stamp(message)
            send(message)

        threading.Thread(target=paced, args=(order["count"], order["rate"], stamped)).start()
    ros.close()


if __name__ == "__main__":
    main()
