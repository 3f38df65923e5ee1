"""A trial: the parameters of one run. The same submission in the same trial gives the same run.

Public trials are in the manifest as `[[trial]]`; an instructor's hidden ones in `solutions/NN_name/trials.toml`, with
the same keys, all optional but the name. Their worlds may lie beside that file:

    [[trial]]
    name = "north"                          # part of the recording's file name
    seed = 7                                # of sensor noise and of the scripted speeds
    world = "maze.sdf"                      # instead of the exercise's; a file beside the student's, or a world's name
    duration = 10.0                         # [s] instead of the exercise's
    tick = 0.25                             # [s] between two /clock messages, instead of the exercise's
    poses = { robot = [-2, 1, 0, 0, 0, 1.57] }      # where models stand: x y z [m], roll pitch yaw [rad]
    parameters = { speed = 0.4 }            # for the submission, and for `python` checks: arguments of a launch file
                                            # (speed:=0.4), ROS parameters of a node (-p speed:=0.4)

    [[trial.script]]                        # instead of the exercise's
    at = 0.5
    topic = "/model/robot/cmd_vel"          # of Gazebo; or `ros_topic = "/cmd_vel"`, through the bridge
    linear_x = 0.3
    angular_z = 0.25

    [[trial.script]]                        # what `ros2 param set /driver speed 0.2` does, at 5 s of simulated time
    at = 5.0
    node = "/driver"
    parameter = "speed"
    value = 0.2

A script is a list of such entries, in the order of time. Simulated time stands still until a node has answered that its
parameter is set. The recording has the values that were asked for as signals, `parameters/speed`.

Trials are data, never code. `exercise.py` reads the public ones, `commands/grade.py` the others; `grade.py` runs them
one after another.
"""

from __future__ import annotations

import dataclasses
import random
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise.toml_table import Table

if TYPE_CHECKING:
    from gz_course.grader.exercise import Exercise

TRIALS = "trials.toml"
SCRIPT_SPREAD = 0.2  # largest fraction by which a scripted speed is varied
NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,59}")
NODE_NAME = re.compile(r"(/[A-Za-z_]\w*)+", re.ASCII)


@dataclass(frozen=True)
class ScriptedCommand:
    """A velocity that the grader commands during a run, before the seed of the trial varies it."""

    at: float  # [s] of simulated time
    topic: str  # Gazebo topic of type Twist, or a ROS topic
    linear_x: float  # [m/s]
    angular_z: float  # [rad/s]
    ros: bool = False  # it comes from ROS: only a bridge takes it to Gazebo

    @staticmethod
    def read(table: Table) -> ScriptedCommand:
        ros = table.has("ros_topic")
        topic = table.text("ros_topic" if ros else "topic")
        command = ScriptedCommand(table.number("at"), topic, table.number("linear_x"), table.number("angular_z"), ros)
        table.end()
        return command


@dataclass(frozen=True)
class ScriptedParameter:
    """A ROS parameter that the grader sets during a run; `node` is the full name of the node."""

    at: float  # [s] of simulated time
    node: str
    name: str
    value: Any  # as in TOML: a truth value, number, text, or a list of one of them

    @staticmethod
    def read(table: Table) -> ScriptedParameter:
        node = table.text("node")
        if not NODE_NAME.fullmatch(node):
            table.refuse("node", "the full name of a node, such as /driver")
        parameter = ScriptedParameter(table.number("at"), node, table.text("parameter"), table.any("value"))
        if not _is_parameter(parameter.value):
            table.refuse("value", "a truth value, a number, a text, or a list of values of one of these types")
        table.end()
        return parameter


def read_script(tables: list[Table]) -> tuple[ScriptedCommand | ScriptedParameter, ...]:
    """Read the `[[script]]` tables of an exercise or a trial."""
    return tuple((ScriptedParameter if table.has("parameter") else ScriptedCommand).read(table) for table in tables)


def _is_parameter(value: Any) -> bool:
    """Return whether ROS has a type of parameter for a value."""
    if isinstance(value, list):
        return bool(value) and len(set(map(type, value))) == 1 and isinstance(value[0], bool | int | float | str)
    return isinstance(value, bool | int | float | str)


