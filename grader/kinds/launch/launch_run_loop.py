"""A run whose submission is a launch file: it starts simulator, bridge and nodes itself, and they are judged.

Like `RunLoop`, but there is no world before the submission asks for one, no bridge before it starts one, and in the end
the launch is interrupted as by Ctrl-C and everything must go. The programs it starts are in `simulated_programs.py`.
"""

from __future__ import annotations

import re
import signal
import time
from pathlib import Path
from typing import Any

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.kinds.kind import RunPlan
from gz_course.grader.kinds.launch.simulated_programs import SimulatedPrograms
from gz_course.grader.record.recorder import Recorder
from gz_course.grader.record.scene import Scene
from gz_course.grader.run.fair_clock import Patience
from gz_course.grader.run.limits import time_limit
from gz_course.grader.run.pace.lockstep import LockStep
from gz_course.grader.run.pace.real_time import RealTime
from gz_course.grader.run.run_loop import RunLoop

SIMULATOR_PATIENCE = 5.0  # [s], once nobody is starting up, for a simulator to be started
BEATS = 10  # how often a paused world tells its time, in a run
END_PATIENCE = 13.0  # [s] after Ctrl-C; launch itself escalates after 5 s and after 10 s
MASKED = (  # what differs between equal runs
    (re.compile(r"pid \[?\d+\]?"), "pid [...]"),
    (re.compile(r"(log files can be found below ).*"), r"\1..."),
    (re.compile(r", cmd '.*"), "]."),
    (re.compile(r"launch_params_\w+"), "launch_params_..."),
)
LABEL = re.compile(r"^(?:\[[A-Z]+\] )?\[(.+?)\]")
ESCALATED = re.compile(r"\[ERROR\] \[(.+?)\]: process\[.* '([\d.]+)' seconds after .*escalating to 'SIGTERM'")
FAIR_SHARE = 0.7  # of the time a program was given to end: if it had less, others have used the processor
FAILED = re.compile(r"^\[ERROR\] \[launch\]: (?:Caught exception in launch \(see debug for traceback\): )?(.*)")


