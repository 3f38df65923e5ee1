"""A step: a cell that the reader of a chapter writes, and the check of what it did.

The steps of a chapter stand in `grading/steps.py` of its exercise:

    @step("circle", objective=2)
    def circle(tried: Tried) -> str:
        \"\"\"The robot drives a circle with a radius of 0.5 m.\"\"\"
        poses = tried.poses("robot", seconds=3.0)
        ...
        expect(abs(radius - 0.5) < 0.05, f"The robot drives a circle of {radius:.2f} m; 0.5 m is wanted.")
        return f"The robot drives a circle of {radius:.2f} m."

A check looks at what happened, never at the text of the cell. It returns what was seen, one sentence, or raises
`NotYet` with what was seen and what is wanted.
"""

from __future__ import annotations

import abc
from collections.abc import Callable
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

PYTHON, COMMANDS = "python", "commands"
LIMIT = 60.0  # [s] that a cell and its check may take together on an idle machine


class NotYet(Exception):
    """What was seen and what is wanted, in one sentence for the reader."""


def expect(condition: object, sentence: str) -> None:
    """Raise NotYet with this sentence unless the condition holds."""
    if not condition:
        raise NotYet(sentence)


@dataclass(frozen=True)
class Pose:
    """Where a model truly is: simulated time [s], x, y, z [m] and yaw [rad] in the world."""

    time: float
    x: float
    y: float
    z: float
    yaw: float


class Tried(abc.ABC):
    """What a cell did: what it printed, the names it left, and the world and the ROS graph that it changed.

    Every method raises NotYet if there is nothing to be had, with a sentence that says what was waited for.
    """

    body: str  # the cell as written
    output: str  # what it printed, at most `cell.MOST_OUTPUT` characters
    folder: Path  # of the chapter

    @abc.abstractmethod
    def value(self, name: str, kind: type | tuple[type, ...] = object) -> Any:
        """Return the value of a name, which must be of this type."""

    @abc.abstractmethod
    def function(self, name: str) -> Callable[..., Any]:
        """Return a function of the reader. What it raises when it is called becomes NotYet."""

    @abc.abstractmethod
    def command(self, command: str, deadline: float = 20.0) -> str:
        """Return what a command prints, which is ended after `deadline` [s]."""

    @abc.abstractmethod
    def start(self, command: str, ready: str) -> str:
        """Start a command in the playground, and return what it printed until `ready`; a run before it is ended."""

    @abc.abstractmethod
    def stop(self, command: str) -> str:
        """End the programs whose command begins so; return what they printed."""

    @abc.abstractmethod
    def heard(self, topic: str, message_type: str, count: int = 1, deadline: float = 10.0) -> list[Any]:
        """Return the next messages on a ROS topic, of a type such as `sensor_msgs/msg/LaserScan`."""

    @abc.abstractmethod
    def heard_from(
        self, command: str, topic: str, message_type: str, count: int = 1, after: float = 2.0, deadline: float = 8.0
    ) -> list[Any]:
        """Start a command and return the messages that come on a topic from then on; then it is ended.

        Returns when `count` have come, or `after` [s] from the first. NotYet if the command ends with an error, or if
        none comes within `deadline` [s], twice.
        """

    @abc.abstractmethod
    def time(self, stamp: Any) -> Any:
        """Return a stamp of a message as a time of a node's clock, `rclpy.time.Time`."""

    @abc.abstractmethod
    def silent(self, topic: str, message_type: str, seconds: float) -> bool:
        """Tell whether no message comes on a ROS topic for so long [s]."""

    @abc.abstractmethod
    def topics(self, *wanted: str) -> dict[str, list[str]]:
        """Return the topics of ROS and their types, as soon as those `wanted` are there.

        Those that every node has are left out.
        """

    @abc.abstractmethod
    def publishers(self, topic: str) -> list[str]:
        """Return the names of the nodes that publish on a ROS topic."""

    @abc.abstractmethod
    def transform(self, target: str, source: str) -> Any:
        """Return the latest `TransformStamped` by which tf2 takes points from the frame `source` to `target`."""

    @abc.abstractmethod
    def subscribers(self, topic: str) -> list[str]:
        """Return the names of the nodes that subscribe to a ROS topic."""

    @abc.abstractmethod
    def both_ways(self, topic: str, message_type: str = "") -> list[str]:
        """Return the nodes that publish a ROS topic and also subscribe to it, as a bridge in both directions does.

        With a type the topic is listened to meanwhile: a lazy bridge has its ends only then.
        """

    @abc.abstractmethod
    def node(self) -> AbstractContextManager[tuple[Any, Callable[[Callable[[], bool], float], None]]]:
        """Give an `rclpy` node for the time of a `with`, and a function that spins it.

        The function takes what should hold, and the longest time [s].
        """

    @abc.abstractmethod
    def gz_topics(self, wanted: str = "") -> list[str]:
        """Return the topics of Gazebo, as soon as the one `wanted` is there."""

    @abc.abstractmethod
    def poses(self, model: str, seconds: float = 0.0) -> list[Pose]:
        """Return where a model truly is now, and for so many simulated seconds from now on."""

    @abc.abstractmethod
    def place(self, model: str, x: float, y: float, yaw: float = 0.0) -> None:
        """Put a model somewhere [m, rad] on the ground, for example away from the wall that it drove into."""

    @abc.abstractmethod
    def remove(self, model: str) -> None:
        """Take a model out of the world, for example so that its name may be given again."""

    @abc.abstractmethod
    def message_type(self, name: str) -> Any:
        """Return the class of messages of a type, such as `std_msgs/msg/String`."""

    @abc.abstractmethod
    def recording(self) -> Any:
        """Return the recording that the last grading of the chapter's exercise left."""


Check = Callable[[Tried], str]


@dataclass(frozen=True)
class Step:
    """A cell to write. `form`: PYTHON, COMMANDS, or the name of the file that the cell holds."""

    name: str
    objective: int  # number of the objective it serves, from 1
    form: str
    check: Check
    limit: float

    @property
    def task(self) -> str:
        """What the cell should do, one sentence."""
        return (self.check.__doc__ or "").strip()


def step(name: str, *, objective: int, form: str = PYTHON, limit: float = LIMIT) -> Callable[[Check], Step]:
    """Make the check below it a step of the chapter."""

    def make(check: Check) -> Step:
        return Step(name, objective, form, check, limit)

    return make


def steps_of(module: ModuleType) -> dict[str, Step]:
    """Return the steps of a chapter's module, by name, in their order. Raises ValueError for a name given twice."""
    found: dict[str, Step] = {}
    for each in vars(module).values():
        if isinstance(each, Step):
            if each.name in found:
                raise ValueError(f"{module.__name__} has two steps {each.name!r}")
            found[each.name] = each
    return found
