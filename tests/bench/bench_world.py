"""How quickly a world is stepped, against MuJoCo alone stepping the same model, and what a spawn costs.

Stepping is measured in processor time of the process, both sides in turns, because a machine that is shared lengthens
wall time. Its caches are shared, too: on a busy machine the ratios are lower.
"""

import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator

import mujoco

from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS, find_world
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.bench.row import Row

STEPS, TURNS, RUNS = 1000, 40, 7
JOINT_STATES = "<plugin filename='gz-sim-joint-state-publisher-system' name='gz::sim::systems::JointStatePublisher'/>"
HEARD = {
    "/clock": "gz.msgs.Clock",
    "/model/robot/odometry": "gz.msgs.Odometry",
    "/model/robot/tf": "gz.msgs.Pose_V",
    "/lidar/scan": "gz.msgs.LaserScan",
    "/imu": "gz.msgs.IMU",
}
JOINTS = {"/world/lidar_room/model/robot/joint_state": "gz.msgs.Model"}
LISTENER = """
import sys
from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.transport import Node
node = Node()
for each in sys.argv[1:]:
    topic, kind = each.split("=")
    node.subscribe(message_class(kind), topic, lambda message: None)
print("ready", flush=True)
sys.stdin.read()
"""


def compared(world: World, run: Callable[[int], object]) -> tuple[float, float]:
    """Return the processor time of a step [us] of MuJoCo alone and of `run(steps)`, medians of turns."""
    alone, whole = [], []
    for _ in range(TURNS):
        begin = time.process_time()
        mujoco.mj_step(world.model, world.data, nstep=STEPS)
        middle = time.process_time()
        run(STEPS)
        alone.append((middle - begin) / STEPS * 1e6)
        whole.append((time.process_time() - middle) / STEPS * 1e6)
    return statistics.median(alone), statistics.median(whole)


def served(plugins: str, topics: dict[str, str]) -> tuple[float, float]:
    """Return `compared` for a server of the room at full speed, with a process that listens to these topics."""
    text = find_world("lidar_room.sdf").read_text().replace("<name>robot</name>", f"<name>robot</name>{plugins}")
    node = Node()
    world = World.from_string(text, node=node)
    server = Server(world, node)
    drive = next(each for each in world.systems if each.name == "DiffDrive")
    drive.command(0.2, 0.3)  # type: ignore[attr-defined]
    listened = [f"{topic}={kind}" for topic, kind in topics.items()]
    command = [sys.executable, "-c", LISTENER, *listened]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as listener:
        assert listener.stdout is not None and listener.stdout.readline()
        deadline = time.monotonic() + 30.0
        while any(node.topic_info(topic)[1] == [] for topic in topics):
            assert time.monotonic() < deadline, "the listener was not found"
        server.run(real_time_factor=0.0, iterations=STEPS)
        try:
            return compared(world, lambda n: server.run(real_time_factor=0.0, iterations=n))
        finally:
            listener.communicate()
            world.close()


def rows() -> Iterator[Row]:
    for name, plugins, topics, wanted in (
        ("nobody listens", "", {}, "at least 0.6"),
        ("clock, odometry, tf, lidar and imu heard", "", HEARD, "at least 0.6"),
        ("... and joint states 1000 times a second", JOINT_STATES, HEARD | JOINTS, "told"),
    ):
        alone, whole = served(plugins, topics)
        yield Row(
            f"lidar_room.sdf at full speed, {name}",
            f"{whole:.1f} us a step",
            f"mj_step in C: {alone:.1f} us",
            f"{alone / whole:.2f}",
            wanted,
        )
    world = World.load("lidar_room.sdf")
    text = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    spawns, removes = [], []
    for number in range(RUNS):
        start = time.perf_counter()
        name = world.editor.spawn(text, name="second", pose=Pose((1.0 + number * 0.1, -2.0, 0.0)))
        spawns.append(time.perf_counter() - start)
        start = time.perf_counter()
        world.editor.remove(name)
        removes.append(time.perf_counter() - start)
    start = time.perf_counter()
    World.load("lidar_room.sdf")
    load = time.perf_counter() - start
    yield Row(
        "spawning a robot into a running world",
        f"{min(spawns) * 1e3:.1f} ms, removing it {min(removes) * 1e3:.1f} ms",
        f"loading the world: {load * 1e3:.1f} ms",
        f"{min(spawns) / load:.2f}",
        "at most 1",
    )