class LaunchRunLoop(RunLoop):
    """Everything set up for one run of a launch file."""

    watches = False

    def _begin(self, plan: RunPlan, domain: int) -> None:
        shown = Path(self._processes.log.folder)
        self._programs = SimulatedPrograms(
            plan.files.keys(), shown, self._trial.seed, self._gz_nodes[0], self._open, lambda: self._ros
        )
        self._processes.asked = self._programs.asked
        self._lines: list[str] = []
        self._interrupted_at: float | None = None  # by the clock that the timers of the launch follow

    def _paced(self, pace: str) -> RealTime:
        if pace == "lockstep":
            return LockStep(self._processes, self._ros, holding=True)
        return RealTime(self._processes, self._ros)

    def run(self, recorder: Recorder) -> dict[str, Any]:
        """Run until the exercise's time is over, interrupt the launch, record everything; return the facts."""
        self._recorder = recorder
        self._programs.building = self.heartbeat.submitted
        self._gather()
        self._programs.over = True
        if self._world is not None:
            self._scene = Scene(recorder, self._world)
        started = time.monotonic()
        if self._world is not None and self._programs.simulator is not None:
            self._run()
        self.wall_seconds = time.monotonic() - started
        self._look_at_graph()
        facts = self._facts(True) | {"offered": {}, "listened": {}, "bridges": self._ros.bridged()}
        facts["launch"] = self._state() | self._end()
        if self._world is not None:
            self._scene.finish()
        self._record_lines()
        return facts

    def _gather(self) -> None:
        """Wait until whatever the launch starts is there: the simulator above all."""
        self._pace.await_ready()
        patience = Patience(self._processes.clock, SIMULATOR_PATIENCE)
        while self._processes.running and self._programs.simulator is None and not patience.over():
            self._processes.wait(0.05)
            self._ros.pump()
            if self._programs.loading:
                patience = Patience(self._processes.clock, SIMULATOR_PATIENCE)
            elif self._pace.somebody_starts:
                self._pace.await_ready()
                patience = Patience(self._processes.clock, SIMULATOR_PATIENCE)
        if self._processes.running:
            self._pace.await_ready()
            self._pace.settle()  # whoever is still at work may end, and others start
            self._pace.await_ready()
        self._collect()

    def _run(self) -> None:
        assert self._world is not None
        duration_ns = round(self._exercise.duration * 1e9)
        self._begin_to_watch()
        beats = 0
        while (simulator := self._programs.simulator) is not None and not (self._unstable or self._out_of_time):
            if simulator.paused:
                self._pace.welcome()
                self._server.step(0)
                self._deliver(self._now_ns)
                self._collect()
                beats += 1
                if beats == BEATS:
                    return
            elif self._now_ns < duration_ns:
                self._see_scans(self._programs.entries)
                self._tick()
            else:
                return
            if simulator.iterations and self._world.iterations >= simulator.iterations:
                simulator.who.tell({"end": True})
                simulator.running = False
            self._watch()

    @property
    def _time_limit(self) -> float:
        """More than for one node: several processes come up."""
        return time_limit(self._exercise.duration, launched=True)

    def _state(self) -> dict[str, Any]:
        """Return the facts about what runs at the end, before the launch gets Ctrl-C."""
        simulator = self._programs.simulator
        return self._programs.facts() | {
            "running": self._processes.running,
            "simulator_at_end": simulator.world if simulator else "",
            "bridges_at_end": sum(not (b.stopped or b.who.gone or b.errors) for b in self._programs.bridges),
            "ended_early": self._ended(),
            "by_python": self._by_python(),
        }

    def _by_python(self) -> list[str]:
        """Programs that no action of the launch has started, but the launch file's own Python: `subprocess`, say.

        What an action starts gets a process group of its own, and is started by code of the course.
        """
        programs = self._processes.participants  # the launch itself comes first
        by_itself = self._processes.started_by_submission
        return sorted({p.program for p in programs[1:] if p.group == programs[0].group or by_itself(p)})

    def _ended(self) -> list[dict[str, Any]]:
        """Programs that have ended, with their exit codes."""
        return sorted(self._processes.ended_programs(), key=lambda each: (each["program"], each["code"]))

    def _end(self) -> dict[str, Any]:
        """Interrupt the launch as Ctrl-C does, and look at what becomes of it."""
        was_running = self._processes.running
        self._interrupted_at = self._processes.clock_but_mine.now()
        seen = len(self._lines)
        for each in self._processes.participants:
            each.tell({"free": True, "real": True})
        out_of_reach = self._out_of_reach()  # a launch may have ended before the first look at what it leaves
        if was_running:
            self._processes.signal(signal.SIGINT)
        patience = Patience(self._processes.clock, END_PATIENCE)
        while self._processes.running and not patience.over():
            found = self._out_of_reach()
            if any(each.alive for each in self._processes.participants[:1]):
                out_of_reach = found  # when the launch ends, so does the sandbox, with all that is left
            self._processes.wait(0.02)
            self._pace.everything_arrived()
            self._ros.pump()
            self._collect()
        self._collect()
        ended_itself = not self._processes.running
        left = [s.argument for s in self._programs.simulators if s.running and not s.stopped]
        left += [b.node for b in self._programs.bridges if not (b.stopped or b.errors)]
        if ended_itself and not left:
            left = out_of_reach
        self._processes.stop()
        self._collect()
        lines, self._lines[seen:] = self._lines[seen:], []
        return {
            "exit_code": self._processes.exit_code if ended_itself else None,
            "ended_itself": ended_itself,
            "escalated": sorted({match.group(1) for line in lines if (match := ESCALATED.match(line))}),
            "left": sorted(left),
            "error": next((match.group(1) for line in self._lines if (match := FAILED.match(line))), ""),
        }

    def _out_of_reach(self) -> list[str]:
        """Return the running programs that the launch file's own Python has put out of the reach of Ctrl-C.

        A terminal sends SIGINT to the process group of the launch; what an action starts gets it from the launch.
        """
        programs = self._processes.participants  # the launch itself comes first
        detached = (p for p in programs[1:] if p.alive and p.group != programs[0].group)
        return sorted({p.program for p in detached if self._processes.started_by_submission(p)})

    def _take(self, line: str) -> None:
        """Keep a line. Raises InfrastructureError if the launch had no time to end on a busy machine."""
        if self._interrupted_at is not None and (match := ESCALATED.match(line)):
            had = self._processes.clock_but_mine.now() - self._interrupted_at
            if had < FAIR_SHARE * float(match.group(2)):
                raise InfrastructureError(
                    f"this machine is too busy: {match.group(1)} could use {had:.1f} of the {match.group(2)} s it is "
                    "given after Ctrl-C; grade again"
                )
        for pattern, text in MASKED:
            line = pattern.sub(text, line)
        self._lines.append(line)

    def _record_lines(self) -> None:
        """Put the log into the recording process by process: when exactly a line comes through is no fact."""

        def label(line: str) -> str:
            match = LABEL.match(line)
            return match.group(1) if match else "launch"

        for line in sorted(self._lines, key=lambda line: (not label(line).startswith("launch"), label(line))):
            self._recorder.text("log/student", line, "ERROR" if line.startswith("[ERROR]") else "INFO")
