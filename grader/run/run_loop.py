"""The loop of a run: simulator, bridge, the submission's processes and recorder, stepped together to the end.

The simulator lives in this process on a Gazebo transport node that nobody outside can reach; the student's process
sees it only through the ROS topics of the exercise's bridge.
"""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterable
from contextlib import ExitStack
from typing import Any

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import Entry, ScriptedCall, ScriptedCommand, ScriptedParameter, Trial
from gz_course.grader.kinds.kind import RunPlan
from gz_course.grader.record.messages import record_message
from gz_course.grader.record.reading import STUDENT_LOG
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import Scene
from gz_course.grader.run.call_script import CallScript
from gz_course.grader.run.compatibility import check_compatibility
from gz_course.grader.run.console_log import ConsoleLog
from gz_course.grader.run.endpoint_facts import EndpointFacts
from gz_course.grader.run.fair_clock import Patience
from gz_course.grader.run.grader_endpoints import GraderEndpoints, ros_twist
from gz_course.grader.run.limits import MACHINES_FACTOR, time_limit
from gz_course.grader.run.pace.lockstep import LockStep
from gz_course.grader.run.pace.real_time import LOOK_ROUND, MATCHING, PATIENCE, RealTime
from gz_course.grader.run.parameter_script import ParameterScript, record_parameter
from gz_course.grader.run.processes.progress import Endpoint
from gz_course.grader.run.processes.submission_log import LONGEST_LINE, SHOWN_FOLDER
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.supervision import Heartbeat
from gz_course.grader.run.trial_world import load_trial_world
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

MOST_MESSAGES = 20_000  # of one topic that are recorded; the rest is counted
LOOK_AGAIN = 1.0  # [s] of wall time between two looks at that
LEVELS = {"[WARN]": "WARN", "[ERROR]": "ERROR", "[FATAL]": "CRITICAL", "[DEBUG]": "DEBUG"}


