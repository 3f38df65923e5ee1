"""The loop of a run: simulator, bridge, the submission's processes and recorder, stepped together to the end.

The simulator lives in this process on a Gazebo transport node that nobody outside can reach; the student's process
sees it only through the ROS topics of the exercise's bridge.
"""

from __future__ import annotations

import time
from collections import Counter
from contextlib import ExitStack
from dataclasses import asdict
from typing import Any

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import ScriptedCommand, Trial
from gz_course.grader.kinds.kind import RunPlan
from gz_course.grader.record.messages import record_message
from gz_course.grader.record.reading import STUDENT_LOG
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import Scene
from gz_course.grader.run.compatibility import check_compatibility
from gz_course.grader.run.grader_endpoints import GraderEndpoints
from gz_course.grader.run.pace.lockstep import LockStep
from gz_course.grader.run.pace.real_time import RealTime
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.supervision import Heartbeat
from gz_course.grader.run.trial_world import load_trial_world
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

MOST_MESSAGES = 20_000  # of one topic that are recorded; the rest is counted
# A run may take 2 x its simulated time + 10 s of wall time. Then it is ended if the student's processes took half of
# that time; else it is the machine that is busy, and the run may take 20 times as long before it is given up.
WALL_FACTOR, WALL_GRACE = 2.0, 10.0
STUDENTS_SHARE, MACHINES_FACTOR = 0.5, 20.0
LOOK_AGAIN = 1.0  # [s] between two looks at whose time it is
LEVELS = {"[WARN]": "WARN", "[ERROR]": "ERROR", "[FATAL]": "CRITICAL", "[DEBUG]": "DEBUG"}


