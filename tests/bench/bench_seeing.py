"""How much lidars and cameras add to the rays they cast, and how fast a whole robot runs with its sensors heard."""

import statistics
import time
from collections.abc import Callable, Iterator

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.builder import build_spec
from gz_course.sim.gz.sim.sdf.resources import find_model
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.bench.row import Row

ROUNDS = 15
SIM_SECONDS = 4.0
PLUGINS = "".join(
    f"<plugin filename='gz-sim-{file}-system' name='gz::sim::systems::{name}'/>"
    for file, name in (("physics", "Physics"), ("sensors", "Sensors"), ("imu", "Imu"))
)
BEGIN = f"<sdf version='1.10'><world name='w'>{PLUGINS}<include><uri>model://sun</uri></include>"
GROUND = "<include><uri>model://ground_plane</uri></include>"
END = "</world></sdf>"
LIDAR = (
    "<sensor name='s' type='gpu_lidar'><lidar><scan><horizontal><samples>{beams}</samples>"
    "<min_angle>-3.14159</min_angle><max_angle>3.14159</max_angle></horizontal></scan><range><min>0.1</min><max>20</max></range></lidar></sensor>"
)
CAMERA = (
    "<sensor name='s' type='camera'><camera><horizontal_fov>1.3</horizontal_fov><image><width>320</width>"
    "<height>240</height></image></camera></sensor>"
)
IMU = "<sensor name='imu' type='imu'><topic>imu</topic><update_rate>100</update_rate></sensor>"


def room(shapes: int = 62) -> str:
    """A ground and things standing on it, the same on every run."""
    random = np.random.default_rng(3)
    kinds = (
        "<box><size>.5 .4 .8</size></box>",
        "<cylinder><radius>.25</radius><length>.8</length></cylinder>",
        "<sphere><radius>.35</radius></sphere>",
    )
    things = "".join(
        f"<model name='b{i}'><static>1</static><pose>{x} {y} 0.4 0 0 {turn}</pose><link name='l'><visual name='v'>"
        f"<geometry>{kinds[i % 3]}</geometry></visual></link></model>"
        for i, (x, y, turn) in enumerate(random.uniform((-6, -6, 0), (6, 6, 3), (shapes, 3)).tolist())
    )
    return GROUND + things


def rig(sensor: str) -> str:
    return (
        f"<model name='rig'><static>1</static><pose>-7 -5 2.2 0 0.35 0.65</pose><link name='l'>{sensor}</link></model>"
    )


def best(work: Callable[[], object]) -> float:
    """The least processor time [s] of some rounds: the one the machine disturbed least."""
    times = []
    for _ in range(ROUNDS):
        start = time.thread_time()
        work()
        times.append(time.thread_time() - start)
    return min(times)


def sensor_of(world: World):
    return next(system for system in world.systems if system.name == "Sensors").sensors[0]


def bare(world: World) -> Callable[[], None]:
    """MuJoCo's ray cast alone, with the rays of the world's sensor."""
    sensor = sensor_of(world)
    position, quaternion = sensor.caster.pose()
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, quaternion)
    rays = (sensor.directions @ axes.reshape(3, 3).T).ravel()
    count = len(rays) // 3
    geom, distance = np.zeros(count, dtype=np.int32), np.zeros(count)
    groups = np.array((0, 1, 0, 0, 0, 0), dtype=np.uint8)

    def cast() -> None:
        mujoco.mj_multiRay(
            world.model, world.data, position, rays, groups, True, -1, geom, distance, None, count, 100.0
        )  # fmt: skip

    return cast


def row(name: str, work: Callable[[], object], reference: Callable[[], object], what: str, wanted: str) -> Row:
    measured, against = best(work), best(reference)
    return Row(name, f"{measured * 1e3:.2f} ms", f"{what} {against * 1e3:.2f} ms", f"{measured / against:.2f}", wanted)


def robots(count: int) -> str:
    return "".join(
        "<include><uri>model://two_wheel_robot</uri>"
        f"<name>robot{i}</name><pose>{2 * (i % 4)} {2 * (i // 4)} 0 0 0 0</pose></include>"
        for i in range(count)
    )


def run_seconds(world: World) -> float:
    """Processor time [s] for the benchmark's simulated time, best of three."""
    steps = round(SIM_SECONDS * 1e9 / world.step_size_ns)
    times = []
    for _ in range(3):
        start = time.thread_time()
        world.step(steps)
        times.append(time.thread_time() - start)
    return min(times)


def bare_seconds(world: World) -> float:
    """Processor time [s] of a bare mj_step loop of the same model from the same state."""
    data = mujoco.MjData(world.model)
    data.qpos[:], data.qvel[:] = world.data.qpos, world.data.qvel
    steps = round(SIM_SECONDS * 1e9 / world.step_size_ns)
    times = []
    for _ in range(3):
        start = time.thread_time()
        for _ in range(steps):
            mujoco.mj_step(world.model, data)
        times.append(time.thread_time() - start)
    return min(times)


