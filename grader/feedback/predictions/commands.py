"""Explanations of velocity commands: what programs with a common misconception send instead of a drive of some seconds.

An explanation is a function of `Drive` that returns the beginning of a sentence, or an empty text if it does not fit:

    @explains
    def drives_backwards(drive: Drive) -> str: ...

Every file of `of_commands/` is asked; two that fit are both said.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.feedback.recorded.places import suspect
from gz_course.grader.feedback.rules import Room, ask
from gz_course.grader.printable import shown
from gz_course.grader.record.reading import Recording

MOST = 2  # explanations that are named
SUSPECTS = ("endless", "by_place", "again", "hidden")  # what suspects of a drive are about


@dataclass(frozen=True)
class Drive:
    """The commands that arrived, and the drive that was asked for.

    `times` [s] (n,); `linear` [m/s] and `angular` [rad/s] x, y, z, shape (n, 3). `ended` is the end of the run [s].
    `suspects` are words on the places in the student's file that may be the reason, by what they are about.
    """

    times: np.ndarray
    linear: np.ndarray
    angular: np.ndarray
    ended: float
    speed: float  # [m/s] asked for
    seconds: float  # [s] asked for
    suspects: Mapping[str, str] = field(default_factory=dict)

    @property
    def moving(self) -> np.ndarray:
        """Which commands, shape (n,), drive the robot forward or back."""
        return np.asarray(np.abs(self.linear[:, 0]) > 0.01)

    @property
    def period(self) -> float:
        """Usual time [s] between two commands; NaN if there are fewer than three."""
        return float(np.median(np.diff(self.times))) if len(self.times) > 2 else float("nan")

    @property
    def pushes(self) -> list[tuple[float, float, int]]:
        """Each uninterrupted drive: its begin [s], its end [s] (infinite if nothing ended it), number of commands."""
        found: list[tuple[float, float, int]] = []
        begin, number = np.nan, 0
        for time, moves in zip(self.times, self.moving, strict=True):
            if moves:
                begin, number = (time, 1) if not number else (begin, number + 1)
            elif number:
                found.append((float(begin), float(time), number))
                number = 0
        return [*found, (float(begin), np.inf, number)] if number else found

    @property
    def steady(self) -> float:
        """Usual value of linear.x [m/s] while the robot is driven; 0 if it never is."""
        values = self.linear[self.moving, 0]
        return float(np.median(values)) if len(values) else 0.0


Explanation = Callable[[Drive], str]
ROOM: Room[Explanation] = Room(f"{__name__.rpartition('.')[0]}.of_commands")


def explains(function: Explanation) -> Explanation:
    """Register an explanation."""
    ROOM.add(function, function)
    return function


@dataclass(frozen=True)
class WantedDrive:
    """The drive that an exercise asks for, as a check's `explain` says it."""

    commands: str
    speed: float
    seconds: float

    @staticmethod
    def read(table: Table) -> WantedDrive:
        wanted = WantedDrive(
            table.text("commands"), table.number("linear_x", above=0), table.number("seconds", above=0)
        )
        table.end()
        return wanted

    def explain(self, recording: Recording) -> str:
        """Return which misconceptions fit the commands of a run; empty if none does."""
        parts = [[recording.signal(f"{self.commands}/{of}/{axis}") for axis in "xyz"] for of in ("linear", "angular")]
        times = parts[0][0].times
        if not len(times) or any(len(each) != len(times) for part in parts for each in part):
            return ""
        linear, angular = (np.stack([each.values for each in part], axis=1) for part in parts)
        ended = min(recording.ended_s, float(recording.properties("run")["duration"]))
        suspects = {about: words for about in SUSPECTS if (words := suspect(recording, about))}
        decides = recording.facts().get("of_the_drive", [])
        if len(decides) == 1:
            suspects["decides"] = shown(f"line {decides[0]['line']}, `{decides[0]['code']}`", 200)
        return explain(Drive(times / 1e9, linear, angular, ended, self.speed, self.seconds, suspects))


def explain(drive: Drive) -> str:
    """Return the explanations that fit, joined; empty if there is none."""
    if not len(drive.times):
        return ""
    return "; ".join([said for rule in ROOM.rules() if (said := ask(rule, "", drive))][:MOST])