class RunLoop:
    """Everything set up for one run of `processes`; `run` runs it. `stack` closes what was opened here."""

    log = STUDENT_LOG  # where the lines of the program go

    def __init__(
        self,
        exercise: Exercise,
        trial: Trial,
        plan: RunPlan,
        domain: int,
        processes: SubmissionProcesses,
        pace: str,
        stack: ExitStack,
    ) -> None:
        check_compatibility()
        self._exercise = exercise
        self._trial = trial
        self._stack = stack
        self._processes = processes
        partition = f"grader-{domain}"
        self._gz_nodes = [Node(NodeOptions(scope=Scope.PROCESS, partition=partition)) for _ in range(2)]
        for node in self._gz_nodes:
            stack.callback(node.close)
        self._world: World | None = None
        self._begin(plan, domain)
        self._ros = GraderEndpoints(domain, self._gz_nodes[1], plan.entries, exercise.observe, self._record)
        stack.callback(self._ros.close)
        self._pace = self._paced(pace)
        self._scans = {e.ros_topic: e.gz_topic for e in plan.entries if e.ros_type == "sensor_msgs/msg/LaserScan"}
        self._script = [trial.vary(command) for command in exercise.script]
        self._script_publishers: dict[str, Any] = {}
        self._exit_at: float | None = None
        self._unstable: str | None = None
        self._out_of_time = False
        self._look_at = 0.0  # of the wall clock [s]: when to ask whose fault a slow run is
        self._tampered = False  # it publishes what only the simulator may: nothing that follows would count
        self._endpoints: dict[tuple[str, str, str, str], dict[str, Any]] = {}
        self._layout: tuple[int, ...] = ()
        self._messages: Counter[str] = Counter()
        self.heartbeat = Heartbeat()
        self.wall_seconds = 0.0

    def _begin(self, plan: RunPlan, domain: int) -> None:
        """Set up what must be there before the submission's first message is read."""
        self._open(load_trial_world(self._exercise, self._trial, self._gz_nodes[0]))

    def _open(self, world: World) -> None:
        """Take the world that is to be simulated."""
        self._stack.callback(world.close)
        self._world = world
        self._server = Server(world, self._gz_nodes[0])
        self._steps = round(self._exercise.tick * 1e9 / world.step_size_ns)

    def _paced(self, pace: str) -> RealTime:
        return (LockStep if pace == "lockstep" else RealTime)(self._processes, self._ros)

    @property
    def _now_ns(self) -> int:
        return self._world.sim_time_ns if self._world is not None else 0

    @property
    def pace_name(self) -> str:
        """How simulated time went on: in lock-step, in real time, or partly fallen back to the wall clock."""
        paced = self._pace.paced_ticks
        return self._pace.name + (f", {paced} ticks paced to the wall clock" if paced else "")

    def run(self, recorder: Recorder) -> dict[str, Any]:
        """Run to the exercise's end, recording everything; return the facts about the run."""
        self._recorder = recorder
        assert self._world is not None
        self._scene = Scene(recorder, self._world)
        ready = self._pace.await_ready()
        self._collect()
        started = time.monotonic()
        end_ns = round(self._exercise.duration * 1e9)
        self._look_at = started + self._wall_limit
        while self._now_ns < end_ns and not (self._unstable or self._out_of_time or self._tampered):
            self._tick()
            self._watch_wall(started)
        self.wall_seconds = time.monotonic() - started
        more = self._last_look()
        self._processes.stop()
        self._scene.finish()
        return self._facts(ready and self._processes.spun) | more

    @property
    def _wall_limit(self) -> float:
        """Wall time [s] that a run may take on a machine that is not busy."""
        return WALL_FACTOR * self._exercise.duration + WALL_GRACE

    def _watch_wall(self, started: float) -> None:
        """End a run that takes too long because of the student; look at most every `LOOK_AGAIN` seconds."""
        if (now := time.monotonic()) > self._look_at:
            self._out_of_time = self._student_is_slow(now - started)
            self._look_at = now + LOOK_AGAIN

    def _student_is_slow(self, wall: float) -> bool:
        """Return whether the processes are why a run takes long. Raises InfrastructureError if the machine is."""
        share = STUDENTS_SHARE * self._wall_limit
        if self._pace.held_seconds > share or self._processes.cpu_seconds() > share:
            return True
        if wall > MACHINES_FACTOR * self._wall_limit:
            raise InfrastructureError(
                f"this machine is too busy: {self._now_ns / 1e9:.2f} s of simulated time took {wall:.0f} s; grade again"
            )
        return False

    def _tick(self) -> None:
        """Live through one tick: simulated time goes on only when everybody has dealt with all that it brought."""
        self._pace.welcome()  # processes that have come meanwhile start up
        while self._script and self._script[0].at * 1e9 <= self._now_ns:
            self._command(self._script.pop(0))
        try:
            self._server.step(self._steps)
        except SimError as error:  # a command so wild that physics has no answer: the run ends here
            self._unstable = str(error)
            self._recorder.text("log/grader", str(error), "ERROR")
            return
        self.heartbeat.at(self._now_ns)
        self._recorder.set_time(self._now_ns)
        self._deliver(self._now_ns)
        self._pace.close_tick(self._exercise.tick)  # who is not in step gets a tick of wall time
        self._collect()

    def _deliver(self, now: int) -> None:
        """Send what the simulator has published, one message at a time: /clock first, then by topic name."""
        self._pace.wake_sleepers(now)
        messages = self._ros.take_held()
        if not messages:  # no bridge takes anything to ROS, not even /clock: still the world is on record
            self._scene.tick()
            self._processes.wait(0)
        for number, (topic, publisher, message) in enumerate(messages):
            self._pace.send(topic, publisher, message, now)
            if number == 0:
                self._scene.tick()  # the truth is recorded while the student's processes are at work
            if topic != "/clock":
                self._record(topic, message)
            self._pace.settle()  # taken by all, all idle, and all they published has arrived
            self._collect()

    def _command(self, command: ScriptedCommand) -> None:
        publisher = self._script_publishers.get(command.topic)
        if publisher is None:
            publisher = self._script_publishers[command.topic] = self._gz_nodes[1].advertise(command.topic, Twist)
        twist = Twist()
        twist.linear.x, twist.angular.z = command.linear_x, command.angular_z
        publisher.publish(twist)

    def _record(self, topic: str, message: Any) -> None:
        self._messages[topic] += 1
        if self._messages[topic] > MOST_MESSAGES:
            return
        record_message(self._recorder, topic, message)
        if topic in self._scans:
            self._scene.scan(self._scans[topic], message)

    def _collect(self) -> None:
        """Take over what the submission's processes said and did since the last call."""
        for line in self._processes.take_lines():
            self._take(line)
        if self._processes.layout != self._layout:
            self._layout = self._processes.layout
            for e in self._processes.endpoints:
                self._tampered |= self._is_reserved(e)
                # Whether it had matched yet when it was first seen differs between equal runs.
                self._endpoints.setdefault((e.kind, e.topic, e.type, e.node), asdict(e) | {"matched": None})
        if not self._processes.running and self._exit_at is None:
            self._exit_at = self._now_ns / 1e9
            code = self._processes.exit_code
            self._recorder.text("log/grader", f"the node's process ended with exit code {code}")

    def _last_look(self) -> dict[str, Any]:
        """Return more facts about the run, before its processes are ended."""
        return {}

    def _is_reserved(self, endpoint: Endpoint) -> bool:
        """Whether an endpoint of the submission publishes what only the simulator may."""
        return endpoint.kind == "publisher" and endpoint.topic in self._ros.offered

    def _take(self, line: str) -> None:
        """Record a line that the program wrote."""
        level = LEVELS.get(line.partition(" ")[0], "INFO")
        self._recorder.text(self.log, line, level)

    def _facts(self, ready: bool) -> dict[str, Any]:
        """Return what scoring and diagnosis need to know beside the signals; the same for equal runs."""
        dropped = self._ros.dropped()
        for topic, count in dropped.items():
            text = f"{count} commands on {topic} were not finite and were dropped"
            self._recorder.text("log/grader", text, "WARN")
        return {
            "sim_seconds": self._now_ns / 1e9,
            "ready": ready,
            "exit_at": self._exit_at,
            "exit_code": self._processes.exit_code if self._exit_at is not None else None,
            "endpoints": [self._endpoints[key] for key in sorted(self._endpoints)],
            "offered": self._ros.offered,
            "listened": self._ros.listened,
            "dropped": dropped,
            "too_early": self._pace.too_early(),
            "lines_dropped": self._processes.dropped_lines,
            "messages_not_recorded": {t: n - MOST_MESSAGES for t, n in self._messages.items() if n > MOST_MESSAGES},
            "hid": self._processes.hid,
            "limit": self._processes.limit,
            "unstable": self._unstable,
            "out_of_time": self._out_of_time and self._now_ns < round(self._exercise.duration * 1e9),
            "out_of_step": bool(self._pace.paced_ticks),
        }