class RunLoop:
    """Everything set up for one run of `processes`; `run` runs it. `stack` closes what was opened here."""

    log = STUDENT_LOG  # where the lines of the program go
    watches = True  # whether it is noted who else publishes what only the simulator may

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
        # of the simulator, of the bridge, and of the script, whose topics a bridge may publish, too
        self._gz_nodes = [Node(NodeOptions(scope=Scope.PROCESS, partition=partition)) for _ in range(3)]
        for node in self._gz_nodes:
            stack.callback(node.close)
        self._world: World | None = None
        self._begin(plan, domain)
        self._console = ConsoleLog(processes.log.folder, LONGEST_LINE, SHOWN_FOLDER.decode())
        self._ros = GraderEndpoints(
            domain,
            self._gz_nodes[1],
            plan.entries,
            exercise.observe,
            self._record,
            self._console.message,
            self.watches,
            plan.parameters,
        )
        self._kept = plan.kept
        stack.callback(self._ros.close)
        self._pace = self._paced(pace)
        self._see_scans(plan.entries)
        self._script = [trial.vary(entry) if isinstance(entry, ScriptedCommand) else entry for entry in exercise.script]
        self._parameters = ParameterScript(self._ros, self._pace, self._script)
        self._calls = CallScript(self._ros, self._pace, self._script)
        self._script_publishers: dict[str, Any] = {}
        self._exit_at: float | None = None
        self._unstable: str | None = None
        self._out_of_time = False
        self._tampered = False  # it publishes what only the simulator may: nothing that follows would count
        self._suspected: set[str] = set()  # topics of the simulator on which it says that it publishes
        self._endpoints = EndpointFacts(self._ros.discovery, lambda topic: self._ros.reliable(topic))
        self._graph_facts: dict[str, Any] = {}
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
        for name, value in self._trial.parameters.items():
            record_parameter(recorder, name, value)
        ready = self._pace.await_ready()
        self._collect()
        end_ns = round(self._exercise.duration * 1e9)
        self._begin_to_watch()
        while self._now_ns < end_ns and not (self._unstable or self._out_of_time or self._tampered):
            self._tick()
            self._watch()
        self.wall_seconds = time.monotonic() - self._started
        self._look_at_graph()
        more = self._last_look() | {"stopped": self._processes.stopped}
        self._processes.stop()
        self._scene.finish()
        return self._facts(ready and self._processes.spun) | more

    @property
    def _time_limit(self) -> float:
        """Time [s] that a run may take."""
        return time_limit(self._exercise.duration)

    def _begin_to_watch(self) -> None:
        self._started = time.monotonic()
        self._look_at = self._started + LOOK_AGAIN
        self._own_before, self._clock_before = time.process_time(), self._processes.clock.now()

    def _watch(self) -> None:
        """End a run that sends without end or takes too long; look at the time at most every `LOOK_AGAIN` seconds."""
        self._out_of_time |= self._pace.flooded
        if (now := time.monotonic()) > self._look_at:
            own = time.process_time() - self._own_before
            waited = self._processes.clock.now() - self._clock_before - own
            self._out_of_time |= self._is_slow(max(waited, self._pace.held_up))
            self._give_up_after(now - self._started, own)
            self._look_at = now + LOOK_AGAIN

    def _is_slow(self, waited: float) -> bool:
        """Return whether the processes take too long: `waited` [s] is for how long they were waited for."""
        return waited > self._time_limit or self._processes.cpu_seconds() > self._time_limit

    def _give_up_after(self, wall: float, own: float) -> None:
        """Raise InfrastructureError if a run got hardly any processor time; `own` [s] is the grader's share."""
        spent = own + self._processes.cpu_seconds()
        if wall > MACHINES_FACTOR * self._time_limit and spent < self._time_limit:
            raise InfrastructureError(
                f"this machine is too busy: {self._now_ns / 1e9:.2f} s of simulated time took {wall:.0f} s; grade again"
            )

    def _tick(self) -> None:
        """Live through one tick: simulated time goes on only when everybody has dealt with all that it brought."""
        self._pace.welcome()  # processes that have come meanwhile start up
        while self._script and self._script[0].at * 1e9 <= self._now_ns:
            self._follow(self._script.pop(0))
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
            self._pace.settle()
        for number, (topic, publisher, message) in enumerate(messages):
            self._pace.send(topic, publisher, message, now)
            if number == 0:
                self._scene.tick()  # the truth is recorded while the student's processes are at work
            if topic != "/clock":
                self._record(topic, message)
            self._pace.settle()  # taken by all, all idle, and all they published has arrived
            self._collect()

    def _follow(self, entry: Entry) -> None:
        """Do what an entry of the script says."""
        if isinstance(entry, ScriptedParameter):
            self._parameters.set(entry, self._recorder)
        elif isinstance(entry, ScriptedCall):
            self._calls.call(entry, self._recorder)
        else:
            self._command(entry)

    def _see_scans(self, entries: Iterable[BridgeEntry]) -> None:
        """Take the scans that these bridges carry to ROS for what the lidars of the scene see."""
        scans = "sensor_msgs/msg/LaserScan"
        self._scans = {e.ros_topic: e.gz_topic for e in entries if e.ros_type == scans and e.direction.to_ros}

    def _command(self, command: ScriptedCommand) -> None:
        """Send and record a command of the script: `script/TOPIC/linear_x`, and whether anything took it."""
        taken = True
        if command.ros:
            taken = self._ros.bridge.take(command.topic, ros_twist(command.linear_x, command.angular_z))
        else:
            publisher = self._script_publishers.get(command.topic)
            if publisher is None:
                publisher = self._script_publishers[command.topic] = self._gz_nodes[2].advertise(command.topic, Twist)
            twist = Twist()
            twist.linear.x, twist.angular.z = command.linear_x, command.angular_z
            publisher.publish(twist)
        base = f"script/{command.topic.strip('/')}"
        for name, value in (("linear_x", command.linear_x), ("angular_z", command.angular_z), ("taken", taken)):
            self._recorder.scalar(f"{base}/{name}", float(value))

    def _record(self, topic: str, message: Any) -> None:
        self._messages[topic] += 1
        if self._messages[topic] > MOST_MESSAGES:
            return
        record_message(self._recorder, topic, message)
        if topic in self._scans:
            self._scene.scan(self._scans[topic], message)

    def _collect(self) -> None:
        """Take over what the submission's processes said and did since the last call."""
        for line in self._processes.log.take_lines():
            self._take(line)
        self._endpoints.look()
        if self._processes.layout != self._layout:
            self._layout = self._processes.layout
            self._endpoints.report(self._processes.endpoints)
            for e in self._processes.endpoints:
                if self._is_reserved(e) and e.topic not in self._suspected:
                    self._suspected.add(e.topic)
                    self._tampered |= self._is_published(e.topic)
        if not self._processes.running and self._exit_at is None:
            self._exit_at = self._now_ns / 1e9
            code = self._processes.exit_code
            self._recorder.text("log/grader", f"the node's process ended with exit code {code}")

    def _is_published(self, topic: str) -> bool:
        """Wait until DDS shows what a process reports, that others publish on a topic; False if it does not."""
        patience = Patience(self._processes.clock, MATCHING)
        while not (published := self._ros.discovery.publishers_seen(topic)) and not patience.over():
            if not self._processes.wait(LOOK_ROUND):
                self._ros.pump()
        return published

    def _look_at_graph(self) -> None:
        """Ask DDS, before the processes are ended, what they are in the ROS graph."""
        patience = Patience(self._processes.clock, PATIENCE)
        while self._processes.running and not self._pace.everything_arrived() and not patience.over():
            self._processes.wait(LOOK_ROUND)
        self._collect()
        self._ros.take_logs()
        self._endpoints.close(self._processes.endpoints, self._processes.clock, self._ros.look_again)
        discovery, not_logged = self._ros.discovery, self._console.not_logged()
        self._graph_facts = {
            "endpoints": self._endpoints.as_facts(),
            "reserved": sorted(t for t in self._ros.offered if self.watches and discovery.publishers_seen(t)),
            "nodes": discovery.nodes(),
            "not_logged": not_logged,
            "rosout_off": sorted(set(discovery.nodes()) - set(discovery.loggers())) if not_logged else [],
        }

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
        self._console.line(line)

    def _facts(self, ready: bool) -> dict[str, Any]:
        """Return what scoring and diagnosis need to know beside the signals; the same for equal runs."""
        dropped = self._ros.dropped()
        for topic, count in dropped.items():
            text = f"{count} commands on {topic} were not finite and were dropped"
            self._recorder.text("log/grader", text, "WARN")
        return {
            "sim_seconds": self._now_ns / 1e9,
            "ready": ready,
            **({"never_at_rest": True} if not ready and self._processes.spun else {}),
            "exit_at": self._exit_at,
            "exit_code": self._processes.exit_code if self._exit_at is not None else None,
            **self._graph_facts,
            "offered": self._ros.offered,
            "offered_best_effort": [t for t in self._ros.offered if t != "/clock" and not self._ros.reliable(t)],
            "listened": self._ros.listened,
            **({"kept": sorted(self._kept)} if self._kept else {}),
            "dropped": dropped,
            "too_early": self._pace.too_early(),
            "lines_dropped": self._processes.log.dropped_lines,
            "messages_not_recorded": {t: n - MOST_MESSAGES for t, n in self._messages.items() if n > MOST_MESSAGES},
            "hid": self._processes.hid,
            "limit": self._processes.limit,
            "unstable": self._unstable,
            "out_of_time": self._out_of_time and self._now_ns < round(self._exercise.duration * 1e9),
            "flooded": self._pace.flooded,
            "out_of_step": bool(self._pace.paced_ticks),
            **({"parameters_set": self._parameters.facts} if self._parameters.facts else {}),
            **({"services_called": self._calls.facts} if self._calls.facts else {}),
        }
