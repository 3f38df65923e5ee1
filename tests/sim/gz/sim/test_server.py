"""A world on the transport: clock after every step, statistics ten times per second, paused start, pacing, stop."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from gz_course.sim.gz.msgs.clock_pb2 import Clock
from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl
from gz_course.sim.gz.msgs.world_reset_pb2 import WorldReset
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.own_time import OwnTime


@pytest.fixture
def server(node: Node) -> Server:
    return Server(World.load("lidar_room.sdf"), node)


@pytest.fixture
def running() -> Iterator[Callable[..., threading.Event]]:
    """Run a server in a thread, which is stopped and joined after the test."""
    threads: list[tuple[threading.Thread, threading.Event]] = []

    def start(server: Server, **options: Any) -> threading.Event:
        stop = threading.Event()
        thread = threading.Thread(target=lambda: server.run(stop=stop, **options))
        thread.start()
        threads.append((thread, stop))
        return stop

    yield start
    for thread, stop in threads:
        stop.set()
        thread.join(120)
        assert not thread.is_alive()


def test_blanks_in_the_name_of_a_world_are_underscores_in_its_topics(node: Node) -> None:
    inside = "".join(
        f"<plugin filename='gz-sim-{part}-system' name='gz::sim::systems::{name}'/>"
        for part, name in (("scene-broadcaster", "SceneBroadcaster"), ("user-commands", "UserCommands"))
    )
    Server(World.from_string(f"<sdf version='1.10'><world name='my first world'>{inside}</world></sdf>"), node)
    names = {*node.topic_list(), *node.service_list()}
    stem = "/world/my_first_world"
    expected = ("clock", "stats", "control", "pose/info", "scene/info", "create", "generate_world_sdf")
    assert {f"{stem}/{each}" for each in expected} <= names
    assert all(name.startswith(f"{stem}/") for name in names if name.startswith("/world/"))


def test_clock_follows_every_step_call(server: Server, node: Node) -> None:
    root: list[int] = []
    scoped: list[int] = []
    node.subscribe(Clock, "/clock", lambda m: root.append(m.sim.sec * 10**9 + m.sim.nsec))
    node.subscribe(Clock, "/world/lidar_room/clock", lambda m: scoped.append(m.sim.sec * 10**9 + m.sim.nsec))
    server.step()
    server.step(10)
    server.step(1989)
    assert root == scoped == [1_000_000, 11_000_000, 2_000_000_000]


def test_statistics_come_every_tenth_of_a_simulated_second(server: Server, node: Node) -> None:
    heard: list[Any] = []
    node.subscribe(WorldStatistics, "/world/lidar_room/stats", heard.append)
    for _ in range(100):
        server.step(10)
    assert [message.sim_time.nsec // 1_000_000 + message.sim_time.sec * 1000 for message in heard] == list(
        range(100, 1001, 100)
    )
    last = heard[-1]
    assert (last.iterations, last.paused, last.step_size.nsec) == (1000, False, 1_000_000)
    server.step(1000)
    server.step(10)
    assert len(heard) == 11, "one long step gives one message, not ten"


def test_run_ends_after_its_iterations(server: Server) -> None:
    server.run(real_time_factor=0.0, iterations=1234)
    assert server.world.iterations == 1234


def test_run_keeps_pace_with_the_wall_clock(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a clock that moves only while the server waits, simulated time and waited time are equal."""
    now = [0]
    monkeypatch.setattr("gz_course.sim.gz.sim.server.time", OwnTime(monotonic_ns=lambda: now[0]))

    class Waits(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            assert timeout is not None
            now[0] += round(timeout * 1e9)
            return False

    server.run(real_time_factor=2.0, iterations=1000, stop=Waits())
    assert now[0] == pytest.approx(0.5e9, rel=1e-6)


def test_run_does_not_catch_up_in_a_burst(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0]
    waited = [0.0]
    monkeypatch.setattr("gz_course.sim.gz.sim.server.time", OwnTime(monotonic_ns=lambda: now[0]))
    original = server.step

    def slow_step(n: int = 1) -> None:
        original(n)
        if server.world.iterations == 500:
            now[0] += 10_000_000_000

    monkeypatch.setattr(server, "step", slow_step)

    class Waits(threading.Event):
        def wait(self, timeout: float | None = None) -> bool:
            assert timeout is not None
            now[0] += round(timeout * 1e9)
            waited[0] += timeout
            return False

    server.run(real_time_factor=1.0, iterations=1000, stop=Waits())
    assert waited[0] == pytest.approx(1.0, abs=0.02)


def test_a_request_between_the_steps_of_a_batch_counts_at_once(server: Server) -> None:
    asked: list[None] = []

    def ask() -> None:
        asked.append(None)
        if len(asked) == 3:
            server.world.requests.put(lambda: server.control.apply(request))

    server.world.systems.samples.append(ask)
    for request, run, paused in [
        (WorldControl(pause=True), 3, True),
        (WorldControl(pause=True, multi_step=5), 3, False),
        (WorldControl(pause=True, reset=WorldReset(all=True)), 0, True),
    ]:
        server.world.iterations = 0
        asked.clear()
        server._advance(10, strict=True)
        assert (server.world.iterations, server.paused) == (run, paused), request
        if not paused:
            assert server.control.steps_allowed(10) == 5, "all that were asked for are still to come"


def test_a_paused_server_does_not_step_but_keeps_telling(
    server: Server, node: Node, running: Callable[..., threading.Event]
) -> None:
    paused, resumed = threading.Event(), threading.Event()

    def on_stats(message: Any) -> None:
        (paused if message.paused and message.iterations == 0 else resumed).set()

    node.subscribe(WorldStatistics, "/stats", on_stats)
    server.paused = True
    running(server, real_time_factor=0.0)
    assert paused.wait(120)
    assert server.world.iterations == 0
    server.paused = False
    assert resumed.wait(120)


def test_the_command_of_a_thread_reaches_a_running_server(
    server: Server, node: Node, running: Callable[..., threading.Event]
) -> None:
    from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
    from gz_course.sim.gz.msgs.twist_pb2 import Twist

    moving = threading.Event()
    node.subscribe(Odometry, "/model/robot/odometry", lambda m: moving.set() if m.twist.linear.x > 0.2 else None)
    running(server, real_time_factor=0.0)
    command = Twist()
    command.linear.x = 0.3
    node.advertise("/model/robot/cmd_vel", Twist).publish(command)
    assert moving.wait(120)
