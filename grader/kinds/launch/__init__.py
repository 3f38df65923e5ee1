"""`kind = "launch"`: the submission is a launch file, in Python, XML or YAML, that starts simulator, bridge and nodes.

It is started with `ros2 launch`, in the folder that also holds what comes with the exercise (every file beside the
student's, and of the folder `worlds`). The `parameters` of a trial are its arguments:
`parameters = { paused = "true" }` is `paused:=true`.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.exercise.grading import README
from gz_course.grader.feedback.facts.origins import before_speeds, conditions
from gz_course.grader.feedback.facts.own_ends import own_ends
from gz_course.grader.feedback.launch_files import launch_places
from gz_course.grader.feedback.rules import as_facts, faults_kept
from gz_course.grader.feedback.slips import slips
from gz_course.grader.feedback.suspects import suspects
from gz_course.grader.kinds.bridge import read
from gz_course.grader.kinds.kind import Kind, RunPlan
from gz_course.grader.kinds.node import fault
from gz_course.grader.kinds.programs import launch_command
from gz_course.grader.printable import shown

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.exercise.trial import Trial
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis
    from gz_course.grader.submission import Submission


LOST = ("is given twice", "a second document begins here", "is not a Gazebo topic name")
WORLDS = "worlds"  # folder of worlds beside the launch file
_MARKUP = (".xml", ".yaml", ".yml")


def fault_of(name: str, content: bytes) -> str | None:
    """Return why a file in Python can never run, or None. XML and YAML are read in the box only."""
    return None if name.endswith(_MARKUP) else fault(name, content)


def plan(exercise: Exercise, submission: Submission) -> RunPlan:
    """Run the launch file, with what comes with the exercise beside it; record suspicious places as facts."""
    own = (*exercise.parts, README)
    beside = [path for path in exercise.folder.iterdir() if path.is_file() and path.name not in own]
    beside += [path for path in exercise.folder.glob(f"{WORLDS}/*") if path.is_file()]
    given = {path.relative_to(exercise.folder).as_posix(): path.read_bytes() for path in beside}

    def read() -> dict[str, Any]:
        with faults_kept() as faults:
            places = _places(submission, exercise.duration) if submission.explained else {}
        return places | as_facts(faults)

    return RunPlan(submission.main, submission.files | given, read=read)


def _places(submission: Submission, duration: float) -> dict[str, list[dict[str, Any]]]:
    """Return what the linters find, by kind, with the name of the file."""
    found: dict[str, list[dict[str, Any]]] = {}
    for name, content in submission.files.items():
        if name.endswith(".py"):
            places = (
                launch_places(content, submission.files)
                if name == submission.main
                else {
                    "slips": slips(content, duration),
                    "suspects": suspects(content),
                    "before_speeds": before_speeds(content),
                    "conditions": conditions(content),
                    "own_ends": own_ends(content),
                }
            )
            for kind, each in places.items():
                found.setdefault(kind, []).extend({"file": shown(name)} | place for place in each)
        elif name.endswith((".yaml", ".yml")) and name != submission.main:
            found.setdefault("launch_slips", []).extend(
                {"file": shown(name)} | place for place in _twice(name, content)
            )
    return {kind: places for kind, places in found.items() if places}


def _twice(name: str, content: bytes) -> list[dict[str, Any]]:
    """Return `line` and `said` of the first thing that a bridge's file loses: a key that stands twice, a document."""
    found = [each for each in read(name, content).findings if any(words in each.sentence for words in LOST)][:1]
    return [{"line": int(each.place.rpartition(":")[2]), "said": shown(each.sentence)} for each in found]


def command(program: Path, trial: Trial) -> list[str]:
    """Hand the parameters of the trial to the launch file as its arguments."""
    return launch_command(program, trial.parameters)


def environment(pace: str) -> dict[str, str]:
    """Let Gazebo's programs ask the grader; in lock-step, everybody holds what it sends from the beginning."""
    from gz_course.grader.run.agent.course_agent.executor_monitor import HOLD
    from gz_course.grader.run.agent.course_agent.import_hooks import REMOTE_GAZEBO

    return {REMOTE_GAZEBO: "1"} | ({HOLD: "1"} if pace == "lockstep" else {})


def run_loop() -> type[RunLoop]:
    """Import what simulates such a run, with rclpy and MuJoCo."""
    from gz_course.grader.kinds.launch.launch_run_loop import LaunchRunLoop

    return LaunchRunLoop


def diagnosis() -> Diagnosis:
    """Explain runs by what the launch said and how it ended."""
    from gz_course.grader.score import diagnosis as looks
    from gz_course.grader.score.clocks import clock_fault
    from gz_course.grader.score.launched import launch_slips, not_started

    return looks.Diagnosis(
        looks.outcome_of,
        (looks.cannot_run, looks.broke_a_limit, looks.launch_failed, looks.out_of_time, looks.unstable),
        (launch_slips, not_started, looks.slips, clock_fault),
    )


SUFFIXES = (".py", ".launch.xml", ".launch.yaml")
KIND = Kind(SUFFIXES, fault_of, plan, command, run_loop, diagnosis, environment, brings_bridge=True)