def rows() -> Iterator[Row]:
    for beams in (360, 640):
        world = World.from_string(BEGIN + room() + rig(LIDAR.format(beams=beams)) + END)
        wanted = "<= 1.5" if beams == 360 else ""
        yield row(f"scan of {beams} beams", sensor_of(world).measure, bare(world), "mj_multiRay", wanted)
    for width, height in ((320, 240), (640, 480)):
        size = CAMERA.replace(">320<", f">{width}<").replace(">240<", f">{height}<")
        world = World.from_string(BEGIN + room() + rig(size) + END)
        name = f"camera {width}x{height}, with shadows"
        yield row(name, sensor_of(world).image, bare(world), "mj_multiRay of its pixels", "<= 1.2")
    yield _lidar_room()
    yield _one_robot()
    yield _ten_robots()
    yield _many_shapes()


def _lidar_room() -> Row:
    """How much the camera of the course's own room adds to a robot all of whose sensors are heard."""
    times = []
    for topics in (("/lidar/scan", "/imu", "/camera/image"), ("/lidar/scan", "/imu")):
        with Node(NodeOptions(scope=Scope.PROCESS)) as node:
            world = World.load("lidar_room.sdf", node=node)
            for topic in topics:
                node.subscribe_raw(topic, lambda data, info: None)
            times.append(run_seconds(world))
            world.close()
    name = "lidar_room.sdf; lidar, IMU and camera heard"
    rates = [f"{SIM_SECONDS / each:.0f} x real time" for each in times]
    return Row(name, rates[0], f"without the camera {rates[1]}", f"{times[0] / times[1]:.1f}", "")


def _many_shapes(count: int = 3000) -> Row:
    """Load a row of shapes like those of Gazebo's example `3k_shapes.sdf`."""
    kinds = (
        ("<box><size>1 1 1</size></box>", 0.0),
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", -1.5),
        ("<sphere><radius>0.5</radius></sphere>", 1.5),
    )
    shapes = []
    for i in range(count):
        shape, side = kinds[i % 3]
        parts = "".join(f"<{tag} name='s'><geometry>{shape}</geometry></{tag}>" for tag in ("collision", "visual"))
        pose = f"<pose>{1.5 * (i // 3)} {side} 0.5 0 0 0</pose>"
        shapes.append(f"<model name='s{i}'>{pose}<link name='l'>{parts}</link></model>")
    start = time.thread_time()
    world = World.from_string(BEGIN + GROUND + "".join(shapes) + END)
    loaded = time.thread_time() - start
    spec = build_spec(world.description, world.systems.servos, world.diagnostics)
    start = time.thread_time()
    spec.compile()
    compiled = time.thread_time() - start
    start = time.thread_time()
    world.step(5)
    step = (time.thread_time() - start) / 5
    measured = f"loads in {loaded:.1f} s, a step takes {step * 1e3:.0f} ms"
    return Row(
        f"{count} shapes on a ground",
        measured,
        f"MuJoCo compiles in {compiled:.1f} s",
        f"{loaded / compiled:.1f}",
        "60 s",
    )


def _one_robot() -> Row:
    file = find_model("model://two_wheel_robot", None)
    model = file.read_text(encoding="utf-8").partition('<sdf version="1.10">')[2].replace("</sdf>", "")
    model = model.replace("<samples>360</samples>", "<samples>640</samples>")
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        world = World.from_string(BEGIN + room(12) + model + END, node=node)
        counts = dict.fromkeys(("/lidar/scan", "/imu", "/model/two_wheel_robot/odometry"), 0)
        for topic in counts:
            node.subscribe_raw(topic, lambda data, info, topic=topic: counts.update({topic: counts[topic] + 1}))
        measured, against = run_seconds(world), bare_seconds(world)
        world.close()
    return Row(
        "small robot among 12 things; scans of 640 beams at 10 Hz, IMU 100 Hz, odometry 50 Hz heard",
        f"{SIM_SECONDS / measured:.0f} x real time ({sum(counts.values())} messages)",
        f"mj_step alone {SIM_SECONDS / against:.0f} x",
        f"{against / measured:.2f}",
        ">= 0.5",
    )


def _ten_robots() -> Row:
    times = []
    for count in (1, 10):
        with Node(NodeOptions(scope=Scope.PROCESS)) as node:
            world = World.from_string(BEGIN + GROUND + robots(count) + END, node=node)
            for i in range(count):
                node.subscribe_raw(f"/model/robot{i}/odometry", lambda data, info: None)
            times.append(statistics.median(run_seconds(world) for _ in range(3)))
            world.close()
    return Row("10 robots", f"{times[1]:.2f} s", f"one robot {times[0]:.2f} s", f"{times[1] / times[0]:.1f}", "<= 12")
