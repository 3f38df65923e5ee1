"""How long `gz sim` takes from its start to the first clock, against importing what it needs."""

import os
import signal
import statistics
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

from gz_course.tests.bench.row import Row

GZ = Path(sys.executable).with_name("gz")
RUNS = 7
DEADLINE = 60


def first_clock(world: str) -> float:
    """Start a world; return how long it took until its first clock arrived here [s]."""
    from gz_course.sim.gz.msgs.clock_pb2 import Clock
    from gz_course.sim.gz.transport import Node

    heard = threading.Event()
    with Node() as node:
        node.subscribe(Clock, "/clock", lambda _: heard.set())
        start = time.monotonic()
        process = subprocess.Popen([GZ, "sim", "-r", "-s", "-v", "0", world], start_new_session=True)
        try:
            assert heard.wait(DEADLINE), f"{world} never told the time"
            return time.monotonic() - start
        finally:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(DEADLINE)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()


def importing() -> float:
    start = time.monotonic()
    subprocess.run([sys.executable, "-c", "import mujoco, zmq, google.protobuf.message"], check=True)
    return time.monotonic() - start


def rows() -> Iterator[Row]:
    os.environ |= {"GZ_PARTITION": f"bench-{uuid.uuid4()}", "GZ_IP": "127.0.0.1"}
    reference = statistics.median(importing() for _ in range(RUNS))
    for world in ("empty.sdf", "lidar_room.sdf"):
        times = [first_clock(world) for _ in range(RUNS)]
        median = statistics.median(times)
        yield Row(
            f"gz sim {world}, start to first clock",
            f"{median * 1e3:.0f} ms (slowest {max(times) * 1e3:.0f})",
            f"importing its libraries: {reference * 1e3:.0f} ms",
            f"{median / reference:.1f}",
            "at most 1 s",
        )
