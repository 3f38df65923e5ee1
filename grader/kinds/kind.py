"""What a kind of submission is, and how the one an exercise names is found.

Intake asks a kind what is wrong with a file (`fault`), before anything heavy is imported; a run asks it who plays
(`cast`).
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError, nearest

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise
    from gz_course.grader.submission import Submission
    from gz_course.sim.ros_gz_bridge.entry import BridgeEntry


@dataclass(frozen=True)
class Cast:
    """Who plays in a run beside the simulator.

    `program` names the file among `files` that is started in the box. `entries` are the bridges that stand between the
    simulator and ROS from the beginning. `facts` go into the recording as they are. `given`: the program comes with
    the exercise, so what it does is never the student's fault, and both graphs are taken into the recording.
    `launch`: the program is a launch file, which starts simulator and bridge itself; a trial's parameters are its
    arguments.
    """

    program: str
    files: dict[str, bytes]
    entries: list[BridgeEntry] = field(default_factory=list)
    facts: dict[str, Any] = field(default_factory=dict)
    given: bool = False
    launch: bool = False


@dataclass(frozen=True)
class Kind:
    """A kind of submission.

    `suffixes` are what its files end in. `fault(name, content)` returns one sentence with the line if a file can never
    run, else None. `cast(exercise, submission)` raises ManifestError if the exercise's own files are wrong.
    `brings_world`: it may hand in worlds and models, which are simulated in a process that is watched.
    `brings_bridge`: what stands between simulator and ROS is up to the submission, not to the exercise.
    """

    suffixes: tuple[str, ...]
    fault: Callable[[str, bytes], str | None]
    cast: Callable[[Exercise, Submission], Cast]
    brings_bridge: bool = False
    brings_world: bool = False


def kind_names() -> list[str]:
    """Return the names of all kinds."""
    folder = Path(__file__).parent
    return sorted(path.stem for path in folder.glob("*.py") if path.stem not in ("__init__", "kind"))


def find_kind(name: str) -> Kind:
    """Return a kind by its name. Raises ManifestError naming the nearest if there is none."""
    names = kind_names()
    if name not in names:
        raise ManifestError(f"there is no kind of submission called {name!r}{nearest(name, names)}")
    kind: Kind = importlib.import_module(f"gz_course.grader.kinds.{name}").KIND
    return kind
