"""The services of a server: control with all its fields, the world as SDF, names, paths, stop; also while paused."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from google.protobuf import text_format

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.gui_pb2 import GUI
from gz_course.sim.gz.msgs.log_playback_control_pb2 import LogPlaybackControl
from gz_course.sim.gz.msgs.sdf_generator_config_pb2 import SdfGeneratorConfig
from gz_course.sim.gz.msgs.server_control_pb2 import ServerControl
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V
from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl
from gz_course.sim.gz.msgs.world_control_state_pb2 import WorldControlState
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

DEADLINE = 120


def nanoseconds(time: Any) -> int:
    return time.sec * 10**9 + time.nsec


class Running:
    """A server that runs in its own thread, and its statistics."""

    def __init__(self, world: World, node: Node) -> None:
        self.world = world
        self.server = Server(world, node)
        self._node = node
        self._stop = threading.Event()
        self._changed = threading.Condition()
        self._last: Any = None
        node.subscribe(WorldStatistics, "/stats", self._take)
        self.thread = threading.Thread(target=self._run)
        self.error: BaseException | None = None

    def _run(self) -> None:
        try:
            self.server.run(real_time_factor=0.0, stop=self._stop)
        except BaseException as error:
            self.error = error

    def _take(self, message: Any) -> None:
        with self._changed:
            self._last = message
            self._changed.notify_all()

    def wait(self, condition: Callable[[Any], bool]) -> Any:
        with self._changed:
            self._last = None
            assert self._changed.wait_for(lambda: self._last is not None and condition(self._last), DEADLINE)
            return self._last

    def control(self, text: str) -> bool:
        request = text_format.Parse(text, WorldControl())
        service = f"/world/{self.world.name}/control"
        executed, answer = self._node.request(service, request, WorldControl, Boolean, 20_000)
        assert executed
        return bool(answer.data)

    def end(self) -> None:
        self._stop.set()
        if self.thread.is_alive():
            self.thread.join(DEADLINE)
        assert not self.thread.is_alive() and self.error is None
        self.world.close()


@pytest.fixture
def running(node: Node) -> Iterator[Running]:
    made = Running(World.load("lidar_room.sdf"), node)
    made.server.paused = True
    made.thread.start()
    yield made
    made.end()


def test_pause_step_and_run_to(running: Running) -> None:
    assert running.control("pause: true, multi_step: 37")
    assert running.wait(lambda m: m.paused and m.iterations == 37)
    assert running.control("pause: true, step: true")
    assert running.wait(lambda m: m.paused and m.iterations == 38)
    assert running.control("pause: false, run_to_sim_time: {nsec: 61000000}")
    assert running.wait(lambda m: m.paused and m.iterations == 61)
    assert running.control("pause: false, multi_step: 3")
    assert running.wait(lambda m: not m.paused and m.iterations > 200), "steps count only for a paused world"
    assert running.control("pause: true")
    assert running.wait(lambda m: m.paused)
    stood = running.world.iterations
    assert running.control("pause: true")
    assert running.world.iterations == stood


def test_reset_rewinds_and_says_itself_whether_it_pauses(running: Running) -> None:
    running.control("pause: true, multi_step: 100")
    running.wait(lambda m: m.paused and m.iterations == 100)
    assert running.control("pause: true, reset: {all: true}")
    again = running.wait(lambda m: m.paused and m.iterations == 0)
    begun = nanoseconds(again.pause_time)
    later = running.wait(lambda m: nanoseconds(m.pause_time) > begun + 50_000_000)
    assert nanoseconds(later.real_time) == 0, "real time stands still in a pause"
    running.control("pause: true, multi_step: 50")
    running.wait(lambda m: m.paused and m.iterations == 50)
    assert running.control("reset: {time_only: true}, multi_step: 0"), "as ros_gz does it: pause is false, so it runs"
    assert running.wait(lambda m: not m.paused and m.iterations > 0)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("pause: true, seed: 4", "gz sim --seed"),
        ("pause: true, reset: {model_only: true}", "models only is not supported"),
        ("pause: true, run_to_sim_time: {nsec: 1000000}", "not ahead of the present time"),
    ],
)
def test_what_control_cannot_do_is_said(
    running: Running, caplog: pytest.LogCaptureFixture, text: str, sentence: str
) -> None:
    caplog.set_level(logging.WARNING, "gz.sim")
    running.control("pause: true, multi_step: 5")
    running.wait(lambda m: m.paused and m.iterations == 5)
    assert running.control(text) is ("run_to" not in text)
    assert sentence in caplog.text
    assert running.world.iterations == 5


def test_control_state(running: Running, node: Node, caplog: pytest.LogCaptureFixture) -> None:
    request = text_format.Parse("world_control {pause: true, multi_step: 4}", WorldControlState())
    assert node.request("/world/lidar_room/control/state", request, WorldControlState, Boolean, 20_000)[1].data
    assert running.wait(lambda m: m.iterations == 4)
    request.state.entities.add().id = 7
    assert not node.request("/world/lidar_room/control/state", request, WorldControlState, Boolean, 20_000)[1].data
    assert "cannot be set here" in caplog.text


def test_a_paused_world_takes_in_models_at_once(running: Running, node: Node) -> None:
    from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory

    request = EntityFactory(sdf="<sdf version='1.10'><model name='box'><link name='l'/></model></sdf>")
    service = "/world/lidar_room/create/blocking"
    if service not in node.service_list():
        pytest.skip("lidar_room.sdf does not load UserCommands")
    assert node.request(service, request, EntityFactory, Boolean, 20_000)[1].data
    assert "box" in running.world.truth.model_names() and running.world.iterations == 0


def test_unstable_physics_pauses_a_running_server_which_goes_on_serving(
    running: Running, caplog: pytest.LogCaptureFixture
) -> None:
    running.world.requests.call(lambda: running.world.data.qvel.__setitem__(0, float("nan")))
    running.control("pause: false")
    assert running.wait(lambda m: m.paused)
    errors = [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR]
    assert len(errors) == 1 and "body 'robot::base_link'" in errors[0] and "is paused" in errors[0]
    assert running.control("pause: true, reset: {all: true}")
    running.control("pause: true, multi_step: 10")
    assert running.wait(lambda m: m.paused and m.iterations == 10)


def test_unstable_physics_ends_a_run_of_so_many_steps(node: Node) -> None:
    from gz_course.sim.gz.sim.errors import SimError

    world = World.load("lidar_room.sdf")
    server = Server(world, node)
    world.data.qvel[0] = float("nan")
    with pytest.raises(SimError, match="unstable"):
        server.run(real_time_factor=0.0, iterations=100)
    world.close()


def test_names_and_stop(running: Running, node: Node) -> None:
    assert list(node.request("/gazebo/worlds", None, Empty, StringMsg_V, 20_000)[1].data) == ["lidar_room"]
    assert node.request("/gazebo/starting_world", None, Empty, StringMsg, 20_000)[1].data == "lidar_room"
    assert not node.request("/server_control", ServerControl(clone=True), ServerControl, Boolean, 20_000)[1].data
    assert running.thread.is_alive()
    assert node.request("/server_control", ServerControl(stop=True), ServerControl, Boolean, 20_000)[1].data
    running.thread.join(DEADLINE)
    assert not running.thread.is_alive()


def test_resource_paths(running: Running, node: Node, tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", "/one")
    node.request("/gazebo/resource_paths/add", StringMsg_V(data=[str(tmp_path), "/one"]), StringMsg_V, Empty, 20_000)
    got = node.request("/gazebo/resource_paths/get", None, Empty, StringMsg_V, 20_000)[1]
    assert list(got.data) == ["/one", str(tmp_path)]
    folder = tmp_path / "chair"
    folder.mkdir()
    (folder / "model.sdf").write_text("<sdf version='1.9'/>")
    asked = StringMsg(data="model://chair")
    assert node.request("/gazebo/resource_paths/resolve", asked, StringMsg, StringMsg, 20_000)[1].data == str(folder)
    asked.data = "model://char"
    assert not node.request("/gazebo/resource_paths/resolve", asked, StringMsg, StringMsg, 20_000)[0]


def test_requests_beside_a_running_world_are_all_answered(running: Running, node: Node) -> None:
    running.control("pause: false")
    answers: list[bool] = []

    def hammer() -> None:
        for _ in range(30):
            config = SdfGeneratorConfig()
            answers.append(
                node.request("/world/lidar_room/generate_world_sdf", config, SdfGeneratorConfig, StringMsg, 20_000)[0]
            )

    threads = [threading.Thread(target=hammer) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(DEADLINE)
    assert answers == [True] * 90


def test_added_resource_paths_are_told(node: Node, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", "/models")
    told: list[Any] = []
    world = World.from_string("<sdf version='1.9'><world name='w'/></sdf>")
    Server(world, node)
    node.subscribe(StringMsg_V, "/gazebo/resource_paths", told.append)
    node.request("/gazebo/resource_paths/add", StringMsg_V(data=[str(tmp_path)]), StringMsg_V, Empty, 20_000)
    assert [list(each.data) for each in told] == [["/models", str(tmp_path)]]
    world.close()


def test_the_gui_of_the_world_and_playback_that_is_none(node: Node, caplog: pytest.LogCaptureFixture) -> None:
    world = World.from_string(
        "<sdf version='1.9'><world name='w'><gui fullscreen='1'><plugin name='3D View' filename='MinimalScene'>"
        "<ambient_light>0.4 0.4 0.4</ambient_light></plugin></gui></world></sdf>"
    )
    server = Server(world, node)
    done, gui = node.request("/world/w/gui/info", None, Empty, GUI, 20_000)
    assert done and gui.fullscreen
    (plugin,) = gui.plugin
    assert (plugin.name, plugin.filename) == ("3D View", "MinimalScene")
    assert plugin.innerxml == "<ambient_light>0.4 0.4 0.4</ambient_light>"

    def playback(**request: Any) -> Any:
        message = LogPlaybackControl(**request)
        return node.request("/world/w/playback/control", message, LogPlaybackControl, Boolean, 20_000)

    assert playback(pause=True) == (True, Boolean(data=True))
    assert server.paused
    assert playback(rewind=True) == (True, Boolean(data=False))
    assert "rewind is for the playback of a recording" in caplog.text
    world.close()
