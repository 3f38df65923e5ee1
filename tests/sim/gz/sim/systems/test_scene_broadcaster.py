"""SceneBroadcaster: rates of the poses, the scene and its changes, services from any thread."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.msgs.scene_pb2 import Scene
from gz_course.sim.gz.msgs.serialized_map_pb2 import SerializedStepMap
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.uint32_v_pb2 import UInt32_V
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.scene.state import component_type
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

BROADCASTER = "<plugin filename='gz-sim-scene-broadcaster-system' name='gz::sim::systems::SceneBroadcaster'>{}</plugin>"
INSIDE = """
<gravity>0 0 -10</gravity>
<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose></light>
<model name="floor"><static>true</static><link name="slab"><visual name="look"><geometry><box/></geometry></visual>
  </link></model>
<model name="ball"><pose>0 0 5 0 0 0</pose><link name="body"><visual name="skin"><pose>0 0 0.1 0 0 0</pose>
  <geometry><sphere/></geometry></visual></link></model>
"""
SPAWNED = "<sdf version='1.10'><model name='late'><pose>5 0 1 0 0 0</pose><link name='l'/></model></sdf>"
TOPICS = {
    "pose/info": Pose_V,
    "dynamic_pose/info": Pose_V,
    "scene/info": Scene,
    "scene/deletion": UInt32_V,
    "state": SerializedStepMap,
}


class Ear:
    """A world with a SceneBroadcaster, and all its messages by topic."""

    def __init__(self, world: World, node: Node, topics: dict[str, Any]) -> None:
        self.world, self.node = world, node
        self.heard: dict[str, list[Any]] = {topic: [] for topic in topics}
        for topic, kind in topics.items():
            node.subscribe(kind, f"/world/w/{topic}", self.heard[topic].append)
        world.attach(node)

    def call(self, service: str, response_type: Any, request: Any = None) -> tuple[bool, Any]:
        return self.node.request(f"/world/w/{service}", request, type(request or Empty()), response_type)

    def clear(self) -> None:
        for messages in self.heard.values():
            messages.clear()


@pytest.fixture
def ear(load_text: Callable[..., World], node: Node) -> Iterator[Callable[..., Ear]]:
    worlds = []

    def make(parameters: str = "", topics: dict[str, Any] = TOPICS, inside: str = INSIDE) -> Ear:
        worlds.append(load_text(BROADCASTER.format(parameters) + inside))
        return Ear(worlds[-1], node, topics)

    yield make
    for world in worlds:
        world.close()


def stamps(messages: list[Any]) -> list[int]:
    return [message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nsec for message in messages]


def by_name(message: Any) -> dict[str, Any]:
    return {pose.name: pose for pose in message.pose}


def test_poses_of_everything_sixty_times_a_second(ear: Callable[..., Ear]) -> None:
    made = ear()
    made.world.step(1000)
    messages = made.heard["pose/info"]
    assert len(messages) == 60
    assert [pose.name for pose in messages[0].pose] == ["floor", "ball", "slab", "body", "look", "skin", "sun"]
    times = stamps(messages)
    assert times[0] == 1_000_000
    gaps = {later - earlier for earlier, later in itertools.pairwise(times[1:])}
    assert gaps == {16_000_000, 17_000_000}


def test_poses_are_in_the_parents_frame_and_numbered(ear: Callable[..., Ear]) -> None:
    made = ear()
    made.world.step(500)
    poses = by_name(made.heard["pose/info"][-1])
    at = stamps(made.heard["pose/info"])[-1] * 1e-9
    assert poses["ball"].position.z == pytest.approx(5 - 5 * at * at, abs=0.01)
    assert poses["body"].position.z == pytest.approx(0, abs=1e-9)
    assert poses["skin"].position.z == 0.1
    assert poses["sun"].position.z == 10
    assert poses["ball"].orientation.w == 1
    numbers = made.world.entities.number
    assert poses["skin"].id == numbers("visual", "ball", "body", "skin")
    assert poses["sun"].id == numbers("light", "sun")


def test_dynamic_poses_are_those_of_what_can_move(ear: Callable[..., Ear]) -> None:
    made = ear("<dynamic_pose_hertz>100</dynamic_pose_hertz>")
    made.world.step(500)
    messages = made.heard["dynamic_pose/info"]
    assert len(messages) == 51  # the first step, and every 10 ms
    assert {pose.name for pose in messages[-1].pose} == {"ball", "body"}
    assert by_name(messages[-1])["ball"].position.z < 5 < 5 + by_name(messages[0])["ball"].position.z
    assert len(made.heard["pose/info"]) == 30


def test_nothing_is_made_when_nobody_listens(ear: Callable[..., Ear], monkeypatch: pytest.MonkeyPatch) -> None:
    made = ear(topics={})
    monkeypatch.setattr(
        "gz_course.sim.gz.sim.scene.graph.SceneGraph.poses", lambda self: pytest.fail("poses were computed")
    )
    made.world.step(100)


def test_the_scene_is_published_once_and_served(ear: Callable[..., Ear]) -> None:
    made = ear()
    made.world.step(100)
    (published,) = made.heard["scene/info"]
    assert [model.name for model in published.model] == ["floor", "ball"]
    ok, served = made.call("scene/info", Scene)
    assert ok
    assert [light.name for light in served.light] == ["sun"]
    assert served.model[1].pose.position.z == made.world.truth.pose("ball").position[2] < 5


def test_what_comes_and_goes_is_told(ear: Callable[..., Ear]) -> None:
    made = ear()
    made.world.step(1)
    made.clear()
    made.world.editor.spawn(SPAWNED)
    made.world.step(1)
    (scene,) = made.heard["scene/info"]
    assert [model.name for model in scene.model] == ["late"]
    assert not scene.light
    number = made.world.entities.number("model", "late")
    assert scene.model[0].id == number > 0
    made.world.step(20)
    assert "late" in by_name(made.heard["pose/info"][-1])
    assert made.heard["scene/deletion"] == []
    made.world.editor.remove("late")
    made.world.editor.remove("sun")
    made.world.step(20)
    (deleted,) = made.heard["scene/deletion"]
    assert number in deleted.data
    assert len(deleted.data) == 2
    assert {"late", "sun"}.isdisjoint(by_name(made.heard["pose/info"][-1]))


def test_who_asks_between_two_steps_takes_nothing_from_those_who_listen(ear: Callable[..., Ear]) -> None:
    made = ear()
    made.call("scene/info", Scene)
    made.world.step(1)
    assert [len(made.heard[topic]) for topic in ("scene/info", "pose/info")] == [1, 1]
    made.world.editor.remove("ball")
    made.call("scene/graph", StringMsg)
    made.world.step(20)
    assert len(made.heard["scene/deletion"]) == 1
    assert "ball" not in by_name(made.heard["pose/info"][-1])


def test_a_rewound_world_begins_with_the_same_bytes(ear: Callable[..., Ear]) -> None:
    made = ear()

    def bytes_of_all() -> dict[str, list[bytes]]:
        made.clear()
        made.world.step(100)
        return {
            topic: [each.SerializeToString(deterministic=True) for each in got] for topic, got in made.heard.items()
        }

    first = bytes_of_all()
    assert all(messages for topic, messages in first.items() if topic != "scene/deletion")
    made.world.editor.spawn(SPAWNED)
    made.world.step(50)
    number = made.world.entities.number("model", "late")
    made.clear()
    made.world.reset()
    assert [list(each.data) for each in made.heard["scene/deletion"]] == [[number]]
    assert bytes_of_all() == first


def test_the_graph_is_served(ear: Callable[..., Ear]) -> None:
    made = ear(topics={})
    ok, message = made.call("scene/graph", StringMsg)
    assert ok
    assert message.data.startswith('digraph {\n  1 [label="w (1)"];\n')
    assert 'label="skin (' in message.data


def names_in(state: Any) -> set[str]:
    kind = component_type("Name")
    return {
        each.component.decode()
        for entity in state.entities.values()
        for each in entity.components.values()
        if each.type == kind
    }


def test_the_state_is_published_whole_and_then_what_moves(ear: Callable[..., Ear]) -> None:
    made = ear("<state_hertz>100</state_hertz>")
    made.world.step(100)
    first, second, *_ = messages = made.heard["state"]
    assert len(messages) == 11
    assert names_in(first.state) == {"w", "floor", "slab", "look", "ball", "body", "skin", "sun"}
    assert first.state.has_one_time_component_changes
    assert set(second.state.entities) == {
        made.world.entities.number("model", "ball"),
        made.world.entities.number("link", "ball", "body"),
    }
    assert (second.stats.iterations, second.stats.sim_time.nsec, second.stats.step_size.nsec) == (10, 10**7, 10**6)
    made.clear()
    made.world.editor.spawn(SPAWNED)
    made.world.step(10)
    assert "late" in names_in(made.heard["state"][0].state)


def test_the_state_is_served_and_sent_to_whoever_asks(ear: Callable[..., Ear]) -> None:
    made = ear(topics={})
    ok, message = made.call("state", SerializedStepMap)
    assert ok
    assert "skin" in names_in(message.state)
    sent: list[Any] = []
    made.node.advertise_service("/my/door", SerializedStepMap, Empty, lambda state: sent.append(state) or Empty())
    assert made.call("state_async", Empty, StringMsg(data="/my/door"))[0]
    assert [names_in(each.state) for each in sent] == [names_in(message.state)]


def test_a_useless_name_for_the_answer_is_one_sentence(
    ear: Callable[..., Ear], caplog: pytest.LogCaptureFixture
) -> None:
    made = ear(topics={})
    caplog.clear()
    for name in ("", "a b", "/nobody"):
        made.call("state_async", Empty, StringMsg(data=name))
    assert [record.levelname for record in caplog.records] == ["ERROR", "ERROR"]
    assert "state_async" in caplog.text
    made.world.step(1)


def test_other_threads_are_answered_between_steps(ear: Callable[..., Ear]) -> None:
    made = ear(topics={})
    made.world.step(1)
    answers: list[tuple[bool, Any]] = []
    asking = [threading.Thread(target=lambda: answers.append(made.call("scene/info", Scene))) for _ in range(4)]
    for thread in asking:
        thread.start()
    while any(thread.is_alive() for thread in asking):
        made.world.step(10)
    assert [ok for ok, _ in answers] == [True] * 4


def test_a_world_that_nobody_steps_fails_the_call(
    ear: Callable[..., Ear], monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.requests.Requests.call.__defaults__", (0.05,))
    made = ear(topics={})
    made.world.step(1)
    answers: list[bool] = []
    asking = threading.Thread(target=lambda: answers.append(made.call("scene/info", Scene)[0]))
    asking.start()
    asking.join(120)
    assert answers == [False]
    assert "was not stepped" in caplog.text


def test_a_paused_server_goes_on_publishing(ear: Callable[..., Ear]) -> None:
    made = ear()
    server = Server(made.world, made.node)
    made.world.step(5)
    made.clear()
    server.paused = True
    heard, stop = threading.Event(), threading.Event()
    made.node.subscribe(Pose_V, "/world/w/pose/info", lambda message: heard.set())
    running = threading.Thread(target=lambda: server.run(stop=stop))
    running.start()
    try:
        assert heard.wait(120)
    finally:
        stop.set()
        running.join(120)
    assert set(stamps(made.heard["pose/info"])) == {5_000_000}


@pytest.mark.parametrize("rate", ["0", "-5", "inf"])
@pytest.mark.parametrize("tag", ["dynamic_pose_hertz", "state_hertz"])
def test_a_rate_is_above_zero(load_text: Callable[..., World], tag: str, rate: str) -> None:
    with pytest.raises(SdfError, match=f"<{tag}> must be greater than zero"):
        load_text(BROADCASTER.format(f"<{tag}>{rate}</{tag}>"))


def test_it_belongs_into_the_world(load_text: Callable[..., World]) -> None:
    with pytest.raises(SdfError, match="belongs directly in the <world>"):
        load_text(f"<model name='m'><link name='l'/>{BROADCASTER.format('')}</model>")
