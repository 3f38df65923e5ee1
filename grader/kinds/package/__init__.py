"""`kind = "package"`: the submission is a node with its own package of interfaces (`.msg`, `.srv`, `.action`).

`file` is the node, `files` are those of the package, such as `patrol_interfaces/package.xml`. The package is built in
the sandbox, never in the grader's process. The exercise's own node, `given_node.py`, runs beside the student's in the
same sandbox and imports the student's interfaces. It publishes on the topics of `observe` what it has got, and prints
`ready` once its publishers exist. It is complete before anything of the submission runs, and nobody else may publish
on these topics. The `parameters` of a trial are two tables: `server` has parameters of the student's node, `client` is
the first argument of `given_node.py`, as JSON.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.kinds.given_node import EXERCISE_NODE, exercise_node
from gz_course.grader.kinds.kind import Kind, RunPlan
from gz_course.grader.kinds.node import fault
from gz_course.grader.kinds.node import plan as node_plan

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.exercise.trial import Trial
    from gz_course.grader.record.reading import Recording
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis
    from gz_course.grader.submission import Submission

APART = ".exercise"  # folder of the exercise's node: no file of a submission has such a name


def plan(exercise: Exercise, submission: Submission) -> RunPlan:
    """Run the student's node beside the exercise's bridge and the exercise's own node."""
    found = node_plan(exercise, submission)
    given = {f"{APART}/{name}": content for name, content in exercise_node(exercise).items()}
    facts = found.facts | {"given_topics": sorted(exercise.observe)}
    return RunPlan(found.program, found.files | given, found.entries, facts)


def command(program: Path, trial: Trial) -> list[str]:
    """Build the packages, then start both nodes, with the parameters of the trial."""
    given = {side: dict(trial.parameters.get(side, {})) for side in ("server", "client")}
    words = [str(program), str(program.parent / APART / EXERCISE_NODE), json.dumps(given)]
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
        outcome,
        (
            looks.tampered,
            forged,
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
        ),
        (looks.slips, survived, looks.whole_number_fault, lost_number),
    )


def outcome(recording: Recording) -> str:
    """Return `tamper` if somebody has published for the exercise's node, else the class of a node's run."""
    from gz_course.grader.score.diagnosis import outcome_of

    return "tamper" if forged(recording, recording.facts()) else outcome_of(recording)


def forged(recording: Recording, facts: dict[str, Any]) -> str:
    """Name a topic of the exercise's node on which somebody else has published as well."""
    for topic in facts.get("forged", []):
        return f"Your node publishes on {topic}, which belongs to the exercise's own node: nobody else may publish."
    return ""


def misdirected(recording: Recording, facts: dict[str, Any]) -> str:
    """Name the topic to which the student's node publishes in vain, or from which it hears nothing."""
    from gz_course.grader.score.diagnosis import publishers, subscriptions

    given = facts.get("given_topics", [])  # of the exercise's own node
    listened = {topic: kind for topic, kind in facts.get("listened", {}).items() if topic not in given}
    offered = facts.get("offered", {}).items() - {("/clock", "rosgraph_msgs/msg/Clock")}
    ends = facts.get("endpoints", [])
    kept = facts.get("kept", [])
    hears = any(
        (e["topic"], e["type"]) in offered
        for e in ends
        if e["kind"] == "subscription" and (e.get("durability") != "TRANSIENT_LOCAL" or e["topic"] in kept)
    )
    said = publishers(recording, facts | {"listened": listened}) if given else ""
    return said or ("" if hears or not given or not offered else subscriptions(recording, facts))


def build_fault(recording: Recording, facts: dict[str, Any]) -> str:
    """Return the first fault that `colcon build` finds in the package."""
    from gz_course.grader.run.agent.course_agent.run_package import BUILD_FAILED, FAULT

    if facts.get("exit_code") != BUILD_FAILED:
        return ""
    lines = (line.text for line in recording.lines("log/student"))
    first = next((line.removeprefix(FAULT) for line in lines if line.startswith(FAULT)), "")
    return f"Your package cannot be built: {first}{'' if first.endswith(('.', '?')) else '.'}" if first else ""


KIND = Kind((".py",), fault, plan, command, run_loop, diagnosis, environment)
