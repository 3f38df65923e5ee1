"""What a kind of submission is, and how the one an exercise names is found.

Intake asks a kind for errors in a file (`fault`), before rclpy and MuJoCo are imported. A run asks it what to start
(`plan`, `command`) and how to simulate it (`run_loop`). Scoring asks it how to explain a recording (`diagnosis`).
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.exercise.trial import Trial
    from gz_course.grader.run.run_loop import RunLoop
    from gz_course.grader.score.diagnosis import Diagnosis
    from gz_course.grader.submission import Submission
    from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry


@dataclass(frozen=True)
class RunPlan:
    """What runs beside the simulator.

    `program` names the file among `files` that is started in the sandbox. `entries` are the bridges between simulator
    and ROS that exist from the beginning, `parameters` the ROS parameters of their bridge. `read` reads the
    submission's files for what is recorded about them: `facts`, which are asked for while the program starts. `beside`
    are the files of a sandbox beside it, in which the exercise's own node runs, if it has any.
    """

    program: str
    files: dict[str, bytes]
    entries: list[BridgeEntry] = field(default_factory=list)
    read: Callable[[], dict[str, Any]] = dict
    parameters: dict[str, str] = field(default_factory=dict)
    beside: dict[str, bytes] = field(default_factory=dict)

    @property
    def facts(self) -> dict[str, Any]:
        """What the submission's files say, recorded unchanged."""
        return self.read()

    @property
    def kept(self) -> dict[str, str]:
        """Types of the ROS topics on which the bridge keeps messages for subscriptions that join late, by topic."""
        durability = "qos_overrides.{}.publisher.durability"
        return {
            entry.ros_topic: entry.ros_type
            for entry in self.entries
            if self.parameters.get(durability.format(entry.ros_topic)) == "transient_local"
        }


def no_variables(pace: str) -> dict[str, str]:
    return {}


@dataclass(frozen=True)
class Kind:
    """A kind of submission.

    `suffixes` are the file name extensions it accepts. `fault(name, content)` returns one sentence with the line if a
    file can never run, else None. `plan(exercise, submission)` raises ManifestError if the exercise's own files are
    wrong. `command(program, trial)` starts the program in the sandbox with the variables `environment(pace)`.
    `run_loop()` returns the class that simulates the run, `diagnosis()` the explanations of its recording; they import
    what they need when called (the former rclpy and MuJoCo). `brings_bridge`: the submission, not the exercise,
    connects simulator and ROS.
    """

    suffixes: tuple[str, ...]
    fault: Callable[[str, bytes], str | None]
    plan: Callable[[Exercise, Submission], RunPlan]
    command: Callable[[Path, Trial], list[str]]
    run_loop: Callable[[], type[RunLoop]]
    diagnosis: Callable[[], Diagnosis]
    environment: Callable[[str], dict[str, str]] = no_variables
    brings_bridge: bool = False


def kind_names() -> list[str]:
    """Return the names of all kinds, sorted."""
    return sorted(path.parent.name for path in Path(__file__).parent.glob("*/__init__.py"))


def find_kind(name: str) -> Kind:
    """Return a kind by its name. Raises ManifestError naming the nearest if there is none."""
    names = kind_names()
    if name not in names:
        hint = did_you_mean(name, names, listing="known")
        raise ManifestError(f"there is no kind of submission called {name!r}{hint}")
    kind: Kind = importlib.import_module(f"gz_course.grader.kinds.{name}").KIND
    return kind