@dataclass(frozen=True)
class Trial:
    """The parameters of one run. `seed` seeds the simulator's sensor noise and varies the scripted commands.

    None means that the exercise's value is used. `poses` are x, y, z [m], roll, pitch, yaw [rad] in the world's frame,
    by model. `place` is (number of this trial, number of trials) in one grading, `source` the file that defines it.
    """

    name: str
    seed: int
    world: str | None = None
    duration: float | None = None  # [s] simulated
    poses: dict[str, tuple[float, ...]] = field(default_factory=dict)
    script: tuple[ScriptedCommand | ScriptedParameter, ...] | None = None
    parameters: dict[str, Any] = field(default_factory=dict)
    place: tuple[int, int] = (1, 1)
    tick: float | None = None  # [s] of simulated time between two /clock messages
    source: Path | None = field(default=None, compare=False)

    def vary(self, command: ScriptedCommand) -> ScriptedCommand:
        """Return the command with its speeds scaled by factors drawn from this trial's seed."""
        draw = random.Random(f"{self.seed} {command.at} {command.topic}")
        return dataclasses.replace(
            command,
            linear_x=command.linear_x * draw.uniform(1 - SCRIPT_SPREAD, 1 + SCRIPT_SPREAD),
            angular_z=command.angular_z * draw.uniform(1 - SCRIPT_SPREAD, 1 + SCRIPT_SPREAD),
        )

    def applied_to(self, exercise: Exercise) -> Exercise:
        """Return the exercise with the parameters of this trial."""
        return dataclasses.replace(
            exercise,
            world=exercise.world if self.world is None else self.world,
            duration=exercise.duration if self.duration is None else self.duration,
            tick=exercise.tick if self.tick is None else self.tick,
            script=exercise.script if self.script is None else self.script,
        )

    def as_dict(self) -> dict[str, Any]:
        """Return what a recording keeps of the trial, for checks that need the parameters of their run."""
        return {"poses": {name: list(pose) for name, pose in self.poses.items()}, "parameters": self.parameters}


PUBLIC = Trial("public", 0)


def numbered(trials: tuple[Trial, ...], seed: int = 0) -> tuple[Trial, ...]:
    """Return the trials of one grading, each with its place; `seed` is added to the seed of each."""
    return tuple(
        dataclasses.replace(trial, seed=trial.seed + seed, place=(number, len(trials)))
        for number, trial in enumerate(trials, 1)
    )


def read_trials(tables: list[Table], where: Path, folder: Path) -> tuple[Trial, ...]:
    """Read the `[[trial]]` tables of the file `where`, whose worlds may be files of `folder`.

    Raises ManifestError if they are wrong.
    """
    trials = tuple(_read(table, where, folder) for table in tables)
    check_names(trials, str(where))
    return trials


def load_trials(path: Path) -> tuple[Trial, ...]:
    """Read a `trials.toml`. Raises UsageError if there is no such file, ManifestError if it is wrong."""
    if not path.is_file():
        raise UsageError(f"there is no file {path} with hidden trials; give another, or leave --trials out")
    table = Table.load(path)
    trials = read_trials(table.tables("trial"), path, path.parent)
    table.end()
    return trials


def chosen_trials(exercise: Exercise, choice: str) -> tuple[Trial, ...]:
    """Return the trials an instructor asks for: `public`, `hidden`, `all` (both), or those of a file.

    Raises UsageError if there is no such file.
    """
    if choice == "public":
        return exercise.trials
    if choice == "hidden":
        return load_trials(exercise.twin / TRIALS)
    if choice != "all":
        return load_trials(Path(choice))
    hidden = exercise.twin / TRIALS
    every = exercise.trials + (load_trials(hidden) if hidden.is_file() else ())
    check_names(every, str(hidden))
    return every


def check_names(trials: tuple[Trial, ...], where: str) -> None:
    """Raise ManifestError if two trials of one grading have the same name."""
    names = [trial.name for trial in trials]
    for name in names:
        if names.count(name) > 1:
            raise ManifestError(f"{where}: two trials are called {name!r}; each needs a name of its own")


def _read(table: Table, where: Path, folder: Path) -> Trial:
    name = table.text("name")
    if not NAME.fullmatch(name):
        table.refuse("name", "letters, digits, _ and - only, because it becomes part of a file's name")
    table.where = f"{where}: trial {name!r}"
    poses = table.table("poses", {})
    world = table.text("world") if table.has("world") else None
    if world is not None and (folder / world).is_file():
        world = str(folder / world)
    trial = Trial(
        name=name,
        seed=table.integer("seed", 0),
        world=world,
        duration=table.number("duration", above=0) if table.has("duration") else None,
        tick=table.number("tick", above=0) if table.has("tick") else None,
        poses={model: tuple(poses.numbers(model, [6])) for model in poses.names()},
        script=read_script(table.tables("script", [])) if table.has("script") else None,
        parameters=table.free("parameters"),
        source=where,
    )
    table.end()
    return trial
