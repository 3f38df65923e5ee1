"""How much `ros2 bag record` takes without loss, and how evenly `ros2 bag play` sends.

Images of 0.9 MB are published at 100 MB/s; what is in the bag is counted, and the processor time of the recorder stands
beside that of a subscriber that does nothing. The spacing of what is played is that of the times at which the player
sent, beside that of a thread that only sleeps until each message is due.
"""

import contextlib
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import psutil

from gz_course.tests.bench.row import Row

SECONDS = 5
IMAGE_BYTES, IMAGE_HERTZ = 900_000, 111
PLAYED_HERTZ = 200
PATIENCE_S = 30.0
ROS2 = str(Path(sys.executable).with_name("ros2"))


@contextlib.contextmanager
def running(*command):
    process = subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(PATIENCE_S)


@contextlib.contextmanager
def node():
    import rclpy

    from gz_course.sim.ros.ros_program.shared_memory import segment_for_images

    with segment_for_images():
        context = rclpy.Context()
        rclpy.init(context=context)
        made = rclpy.create_node("bench_rosbag2", context=context, start_parameter_services=False)
    yield made
    made.destroy_node()
    context.try_shutdown()


def until(condition):
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, "not in time"
        time.sleep(0.02)


def published(publisher, message, count, hertz):
    """Publish at a rate; return the rate reached."""
    begin = time.monotonic()
    for number in range(count):
        time.sleep(max(0.0, begin + number / hertz - time.monotonic()))
        publisher.publish(message)
    return count / (time.monotonic() - begin)


def heard_by(command, publisher, message, count):
    """Publish to a command; return the rate reached and the processor time that the command took."""
    with running(*command) as process:
        until(lambda: publisher.get_subscription_count() == 1)
        before = sum(psutil.Process(process.pid).cpu_times()[:2])
        rate = published(publisher, message, count, IMAGE_HERTZ)
        time.sleep(1.0)
        used = sum(psutil.Process(process.pid).cpu_times()[:2]) - before
    until(lambda: publisher.get_subscription_count() == 0)
    return rate, used


def recording(folder) -> Row:
    from sensor_msgs.msg import Image

    from gz_course.sim.ros.rosbag2.storage.bag import Bag

    count = SECONDS * IMAGE_HERTZ
    image = Image(height=1, width=IMAGE_BYTES, step=IMAGE_BYTES, encoding="mono8", data=bytes(IMAGE_BYTES))
    with node() as made:
        publisher = made.create_publisher(Image, "/bench/image", 100)
        bag = folder / "images"
        rate, used = heard_by((ROS2, "bag", "record", "/bench/image", "-o", bag), publisher, image, count)
        _, idle = heard_by((ROS2, "topic", "hz", "/bench/image"), publisher, image, count)
    kept = Bag(bag).metadata.count
    return Row(
        f"bag record, images at {rate * IMAGE_BYTES / 1e6:.0f} MB/s",
        f"{kept} of {count}, {used:.2f} s of processor",
        f"{idle:.2f} s: topic hz",
        f"{used / max(idle, 0.01):.2f}",
        "all",
    )


def late(times, due):
    """The 99th percentile of the differences between two sequences of spacings [ms]."""
    off = [abs((b - a) - (d - c)) / 1e6 for a, b, c, d in zip(times, times[1:], due, due[1:], strict=False)]
    return statistics.quantiles(off, n=100)[98]


def playing(folder) -> Row:
    from rclpy.executors import SingleThreadedExecutor
    from std_msgs.msg import String

    from gz_course.sim.ros.rosbag2.definitions import definition
    from gz_course.sim.ros.rosbag2.storage.bag_writer import BagWriter
    from gz_course.sim.ros.rosbag2.storage.metadata import Topic
    from gz_course.tests.sim.ros.rosbag2.bags import START, string

    count, step = SECONDS * PLAYED_HERTZ, 10**9 // PLAYED_HERTZ
    writer = BagWriter(folder / "even")
    writer.add_topic(Topic("/chatter", "std_msgs/msg/String"), definition("std_msgs/msg/String"))
    for number in range(count):
        writer.write("/chatter", START + number * step, 0, string(str(number)))
    writer.close()
    due = [number * step for number in range(count)]
    slept = []
    begin = time.monotonic_ns()
    for each in due:
        time.sleep(max(0.0, (begin + each - time.monotonic_ns()) / 1e9))
        slept.append(time.monotonic_ns())
    sent = {}
    with node() as made:
        made.create_subscription(
            String, "/chatter", lambda message, info: sent.update({int(message.data): info["source_timestamp"]}), 1000
        )
        executor = SingleThreadedExecutor(context=made.context)
        executor.add_node(made)
        thread = threading.Thread(target=executor.spin)
        thread.start()
        subprocess.run([ROS2, "bag", "play", folder / "even"], check=True, stderr=subprocess.DEVNULL)
        executor.shutdown()
        thread.join()
    numbers = sorted(sent)
    played = late([sent[n] for n in numbers], [due[n] for n in numbers])
    alone = late(slept, due)
    return Row(
        f"bag play at {PLAYED_HERTZ} Hz, spacing p99",
        f"{played:.2f} ms, {len(sent)} of {count}",
        f"{alone:.2f} ms: sleep",
        f"{played / max(alone, 0.01):.2f}",
        "2 ms",
    )


def rows() -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as folder:
        yield recording(Path(folder))
        yield playing(Path(folder))
