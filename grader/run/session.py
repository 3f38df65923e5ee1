"""One run from start to recording: reserves a domain, starts the student's process, runs the loop, cleans up.

The student's process is started before anything heavy is imported here, so that both start up at the same time.
"""

from __future__ import annotations

import contextlib
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import Exercise
from gz_course.grader.exercise.trial import Trial
from gz_course.grader.kinds.given_node import APART, EXERCISE_NODE
from gz_course.grader.kinds.kind import RunPlan, find_kind
from gz_course.grader.printable import shown
from gz_course.grader.process.many_imports import many_imports
from gz_course.grader.process.temporary_folder import sweep
from gz_course.grader.run.agent.course_agent.endpoint_description import KEPT
from gz_course.grader.run.agent.course_agent.executor_monitor import RELIABLE, SIMULATED_CLOCKS, TOPICS
from gz_course.grader.run.agent.course_agent.import_hooks import leave_out_generator
from gz_course.grader.run.domain import Domain
from gz_course.grader.run.processes.exercise_process import ExerciseProcess
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.sandbox import AUTO, Sandbox
from gz_course.grader.run.sandbox.environment import in_force
from gz_course.grader.run.supervision import Heartbeat
from gz_course.grader.submission import Submission
from gz_course.grader.submission.untouched import untouched
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import reliable

if TYPE_CHECKING:
    from gz_course.grader.record.recorder import Recorder


# What the files of a submission say, by all that this depends on: the same in each trial. One submission is kept.
_SAID: dict[tuple[str, float, frozenset[tuple[str, bytes]], bool], dict[str, Any]] = {}


@dataclass(frozen=True)
class RunResult:
    """A recording with everything in it but the verdicts, and what differs from machine to machine."""

    recorder: Recorder
    sandbox: str
    pace: str
    run_wall_seconds: float  # first tick to last


def record_unrunnable(
    exercise: Exercise, submission: Submission, trial: Trial, path: Path, outcome: str = "student_error"
) -> RunResult:
    """Write the recording of a submission that cannot be started or finished; it holds the reason and nothing else."""
    from gz_course.grader.record.recorder import Recorder
    from gz_course.grader.run.properties import write_properties

    recorder = Recorder(path, exercise.robot)
    recorder.text("log/grader", submission.fault or "", "ERROR")
    write_properties(recorder, exercise, submission, trial, {"fault": submission.fault, "outcome": outcome})
    return RunResult(recorder, "none", "none", 0.0)


def run(
    exercise: Exercise,
    submission: Submission,
    trial: Trial,
    pace: str,
    path: Path,
    level: str = AUTO,
    heartbeat: Heartbeat | None = None,
) -> RunResult:
    """Run a submission and write its recording, still open for verdicts, to `path` (`.part` until closed).

    `pace` is `lockstep` or `realtime`, `level` that of the sandbox. Nothing is left running and no temporary file is
    left behind, whatever happens. `heartbeat` is told how far the run has come. Raises ManifestError if the exercise's
    own files are wrong.
    """
    sweep()  # what graders left that were killed
    kind = find_kind(exercise.kind)
    plan = kind.plan(exercise, submission)
    topics = {
        "publisher": {e.ros_topic: e.ros_type for e in plan.entries if e.direction.to_gz} | exercise.observe,
        "subscription": {e.ros_topic: e.ros_type for e in plan.entries if e.direction.to_ros},
        RELIABLE: {e.ros_topic: e.ros_type for e in plan.entries if e.direction.to_ros and reliable(e.qos_profile)},
        KEPT: plan.kept,
    }
    with contextlib.ExitStack() as stack:
        domain = stack.enter_context(Domain())
        sandbox = Sandbox(domain.id, level)
        stack.callback(sandbox.close)
        folder = sandbox.put_files(plan.files)
        command, variables = kind.command(folder / plan.program, trial), kind.environment(pace)
        if pace == "lockstep":
            variables = variables | {SIMULATED_CLOCKS: str(exercise.real_time_factor)}
        beside = None
        if plan.beside:
            other = Sandbox(domain.id, beside=sandbox)
            stack.callback(other.close)
            program, orders = f"{APART}/{EXERCISE_NODE}", trial.parameters.get("client", {})
            beside = ExerciseProcess(plan.beside, program, orders, other, variables | {TOPICS: json.dumps(topics)})
            stack.callback(beside.close)
        processes = SubmissionProcesses(command, sandbox, topics, variables, shown=str(folder), beside=beside)
        stack.callback(processes.close)
        stack.enter_context(in_force(sandbox.grader_environment()))
        read = _read(plan, exercise, submission)

        with many_imports():
            leave_out_generator()
            from gz_course.grader.record.recorder import Recorder
            from gz_course.grader.run.properties import write_properties
            from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeError

            make_loop = kind.run_loop()
        try:
            loop = make_loop(exercise, trial, plan, domain.id, processes, pace, stack)
        except BridgeError as error:
            if not kind.brings_bridge:
                raise ManifestError(f"{exercise.manifest}: {error.errors[0]}") from None
            return record_unrunnable(exercise, replace(submission, fault=shown(error.errors[0])), trial, path)
        loop.heartbeat = heartbeat or loop.heartbeat
        with Recorder.begun(path, exercise.robot) as recorder:
            facts = loop.run(recorder)
            begin = untouched(exercise, submission.main, submission.files)
            more = {"untouched": begin} if begin else {}
            write_properties(recorder, exercise, submission, trial, read | facts | more)
        return RunResult(recorder, sandbox.level, loop.pace_name, loop.wall_seconds)


def _read(plan: RunPlan, exercise: Exercise, submission: Submission) -> dict[str, Any]:
    """Return what the files of a submission say; they are read once for all its trials."""
    key = (exercise.name, exercise.duration, frozenset(submission.files.items()), submission.explained)
    if key not in _SAID:
        _SAID.clear()
        _SAID[key] = plan.facts
    return _SAID[key]
