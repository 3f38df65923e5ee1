"""A simulator as fast as it goes, a bridge of all its topics, and three nodes."""

import os
import subprocess
import sys
import threading
import uuid
from pathlib import Path

import psutil

from gz_course.sim.bridge.ros_gz_bridge.type_pairs import pairs
from gz_course.sim.gz.msgs.clock_pb2 import Clock
from gz_course.sim.gz.transport import Node, NodeOptions
from gz_course.tests.soak.nodes import NODES
from gz_course.tests.soak.watched import Outcome, Watched, end, entries, left_behind, shared_names, watch

PROGRAMS = Path(sys.executable).parent
START_UP = 300.0  # [s] for the simulator to show its topics
STANDSTILL = 300.0  # [s] without a step, after which the run is given up
RATE = "1000000"  # steps per second: as fast as it goes


def bridges_of(world: str, topics: dict[str, str]) -> list[str]:
    """The arguments of `parameter_bridge` for all topics that have a pair, for commands, and for two services."""
    of_type = {pair.gz_type: pair.ros_type for pair in reversed(pairs())}
    found = [f"{topic}@{of_type[kind]}[{kind}" for topic, kind in sorted(topics.items()) if kind in of_type]
    found.append("/cmd_vel@geometry_msgs/msg/Twist]gz.msgs.Twist")
    found.append(f"/world/{world}/create@ros_gz_interfaces/srv/SpawnEntity")
    found.append(f"/world/{world}/remove@ros_gz_interfaces/srv/DeleteEntity")
    return found


def run(folder: Path, world: str, minutes: float) -> Outcome:
    """Run the world until `minutes` of simulated time have passed."""
    own = {"GZ_PARTITION": uuid.uuid4().hex, "GZ_IP": "127.0.0.1", "TMPDIR": str(folder / "tmp")}
    own |= {"ROS_DOMAIN_ID": str(100 + os.getpid() % 100), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    own |= {"ROS_LOG_DIR": str(folder / "log")}
    os.environ["GZ_IP"] = "127.0.0.1"
    environment = os.environ | own
    running: list[psutil.Popen] = []
    watched: list[Watched] = []
    before = shared_names()

    def start(name: str, *command: str) -> None:
        with (folder / f"{name}.txt").open("wb") as told:
            running.append(
                psutil.Popen(command, env=environment, stdin=subprocess.DEVNULL, stdout=told, stderr=told,
                             start_new_session=True)
            )  # fmt: skip
        watched.append(Watched(name, running[-1].pid))

    now, moved, ready = [0.0], threading.Event(), threading.Event()

    def on_clock(message: Clock) -> None:
        now[0] = message.sim.sec + message.sim.nsec * 1e-9
        moved.set()
        ready.set()

    start("gz sim", str(PROGRAMS / "gz"), "sim", "-s", "-r", "-z", RATE, world)
    stuck = False
    try:
        with Node(NodeOptions(partition=own["GZ_PARTITION"])) as node:
            node.subscribe(Clock, "/clock", on_clock)
            if not ready.wait(START_UP):
                return Outcome([], [], [f"{world} did not start: {(folder / 'gz sim.txt').read_text()}"])
            topics = {t: node.topic_info(t)[0][0].msg_type_name for t in node.topic_list() if node.topic_info(t)[0]}
            name = next(topic for topic in topics if topic.startswith("/world/")).split("/")[2]
            bridges = bridges_of(name, topics)
            start("parameter_bridge", str(PROGRAMS / "parameter_bridge"), *bridges)
            for each in NODES:
                start(each, sys.executable, "-m", "gz_course.tests.soak.nodes", each, name)
            begin, waited = now[0], 0.0

            def finished() -> bool:
                nonlocal waited, stuck
                waited = 0.0 if moved.is_set() else waited + 1.0
                moved.clear()
                stuck = waited > STANDSTILL or any(process.poll() is not None for process in running)
                return stuck or now[0] - begin >= minutes * 60

            watch(lambda: watched, finished)
            passed, held = now[0] - begin, entries(folder / "tmp")
    finally:
        stubborn = end(running[::-1])
    told = [f"{passed / 60:.1f} min of simulated time, {len(bridges)} bridges, {held} temporary files while it ran"]
    told += [(folder / f"{each}.txt").read_text().strip().rpartition("\n")[2] for each in NODES]
    wrong = [f"{name} had to be killed" for name in stubborn] + left_behind(watched, folder / "tmp", before)
    if stuck:
        last = {each.name: (folder / f"{each.name}.txt").read_text()[-400:] for each in watched}
        wrong.append(f"it stopped after {passed / 60:.1f} min: {last}")
    return Outcome(watched, told, wrong)
