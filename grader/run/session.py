"""One run from start to recording: simulator, bridge, student and recorder put together and stepped to the end.

The simulator lives in this process on a Gazebo transport node that nobody outside can reach; the student's process
sees it only through the ROS topics of the exercise's bridge.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from grader.errors import ManifestError
from grader.exercise import Exercise
from grader.intake import Submission
from grader.record.messages import record_message
from grader.record.recorder import Recorder
from grader.run.domain import Domain
from grader.run.sandbox import LEVEL, Sandbox
from grader.run.student import Student
from grader.trial import Trial

WALL_LIMIT = 30.0  # [s] beyond twice the simulated duration; a run that takes longer has failed to be paced


@dataclass(frozen=True)
class RunResult:
    """What is known about a run and not in its recording, because it differs from machine to machine."""

    recorder: Recorder  # everything is written but the verdicts
    sandbox: str
    pace: str
    run_wall_seconds: float  # first tick to last


def versions() -> dict[str, str]:
    """Versions of what a grade depends on."""
    names = {"mujoco": "mujoco", "rclpy": "ros-jazzy-rclpy", "rerun": "rerun-sdk", "course": "gz-ros2-course"}
    return {name: version(package) for name, package in names.items()}


def record_unrunnable(exercise: Exercise, submission: Submission, trial: Trial, path: Path) -> RunResult:
    """Write the recording of a submission that cannot be started; it holds the reason and nothing else."""
    recorder = Recorder(path, exercise.robot)
    recorder.text("log/grader", submission.fault or "", "ERROR")
    _write_properties(recorder, exercise, submission, trial, {"fault": submission.fault})
    return RunResult(recorder, LEVEL, "none", 0.0)


def run(exercise: Exercise, submission: Submission, trial: Trial, pace: str, path: Path) -> RunResult:
    """Run a submission and write its recording, still open for verdicts, to `path` (`.part` until closed).

    `pace` is `lockstep` or `realtime`. Nothing is left running and no temporary file is left behind, whatever
    happens. Raises ManifestError if the exercise's own files are wrong.
    """
    from ros_gz_bridge.config import ConfigError, load_yaml

    try:
        entries = load_yaml(exercise.bridge)
    except (ConfigError, OSError) as error:
        raise ManifestError(str(error)) from None
    topics = {e.ros_topic: e.ros_type for e in entries} | exercise.observe
    with contextlib.ExitStack() as stack:
        domain = stack.enter_context(Domain())
        sandbox = Sandbox(domain.id)
        stack.callback(sandbox.close)
        student = Student(submission.file, sandbox, topics)  # first: it starts up while we do
        stack.callback(student.close)
        stack.enter_context(_environment(sandbox.grader_environment()))
        return _Session(exercise, submission, trial, pace, path, entries, domain.id, student, stack).run()


class _Session:
    """The parts of a run while it lasts."""

    def __init__(
        self,
        exercise: Exercise,
        submission: Submission,
        trial: Trial,
        pace: str,
        path: Path,
        entries: list[Any],
        domain: int,
        student: Student,
        stack: contextlib.ExitStack,
    ) -> None:
        from gz.sim.server import Server
        from gz.sim.world import World
        from gz.transport import Node, NodeOptions, Scope

        from grader.record.scene import Scene
        from grader.run.ears import Ears
        from grader.run.lockstep import LockStep, RealTime

        self.exercise, self.submission, self.trial, self.student = exercise, submission, trial, student
        self._gz_nodes = [Node(NodeOptions(scope=Scope.PROCESS, partition=f"grader-{domain}")) for _ in range(2)]
        for node in self._gz_nodes:
            stack.callback(node.close)
        self.world = World.load(exercise.world, seed=trial.seed, node=self._gz_nodes[0])
        self.server = Server(self.world, self._gz_nodes[0])
        self.ears = Ears(domain, self._gz_nodes[1], entries, exercise.observe, self._heard)
        stack.callback(self.ears.close)
        self._scans = {e.ros_topic: e.gz_topic for e in entries if e.ros_type == "sensor_msgs/msg/LaserScan"}
        self.recorder = Recorder(path, exercise.robot)
        self.scene = Scene(self.recorder, self.world)
        self.pace = (LockStep if pace == "lockstep" else RealTime)(student, self.ears)
        self._steps = round(exercise.tick * 1e9 / self.world.step_size_ns)
        self._script = [trial.vary(command) for command in exercise.script]
        self._script_publishers: dict[str, Any] = {}
        self._exit_at: float | None = None
        self._endpoints: dict[tuple[str, str, str, str], dict[str, Any]] = {}

    def run(self) -> RunResult:
        """Step to the end and return with the recording written but for the verdicts."""
        finished = False
        try:
            ready = self.pace.await_ready()
            self._collect()
            started = time.monotonic()
            end_ns = round(self.exercise.duration * 1e9)
            while self.world.sim_time_ns < end_ns:
                self._tick()
            wall = time.monotonic() - started
            self.student.stop()
            self.scene.finish()
            self._write_facts(ready)
            finished = True
        finally:
            if not finished:
                self.recorder.abandon()
        paced = self.pace.paced_ticks
        name = self.pace.name if not paced else f"{self.pace.name}, {paced} ticks paced to the wall clock"
        return RunResult(self.recorder, LEVEL, name, wall)

    def _tick(self) -> None:
        while self._script and self._script[0].at * 1e9 <= self.world.sim_time_ns:
            self._command(self._script.pop(0))
        self.server.step(self._steps)
        now = self.world.sim_time_ns
        self.recorder.set_time(now)
        self.scene.tick()
        for topic, publisher, message in self.ears.take_held():
            if topic != "/clock":
                self._record(topic, message)
            self.pace.deliver(topic, publisher, message, now)
            self._collect()
        self.pace.close_tick(self.exercise.tick)
        self._collect()

    def _command(self, command: Any) -> None:
        from gz.msgs.twist_pb2 import Twist

        publisher = self._script_publishers.get(command.topic)
        if publisher is None:
            publisher = self._script_publishers[command.topic] = self._gz_nodes[1].advertise(command.topic, Twist)
        twist = Twist()
        twist.linear.x, twist.angular.z = command.linear_x, command.angular_z
        publisher.publish(twist)

    def _heard(self, topic: str, message: Any) -> None:
        self._record(topic, message)

    def _record(self, topic: str, message: Any) -> None:
        record_message(self.recorder, topic, message)
        if topic in self._scans:
            self.scene.scan(self._scans[topic], message)

    def _collect(self) -> None:
        """Take over what the student's process said and did since the last call."""
        for line in self.student.take_lines():
            self.recorder.text("log/student", line, _level(line))
        progress = self.student.progress
        if progress is not None:
            for e in progress.endpoints:
                self._endpoints.setdefault((e.kind, e.topic, e.type, e.node), asdict(e) | {"matched": None})
        if not self.student.running and self._exit_at is None:
            self._exit_at = self.world.sim_time_ns / 1e9
            self.recorder.text("log/grader", f"the node's process ended with exit code {self.student.exit_code}")

    def _write_facts(self, ready: bool) -> None:
        dropped = self.ears.dropped()
        for topic, count in dropped.items():
            self.recorder.text("log/grader", f"{count} commands on {topic} were not finite and were dropped", "WARN")
        facts = {
            "sim_seconds": self.world.sim_time_ns / 1e9,
            "ready": ready,
            "exit_at": self._exit_at,
            "exit_code": self.student.exit_code if self._exit_at is not None else None,
            "endpoints": [self._endpoints[key] for key in sorted(self._endpoints)],
            "offered": {e: self.ears.publishes(e) for e in sorted(self.ears._out)},
            "listened": {e: self.ears.listens(e) for e in sorted(self.ears._in)},
            "dropped": dropped,
            "lines_dropped": self.student.dropped_lines,
            "out_of_step": bool(self.pace.paced_ticks),
        }
        _write_properties(self.recorder, self.exercise, self.submission, self.trial, facts)


def _write_properties(
    recorder: Any, exercise: Exercise, submission: Submission, trial: Trial, facts: dict[str, Any]
) -> None:
    recorder.properties(
        "run",
        exercise=exercise.name,
        submission=submission.file.name,
        submission_sha256=submission.sha256,
        manifest_sha256=hashlib.sha256((exercise.folder / "exercise.toml").read_bytes()).hexdigest(),
        seed=trial.seed,
        duration=exercise.duration,
        robot=exercise.robot,
        facts=json.dumps(facts, sort_keys=True),
    )
    recorder.properties("versions", **versions())


def _level(line: str) -> str:
    for level, word in (("ERROR", "[ERROR]"), ("CRITICAL", "[FATAL]"), ("WARN", "[WARN]"), ("DEBUG", "[DEBUG]")):
        if line.startswith(word):
            return level
    return "INFO"


@contextlib.contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    """Set environment variables for as long as a run lasts; DDS reads them when its context is made."""
    before = {key: os.environ.get(key) for key in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for key, value in before.items():
            if value is None:
                os.environ.pop(key, None)
            else:
                os.environ[key] = value
