"""How long `ros2` takes to look at a live graph, against what every node has to do first: import rclpy."""

import os
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

from gz_course.grader.run.domain import Domain
from gz_course.tests.bench.row import Row

ROS2 = Path(sys.executable).with_name("ros2")
RUNS = 15
NODES = 3
RATE = 0.02  # s between two messages


def whole_run(command: list, wanted: str = "") -> float:
    """Run a command; return how long it took [s]. It must have printed `wanted`."""
    start = time.monotonic()
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    taken = time.monotonic() - start
    assert wanted in done.stdout, f"{command} printed {done.stdout}"
    return taken


def rows() -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as logs, Domain() as domain:
        os.environ |= {
            "ROS_DOMAIN_ID": str(domain.id),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_LOG_DIR": logs,
        }
        os.environ.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
        yield from _rows()


def _rows() -> Iterator[Row]:
    import rclpy
    from std_msgs.msg import String

    ended = threading.Event()
    contexts = [rclpy.Context() for _ in range(NODES)]
    for context in contexts:
        rclpy.init(context=context)
    nodes = [rclpy.create_node(f"bench_{number}", context=context) for number, context in enumerate(contexts)]
    publishers = [node.create_publisher(String, f"/bench_{number}", 10) for number, node in enumerate(nodes)]

    def publish() -> None:
        while not ended.wait(RATE):
            for publisher in publishers:
                publisher.publish(String(data="here"))

    worker = threading.Thread(target=publish)
    worker.start()
    try:
        bare = statistics.median(whole_run([sys.executable, "-c", "import rclpy"]) for _ in range(RUNS))
        for name, arguments, wanted in (
            (f"ros2 topic list, cold, {NODES} nodes", ["topic", "list"], f"/bench_{NODES - 1}"),
            ("ros2 topic echo --once on a live topic", ["topic", "echo", "--once", "/bench_0"], "data: here"),
        ):
            times = [whole_run([ROS2, *arguments], wanted) for _ in range(RUNS)]
            median = statistics.median(times)
            yield Row(
                name,
                f"{median:.2f} s (slowest {max(times):.2f})",
                f"python -c 'import rclpy': {bare:.2f} s",
                f"{median / bare:.1f}",
                "at most 1.5 s",
            )
    finally:
        ended.set()
        worker.join()
        for node, context in zip(nodes, contexts, strict=True):
            node.destroy_node()
            context.try_shutdown()
