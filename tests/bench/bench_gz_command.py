"""How long `gz topic` takes to show something, against starting Python at all."""

import os
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
RUNS = 15
PERIOD_S = 0.005


def first_line(command: list) -> float:
    """Start a command; return how long it took until its first line of output [s]."""
    start = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE) as process:
        line = process.stdout.readline()
        taken = time.monotonic() - start
        process.terminate()
    assert line, f"{command} printed nothing"
    return taken


def whole_run(command: list) -> float:
    """Run a command; return how long it took [s]."""
    start = time.monotonic()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - start


def rows() -> Iterator[Row]:
    os.environ |= {"GZ_PARTITION": f"bench-{uuid.uuid4()}", "GZ_IP": "127.0.0.1"}
    from gz_course.sim.gz.msgs.twist_pb2 import Twist
    from gz_course.sim.gz.transport import Node

    ended = threading.Event()
    with Node() as node:
        publisher = node.advertise("/bench", Twist)
        message = Twist()
        message.linear.x = 0.5

        def publish() -> None:
            while not ended.wait(PERIOD_S):
                publisher.publish(message)

        worker = threading.Thread(target=publish)
        worker.start()
        try:
            python = statistics.median(whole_run([sys.executable, "-c", "pass"]) for _ in range(RUNS))
            for name, measure, arguments, wanted in (
                ("gz topic -e -t, start to first message", first_line, ["-e", "-t", "/bench"], "at most 300 ms"),
                ("gz topic -l, whole run", whole_run, ["-l"], "a heartbeat of 1 s, and little more"),
            ):
                times = [measure([GZ, "topic", *arguments]) for _ in range(RUNS)]
                median = statistics.median(times)
                yield Row(
                    name,
                    f"{median * 1e3:.0f} ms (slowest {max(times) * 1e3:.0f})",
                    f"python -c pass: {python * 1e3:.0f} ms",
                    f"{median / python:.1f}",
                    wanted,
                )
        finally:
            ended.set()
            worker.join()
