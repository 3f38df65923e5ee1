"""What a view costs the simulator: its processor time for a step while another process takes all pictures.

The view itself is another process; on a machine with few cores it and the browser take what they take.
"""

import os
import statistics
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator
from unittest import mock

from gz_course.sim.gz.sim.commands.sim import broadcaster
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.bench.row import Row

STEPS, RUNS = 8000, 5
VIEWER = """
import sys
from gz_course.sim.gz.transport import Node
node = Node()
node.subscribe_raw("/world/lidar_room/view/state", lambda data, info: None, "gz.msgs.Bytes")
sys.stdin.read()
"""


def rows() -> Iterator[Row]:
    with mock.patch.dict(os.environ, GZ_IP="127.0.0.1", GZ_PARTITION=uuid.uuid4().hex):
        world = World.load("lidar_room.sdf", server_plugins=[broadcaster()])
        node = Node()
        server = Server(world, node)
        publisher = next(each for each in world.systems if each.name == "ViewBroadcaster")._publisher

        def cost() -> float:
            start = time.process_time()
            server.run(real_time_factor=0.0, iterations=STEPS)
            return (time.process_time() - start) / STEPS * 1e6

        cost()
        alone, watched = [], []
        for _ in range(RUNS):
            alone.append(cost())
            viewer = subprocess.Popen([sys.executable, "-c", VIEWER], stdin=subprocess.PIPE)
            assert publisher.wait_for_subscribers(1, 60.0)
            watched.append(cost())
            viewer.communicate()
            while publisher.has_connections():
                time.sleep(0.05)
        world.close()
        node.close()
    without, with_view = statistics.median(alone), statistics.median(watched)
    yield Row(
        "lidar_room.sdf uncapped with a view open, speed",
        f"{with_view:.1f} us of processor time for a step",
        f"without: {without:.1f} us",
        f"{without / with_view:.2f}",
        "at least 0.9",
    )
