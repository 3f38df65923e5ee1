"""`kind = "package"`: the submission is a node with its own package of interfaces (`.msg`, `.srv`, `.action`).

`file` is the node, `files` are those of the package, such as `patrol_interfaces/package.xml`. The package is built in
the sandbox, never in the grader's process. The exercise's own node, `given_node.py`, runs beside the student's in a
sandbox of its own, where the same package is built for it; the two have nothing in common but ROS. It takes its orders
and reports what it has got as `agent/course_agent/exercise_node.py` says, and the reports are facts of the recording
(`REPORTS`). It is complete before anything of the submission runs. The `parameters` of a trial are two tables: `server`
has parameters of the student's node, `client` are the orders.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.kinds.given_node import APART, exercise_node
from gz_course.grader.kinds.kind import Kind, RunPlan
from gz_course.grader.kinds.node import fault
from gz_course.grader.kinds.node import plan as node_plan
from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.exercise.trial import Trial
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis
    from gz_course.grader.submission import Submission


def plan(exercise: Exercise, submission: Submission) -> RunPlan:
    """Run the student's node beside the exercise's bridge and the exercise's own node."""
    found = node_plan(exercise, submission)
    given = {f"{APART}/{name}": content for name, content in exercise_node(exercise).items()}
    packages = {name: content for name, content in found.files.items() if "/" in name}
    return RunPlan(found.program, found.files, found.entries, found.read, beside=packages | given)


def command(program: Path, trial: Trial) -> list[str]:
    """Build the packages, then start the student's node with its parameters."""
    words = [str(program), json.dumps(dict(trial.parameters.get("server", {})))]
    return [sys.executable, "-P", "-m", "course_agent.run_package", *words]


def environment(pace: str) -> dict[str, str]:
    """In lock-step, let both nodes hold what they send from the beginning."""
    from gz_course.grader.run.agent.course_agent.executor_monitor import HOLD

    return {HOLD: "1"} if pace == "lockstep" else {}


def run_loop() -> type[RunLoop]:
    """Import the class that simulates such a run, which needs rclpy and MuJoCo."""
    from gz_course.grader.kinds.package.package_run_loop import PackageRunLoop

    return PackageRunLoop


def diagnosis() -> Diagnosis:
    """Explain runs by the package first, then by the student's node."""
    from gz_course.grader.feedback.errors.action_errors import execute_raised
    from gz_course.grader.score import diagnosis as looks
    from gz_course.grader.score.crash import survived
    from gz_course.grader.score.lost_numbers import lost_number

    return looks.Diagnosis(
        looks.outcome_of,
        (
            looks.tampered,
            looks.cannot_run,
            looks.broke_a_limit,
            build_fault,
            looks.slip,
            looks.died,
            looks.ended_early,
            execute_raised,
            looks.never_spun,
            looks.out_of_time,
            misdirected,
            looks.unstable,
            nobody_asks,
        ),
        (looks.slips, survived, looks.whole_number_fault, lost_number),
    )


def misdirected(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the topic to which the student's node publishes in vain, or from which it hears nothing."""
    from gz_course.grader.score.topic_faults import publishers, subscriptions

    offered = facts.get("offered", {}).items() - {("/clock", "rosgraph_msgs/msg/Clock")}
    ends = facts.get("endpoints", [])
    kept = facts.get("kept", [])
    hears = any(
        (e["topic"], e["type"]) in offered
        for e in ends
        if e["kind"] == "subscription" and (e.get("durability") != "TRANSIENT_LOCAL" or e["topic"] in kept)
    )
    return publishers(recording, facts) or ("" if hears or not offered else subscriptions(recording, facts))


def nobody_asks(recording: Recording, facts: dict[str, Any]) -> str:
    """Return that the exercise's own node ended before the run did, and its last words."""
    from gz_course.grader.record.reading import PRINTED

    code = facts.get("exercise_node_ended")
    if code is None:
        return ""
    last = next((line.text for line in reversed(recording.lines(PRINTED)) if line.text.strip()), "")
    return (
        f"The exercise's own node ended (exit code {code}){f': {shown(last.strip(), 200)}' if last else ''}. From then "
        "on nobody asked your node for anything."
    )


def build_fault(recording: Recording, facts: dict[str, Any]) -> str:
    """Return the first fault that `colcon build` finds in the package."""
    from gz_course.grader.run.agent.course_agent.run_package import BUILD_FAILED, FAULT

    if facts.get("exit_code") != BUILD_FAILED:
        return ""
    lines = (line.text for line in recording.lines("log/student"))
    first = next((line.removeprefix(FAULT) for line in lines if line.startswith(FAULT)), "")
    return f"Your package cannot be built: {first}{'' if first.endswith(('.', '?')) else '.'}" if first else ""


KIND = Kind((".py",), fault, plan, command, run_loop, diagnosis, environment)
