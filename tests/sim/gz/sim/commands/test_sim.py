"""`gz sim` as a process: it runs a world, accepts commands from another process, and ends cleanly."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import urllib.request
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, ClassVar

import psutil
import pytest

from gz_course.sim.gz.msgs.clock_pb2 import Clock
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.transport import Node
from gz_course.tests.warm_process import WarmPopen

GZ = [sys.executable, "-c", "import sys; from gz_course.sim.gz.command import main; sys.exit(main())", "sim"]
DEADLINE = 120
SERVED = r"gz sim: world '{}' is served in partition '\w+'; gz sim -g shows it\n"


@pytest.fixture(autouse=True)
def partition(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    monkeypatch.setenv("GZ_PARTITION", uuid.uuid4().hex)


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start `gz sim` in a process group of its own, which is ended with the test."""
    started: list[subprocess.Popen[str]] = []

    def run(*arguments: str) -> subprocess.Popen[str]:
        process = WarmPopen(
            [*GZ, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env=os.environ.copy(),
        )
        started.append(process)
        return process

    yield run
    for process in started:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate(timeout=DEADLINE)


class Heard:
    """Counts the messages of one topic and waits for a message that fulfils a condition."""

    def __init__(self, node: Node, kind: type, topic: str) -> None:
        self._changed = threading.Condition()
        self._messages: list[Any] = []
        node.subscribe(kind, topic, self._take)

    def _take(self, message: Any) -> None:
        with self._changed:
            self._messages.append(message)
            self._changed.notify_all()

    def wait(self, condition: Callable[[Any], bool]) -> Any:
        with self._changed:
            assert self._changed.wait_for(lambda: any(map(condition, self._messages)), DEADLINE)
            return next(filter(condition, self._messages))


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_running_world_obeys_another_process_and_ends_with_zero(
    start: Callable[..., subprocess.Popen[str]], number: signal.Signals
) -> None:
    with Node() as node:
        clock = Heard(node, Clock, "/clock")
        odometry = Heard(node, Odometry, "/model/robot/odometry")
        scans = Heard(node, LaserScan, "/lidar/scan")
        process = start("lidar_room.sdf", "-r", "-s")
        first = clock.wait(lambda message: True)
        clock.wait(lambda message: message.sim.sec > first.sim.sec)
        assert len(scans.wait(lambda message: True).ranges) == 360
        publisher = node.advertise("/model/robot/cmd_vel", Twist)
        assert publisher.wait_for_subscribers(1, DEADLINE)
        command = Twist()
        command.linear.x = 0.4
        publisher.publish(command)
        odometry.wait(lambda message: message.pose.position.x > 0.2)
        children = psutil.Process(process.pid).children(recursive=True)
        process.send_signal(number)
        out, err = process.communicate(timeout=DEADLINE)
    assert (process.returncode, out) == (0, "")
    assert re.fullmatch(SERVED.format("lidar_room"), err)
    assert children == []


def test_a_world_starts_paused_unless_told_to_run(start: Callable[..., subprocess.Popen[str]]) -> None:
    with Node() as node:
        stats = Heard(node, WorldStatistics, "/stats")
        process = start("empty.sdf", "-s")
        message = stats.wait(lambda message: True)
        assert message.paused and message.iterations == 0
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 0
    assert "paused; start it with -r" in err


def run_to_end(start: Callable[..., subprocess.Popen[str]], *arguments: str) -> tuple[int, str]:
    process = start(*arguments)
    out, err = process.communicate(timeout=DEADLINE)
    err = re.sub(SERVED.format(r"\w+"), "", err)
    assert out == "" and err.count("\n") <= 1, "one sentence, no traceback"
    return process.returncode, err


def test_iterations_end_by_themselves(start: Callable[..., subprocess.Popen[str]]) -> None:
    arguments = ["--iterations", "100", "-z", "100000", "--levels"]
    told = "[Wrn] --levels changes nothing here\n"
    assert run_to_end(start, "empty.sdf", "-r", "-s", *arguments) == (0, told)


def test_errors_are_one_sentence(start: Callable[..., subprocess.Popen[str]], tmp_path: Path) -> None:
    broken = tmp_path / "broken.sdf"
    broken.write_text("<sdf version='1.9'>\n<world name='w'>\n</sdf>")
    code, err = run_to_end(start, "-r", str(broken))
    assert code == 1 and err.startswith(f"gz sim: {broken}:3: this is not well-formed XML")
    code, err = run_to_end(start, "-r", "lidar_rom.sdf")
    assert code == 1 and "did you mean 'lidar_room.sdf'" in err
    code, err = run_to_end(start, "-r", "empty.sdf", "--render-engine", "raycats")
    assert code == 1 and "did you mean 'raycast'" in err


@pytest.mark.parametrize(
    ("arguments", "code", "sentence"),
    [
        (["--iteratons", "5", "empty.sdf"], 109, "did you mean '--iterations'?"),
        (["--iterations", "-5", "empty.sdf"], 104, "zero or more"),
        (
            ["--iterations", "some", "empty.sdf"],
            104,
            "expected a whole number, zero or more, at most 1e9, but found 'some'",
        ),
        (["--seed", "1.5", "empty.sdf"], 104, "expected a whole number, but found '1.5'"),
        (["-z", "fast", "empty.sdf"], 104, "expected a number, zero or more, at most 1e9, but found 'fast'"),
        (["empty.sdf", "other.sdf"], 109, "'other.sdf' belongs to no option"),
        (["-g", "empty.sdf"], 2, "-g shows a world that runs already"),
        (["empty.sdf", "--playback", "log"], 2, "it takes neither a file nor --record"),
        (["--playback", "log", "--record"], 2, "it takes neither a file nor --record"),
        (["--initial-sim-time", "-3", "empty.sdf"], 104, "zero or more"),
        (["--initial-sim-time"], 114, "--initial-sim-time"),
        (["--record-pth", "x", "empty.sdf"], 109, "did you mean '--record-path'?"),
        (["-s"], 2, "which world"),
    ],
)
def test_wrong_usage_is_one_line_and_a_code(
    arguments: list[str], code: int, sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    from gz_course.sim.gz.command import main

    try:
        result = main(["sim", *arguments])
    except SystemExit as stopped:
        result = stopped.code
    out, error = capsys.readouterr()
    assert (result, out, error.count("\n")) == (code, "", 1)
    assert error.startswith("gz sim: ") and sentence in error


@pytest.mark.parametrize("option", ["--version", "--versions"])
def test_the_version_is_one_line(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    from gz_course.sim.gz.command import main

    with pytest.raises(SystemExit) as stopped:
        main(["sim", option])
    assert not stopped.value.code and capsys.readouterr().out.count(".") == 2


def test_warnings_have_a_place_and_verbosity_hides_them(
    start: Callable[..., subprocess.Popen[str]], tmp_path: Path
) -> None:
    world = tmp_path / "w.sdf"
    world.write_text("<sdf version='1.9'><world name='w'>\n<modle name='m'/></world></sdf>")
    code, err = run_to_end(start, "-r", "-s", str(world), "--iterations", "1")
    assert code == 0 and err.startswith(f"[Wrn] {world}:2: ") and "did you mean 'model'" in err
    assert run_to_end(start, "-r", "-s", "-v", "0", str(world), "--iterations", "1") == (0, "")


def test_time_starts_where_it_is_told_and_recordings_are_readable(
    start: Callable[..., subprocess.Popen[str]], tmp_path: Path
) -> None:
    from gz_course.sim.gz.sim.tlog import Log

    folder = tmp_path / "log"
    arguments = ["--initial-sim-time", "100", "--iterations", "300", "-z", "100000", "--record-path", str(folder)]
    assert run_to_end(start, "empty.sdf", "-r", "-s", *arguments) == (0, "")
    with Log(folder) as log:
        summary = {each.topic: each for each in log.topics()}
    poses = summary["/world/empty/pose/info"]
    assert poses.count > 10 and 100.0e9 < poses.first_ns <= poses.last_ns <= 100.3e9


def test_strict_refuses_what_would_be_warned_about(start: Callable[..., subprocess.Popen[str]], tmp_path: Path) -> None:
    world = tmp_path / "w.sdf"
    world.write_text("<sdf version='1.9'><world name='w'>\n<modle name='m'/></world></sdf>")
    process = start("-r", "--strict", str(world), "--iterations", "1")
    _, err = process.communicate(timeout=DEADLINE)
    assert process.returncode == 1 and "strict loading refuses" in err and "did you mean 'model'" in err


def test_a_paused_world_serves_another_process(start: Callable[..., subprocess.Popen[str]]) -> None:
    """Like `ros_gz_sim create` and `gz service`: create, read the scene, run, stop the server."""
    from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
    from gz_course.sim.gz.msgs.empty_pb2 import Empty
    from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
    from gz_course.sim.gz.msgs.entity_pb2 import Entity
    from gz_course.sim.gz.msgs.sdf_generator_config_pb2 import SdfGeneratorConfig
    from gz_course.sim.gz.msgs.server_control_pb2 import ServerControl
    from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
    from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V

    process = start("empty.sdf", "-s", "-v", "0")
    wait = DEADLINE * 1000
    with Node() as node:
        assert list(node.request("/gazebo/worlds", None, Empty, StringMsg_V, wait)[1].data) == ["empty"]
        text = "<sdf version='1.10'><model name='box'><pose>0 0 4 0 0 0</pose><link name='l'/></model></sdf>"
        request = EntityFactory(sdf=text)
        assert node.request("/world/empty/create/blocking", request, EntityFactory, Boolean, wait)[1].data
        answer = node.request(
            "/world/empty/generate_world_sdf", SdfGeneratorConfig(), SdfGeneratorConfig, StringMsg, wait
        )
        assert '<pose rotation_format="quat_xyzw">0 0 4 ' in answer[1].data
        gone = Entity(name="box", type=Entity.MODEL)
        assert node.request("/world/empty/remove/blocking", gone, Entity, Boolean, wait)[1].data
        assert not node.request("/world/empty/remove/blocking", gone, Entity, Boolean, wait)[1].data
        assert node.request("/server_control", ServerControl(stop=True), ServerControl, Boolean, wait)[1].data
    assert process.wait(DEADLINE) == 0


def test_a_second_simulator_that_tells_another_time_says_so(start: Callable[..., subprocess.Popen[str]]) -> None:
    with Node() as node:
        clock = Heard(node, Clock, "/clock")
        first = start("empty.sdf", "-r", "-s")
        clock.wait(lambda message: True)
        second = start("empty.sdf", "-r", "-s")
        assert second.stderr is not None
        assert re.fullmatch(SERVED.format("empty"), second.stderr.readline())
        line = second.stderr.readline()
    assert "another simulator publishes /clock" in line and "GZ_PARTITION" in line
    for process in (first, second):
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE) == 0


def test_a_fault_of_ours_is_one_sentence_and_code_three(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    from gz_course.sim.gz.command import main
    from gz_course.sim.gz.sim.world import World

    monkeypatch.setattr(World, "step", lambda *_: [][1])
    assert main(["sim", "-r", "-s", "-v", "0", "empty.sdf"]) == 3
    err = capsys.readouterr().err
    assert err.startswith("gz sim: the simulator itself failed (IndexError") and err.count("\n") == 1


class FakeView:
    """Stands for `gz_course.sim.gz.view.View`: an address comes at once, or none."""

    made: ClassVar[list[FakeView]] = []

    def __init__(self, world: str = "", *, on_ready: Any, on_end: Any, **options: Any) -> None:
        self.world, self.options = world, options
        self.address, self.error = "http://127.0.0.1:1/token/", ""
        self.closed = self.opened = False
        FakeView.made = [self]
        if options["bind"] == "127.0.0.1":
            on_ready(self)
        else:
            self.address, self.error = "", "MuJoCo Studio is not here"
        if self.error or "search" in options:
            on_end(self)

    def open_browser(self) -> None:
        self.opened = True

    def __enter__(self) -> FakeView:
        return self

    def __exit__(self, *_: object) -> None:
        self.closed = True


def test_a_view_opens_beside_the_simulator_and_ends_with_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    import gz_course.sim.gz.view
    from gz_course.sim.gz.command import main

    monkeypatch.setattr(gz_course.sim.gz.view, "View", FakeView)
    run = ["sim", "-r", "--iterations", "3", "-z", "100000", "empty.sdf"]
    assert main([*run, "--http-port", "8123"]) == 0
    assert capsys.readouterr().err == "gz sim: see world 'empty' at http://127.0.0.1:1/token/\n"
    (view,) = FakeView.made
    assert (view.world, view.options) == ("empty", {"bind": "127.0.0.1", "port": 8123})
    assert view.opened and view.closed

    assert main([*run, "--bind", "192.0.2.1"]) == 0, "the simulator runs on"
    err = capsys.readouterr().err
    assert err.startswith("gz sim: there is no view (MuJoCo Studio is not here); the simulator runs on")
    assert FakeView.made[0].options["bind"] == "192.0.2.1"

    assert main(["sim", "-g"]) == 0
    assert capsys.readouterr().err == "gz sim: see the running world at http://127.0.0.1:1/token/\n"
    assert FakeView.made[0].options["search"] and FakeView.made[0].closed
    assert main(["sim", "-g", "--bind", "192.0.2.1"]) == 1
    assert capsys.readouterr().err == "gz sim: there is no view: MuJoCo Studio is not here\n"

    FakeView.made = []
    assert main(["sim", "-s", "-r", "--iterations", "3", "empty.sdf"]) == 0
    assert re.fullmatch(SERVED.format("empty"), capsys.readouterr().err)
    assert FakeView.made == []


def test_without_a_world_one_is_chosen_in_the_browser(start: Callable[..., subprocess.Popen[str]]) -> None:
    process = start("-r", "--iterations", "5")
    assert process.stderr is not None
    said = process.stderr.readline()
    assert said.startswith("gz sim: choose a world at http://127.0.0.1:")
    with urllib.request.urlopen(said.split()[-1] + "start", b"world=empty.sdf", timeout=600) as answer:
        assert "The world empty.sdf is being loaded" in answer.read().decode()
    assert process.wait(600) == 0
