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
    visibility = "never"                    # who is told about it (`visibility.py`)
    weight = 2.0                            # of this trial: see below
    private = { posts = 3 }                 # for `python` checks alone: recording.private; no process of a submission
    parameters = { speed = 0.4 }            # for the submission, and for `python` checks: arguments of a launch file
                                            # (speed:=0.4), ROS parameters of a node (-p speed:=0.4)

    [trial.check.stops]                     # parameters of the check `stops` in this trial: bands, times, windows
    window = [0.0, 20.0]

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

    [[trial.script]]                        # what `ros2 service call /reset std_srvs/srv/SetBool "{data: true}"` does
    at = 6.0
    service = "/reset"
    type = "std_srvs/srv/SetBool"
    request = { data = true }               # fields that are left out have their defaults

A script is a list of such entries, in the order of time. Simulated time stands still until a node has answered that its
parameter is set, or answered a call. The recording has the values that were asked for as signals, `parameters/speed`,
and of a call `calls/reset/answered` (1 or 0) and the fields of the answer: numbers as signals, such as
`calls/reset/success`, texts as lines, such as `calls/reset/message`.

Without weights a check passes if it passes in every trial. If a trial of a grading has a `weight`, a check earns the
weighted mean of what it earns in each trial; a trial without one has the weight 1.

Trials are data, never code. `exercise.py` reads the public ones, `commands/grade.py` the others; `grade.py` runs them
one after another.
"""

from __future__ import annotations

import dataclasses
import random
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gz_course.grader.errors import ManifestError, UsageError
from gz_course.grader.exercise.grading import MANIFEST
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.exercise.visibility import ALWAYS, NEVER, read_visibility
from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from gz_course.grader.exercise import CheckSpec, Exercise

TRIALS = "trials.toml"
FIXED = frozenset({"id", "title", "points", "kind", "hint", "hints", "consequence_of", "visibility"})  # of a check
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


@dataclass(frozen=True)
class ScriptedCall:
    """A service of the submission that the grader calls during a run."""

    at: float  # [s] of simulated time
    service: str
    type: str  # such as std_srvs/srv/Trigger
    request: dict[str, Any]

    @staticmethod
    def read(table: Table) -> ScriptedCall:
        service, type = table.text("service"), table.text("type")
        if not NODE_NAME.fullmatch(service):
            table.refuse("service", "the full name of a service, such as /reset")
        if "/srv/" not in type:
            table.refuse("type", "the type of a service, such as std_srvs/srv/Trigger")
        call = ScriptedCall(table.number("at"), service, type, table.free("request"))
        table.end()
        return call


Entry = ScriptedCommand | ScriptedParameter | ScriptedCall


def read_script(tables: list[Table]) -> tuple[Entry, ...]:
    """Read the `[[script]]` tables of an exercise or a trial."""

    def kind(table: Table) -> type[ScriptedCommand] | type[ScriptedParameter] | type[ScriptedCall]:
        return (
            ScriptedParameter if table.has("parameter") else ScriptedCall if table.has("service") else ScriptedCommand
        )

    return tuple(kind(table).read(table) for table in tables)


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
    `checks` are parameters of checks that differ in this trial, by the id of the check.
    """

    name: str
    seed: int
    world: str | None = None
    duration: float | None = None  # [s] simulated
    poses: dict[str, tuple[float, ...]] = field(default_factory=dict)
    script: tuple[Entry, ...] | None = None
    parameters: dict[str, Any] = field(default_factory=dict)
    place: tuple[int, int] = (1, 1)
    tick: float | None = None  # [s] of simulated time between two /clock messages
    visibility: str = ALWAYS  # to students: `visibility.py`
    source: Path | None = field(default=None, compare=False)
    weight: float | None = None
    checks: dict[str, dict[str, Any]] = field(default_factory=dict)
    private: dict[str, Any] = field(default_factory=dict)

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
            checks=with_parameters(exercise.checks, self.checks),
        )

    def as_dict(self) -> dict[str, Any]:
        """Return what a recording keeps of the trial, for checks that need the parameters of their run."""
        return {"poses": {name: list(pose) for name, pose in self.poses.items()}, "parameters": self.parameters}


PUBLIC = Trial("public", 0)


def with_parameters(checks: tuple[CheckSpec, ...], changed: Mapping[str, dict[str, Any]]) -> tuple[CheckSpec, ...]:
    """Return the checks with what a trial changes of their parameters, by the id of the check."""
    if not changed:
        return checks
    return tuple(
        dataclasses.replace(each, parameters=each.parameters | changed[each.id]) if each.id in changed else each
        for each in checks
    )


def refuse_unknown_checks(trials: tuple[Trial, ...], checks: tuple[CheckSpec, ...]) -> None:
    """Raise ManifestError if a trial changes a check that does not exist, or more of it than parameters."""
    known = [check.id for check in checks]
    for trial in trials:
        for id, changed in trial.checks.items():
            where = f"{trial.source}: trial {trial.name!r}"
            if id not in known:
                hint = did_you_mean(id, known, listing="known")
                raise ManifestError(f"{where}: [trial.check.{id}] names no check{hint}")
            if fixed := sorted(FIXED & changed.keys()):
                raise ManifestError(
                    f"{where}: [trial.check.{id}] changes {fixed[0]}; a trial changes parameters of a check only"
                )


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
    if choice != "all":
        found = load_trials(exercise.twin / TRIALS if choice == "hidden" else Path(choice))
        refuse_unknown_checks(found, exercise.checks)
        return found
    hidden = exercise.twin / TRIALS
    every = exercise.trials + (load_trials(hidden) if hidden.is_file() else ())
    refuse_unknown_checks(every, exercise.checks)
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
    poses, checks = table.table("poses", {}), table.table("check", {})
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
        visibility=read_visibility(table, ALWAYS if where.name == MANIFEST else NEVER),
        source=where,
        weight=table.number("weight", above=0) if table.has("weight") else None,
        checks={id: checks.free(id) for id in checks.names()},
        private=table.free("private"),
    )
    table.end()
    return trial
