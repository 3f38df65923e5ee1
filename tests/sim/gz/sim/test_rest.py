"""Steps in which no system has anything to do are physics alone; nothing else shows that."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

import pytest

from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS, find_world
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

JOINTS = (
    "<plugin filename='gz-sim-joint-state-publisher-system' name='gz::sim::systems::JointStatePublisher'>{}</plugin>"
)
POSES = "<plugin filename='gz-sim-pose-publisher-system' name='gz::sim::systems::PosePublisher'>{}</plugin>"
TOPICS = ("/lidar/scan", "/imu", "/model/robot/odometry", "/model/robot/tf", "/model/robot/pose")


def room(plugins: str, limits: str) -> str:
    """Return the text of the room with lidar; its robot has these plugins and limits of its drive."""
    text, robot = find_world("lidar_room.sdf").read_text(), (BUILT_IN_MODELS / "two_wheel_robot/model.sdf").read_text()
    inside = robot[robot.index("<link") : robot.rindex("</model>")].replace("<wheel_radius>", limits + "<wheel_radius>")
    start = text.index("<include>\n      <uri>model://two_wheel_robot")
    end = text.index("</include>", start) + len("</include>")
    return text[:start] + f"<model name='robot'><pose>-2 0 0 0 0 0</pose>{inside}{plugins}</model>" + text[end:]


def never_rest(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    for system in world.systems:
        monkeypatch.setattr(type(system), "rests_until", System.rests_until)
    world.systems.bind()


def drive(text: str, node: Node, prepare: Callable[[World], None]) -> dict[str, Any]:
    found = {topic: hashlib.sha256() for topic in (*TOPICS, "/world/lidar_room/model/robot/joint_state")}
    world = World.from_string(text, seed=3, node=node)
    prepare(world)
    for topic, digest in found.items():
        node.subscribe_raw(topic, lambda data, _, digest=digest: digest.update(data))
    robot = next(each for each in world.systems if each.name == "DiffDrive")
    for number, steps in enumerate((1, 7, 60, 150, 3, 90)):
        robot.command(0.3 - 0.1 * number, 0.2 * number)  # type: ignore[attr-defined]
        assert world.step(steps) == steps
    time_ns, state = world.sim_time_ns, world.data.qpos.tobytes() + world.data.qvel.tobytes()
    for topic in found:
        node.unsubscribe(topic)
    world.close()
    return {"time": time_ns, "state": state, **{topic: digest.hexdigest() for topic, digest in found.items()}}


@pytest.mark.parametrize(
    ("rate", "limits"),
    [
        ("", ""),
        ("<update_rate>40</update_rate>", "<max_linear_acceleration>0.8</max_linear_acceleration>"),
    ],
)
def test_topics_and_state_are_the_same_with_and_without_rest(
    rate: str, limits: str, node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = room(JOINTS.format(rate) + POSES.format("<update_frequency>30</update_frequency>"), limits)
    rested = drive(text, node, lambda world: None)
    with monkeypatch.context() as patch:
        assert drive(text, node, lambda world: never_rest(world, patch)) == rested


def test_hooks_are_not_called_at_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    world = World.load("lidar_room.sdf")
    drive = next(each for each in world.systems if each.name == "DiffDrive")
    called = []
    monkeypatch.setattr(type(drive), "pre_update", lambda _, info: called.append(info.iterations))
    world.systems.bind()
    monkeypatch.setattr(drive, "_written", (0.0, 0.0), raising=False)
    world.step(200)
    assert world.iterations == 200 and called[-1] == 200 and len(called) < 60


def test_a_system_that_never_rests_is_called_in_every_step() -> None:
    world = World.load("lidar_room.sdf")

    class Counter(System):
        count = 0

        def post_update(self, info: UpdateInfo) -> None:
            self.count += 1

    world.systems._running[0].system = counter = Counter()
    world.systems.bind()
    world.step(50)
    assert counter.count == 50


def test_a_request_runs_before_the_next_step_also_at_rest() -> None:
    world = World.load("lidar_room.sdf")
    world.step(10)
    served: list[int] = []

    def ask() -> None:
        if not served and not world.requests:
            world.requests.put(lambda: served.append(world.iterations))

    world.systems.samples = [ask]
    assert world.step(50) == 50
    assert served == [11]
