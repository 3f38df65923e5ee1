"""A scene: a world, what is done to it, and what is measured; the same for each engine that runs it.

An engine returns a `Track`: the poses of links and the positions of joints at fixed times. A measure is a function of a
track, so all engines are measured alike, and velocities are differences of positions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]


@dataclass(frozen=True)
class Servo:
    """From `time` [s] on, a JointController moves the joint `model::joint` with `value` [rad/s or m/s]."""

    joint: str
    value: float
    time: float = 0.0


@dataclass(frozen=True)
class Force:
    """From `time` [s] on, an ApplyJointForce pushes the joint `model::joint` with `value` [N m or N]."""

    joint: str
    value: float
    time: float = 0.0


@dataclass(frozen=True)
class Drive:
    """From `time` [s] on, the DiffDrive of a model has the command `linear` [m/s] and `angular` [rad/s]."""

    model: str
    linear: float
    angular: float = 0.0
    time: float = 0.0


@dataclass(frozen=True)
class Kick:
    """At `time` [s], a free model gets the velocities `linear` [m/s] and `angular` [rad/s]."""

    model: str
    linear: tuple[float, float, float]
    angular: tuple[float, float, float] = (0.0, 0.0, 0.0)
    time: float = 0.0


Action = Servo | Force | Drive | Kick


@dataclass(frozen=True)
class Track:
    """The samples of a run: `time` (n,) [s], for each link `model::link` its pose (n, 7) (x y z [m], w x y z), for each
    joint `model::joint` its position and velocity (n, 2).
    """

    time: Numbers
    links: dict[str, Numbers]
    joints: dict[str, Numbers]

    def _of(self, name: str) -> Numbers:
        return self.links[name] if name else next(iter(self.links.values()))

    def x(self, link: str = "") -> Numbers:
        return self._of(link)[:, 0]

    def y(self, link: str = "") -> Numbers:
        return self._of(link)[:, 1]

    def z(self, link: str = "") -> Numbers:
        return self._of(link)[:, 2]

    def yaw(self, link: str = "") -> Numbers:
        w, x, y, z = self._of(link)[:, 3:].T
        return np.unwrap(np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)))

    def tilt(self, link: str = "") -> Numbers:
        """The angle [rad] between the z axes of the link and of the world."""
        _, x, y, _ = self._of(link)[:, 3:].T
        return np.arccos(np.clip(1.0 - 2.0 * (x * x + y * y), -1.0, 1.0))

    def way(self, link: str = "") -> Numbers:
        """The horizontal distance [m] from the first sample."""
        return np.hypot(self.x(link) - self.x(link)[0], self.y(link) - self.y(link)[0])

    def angle(self, joint: str = "") -> Numbers:
        return (self.joints[joint] if joint else next(iter(self.joints.values())))[:, 0]

    def rate(self, values: Numbers) -> Numbers:
        """The change of values per second, between samples."""
        return np.diff(values) / np.diff(self.time)

    def mean_rate(self, values: Numbers, since: float) -> float:
        """The mean change of values per second from the time `since` [s] on."""
        first = int(np.searchsorted(self.time, since - 1e-9))
        return float((values[-1] - values[first]) / (self.time[-1] - self.time[first]))

    def after(self, values: Numbers, since: float) -> Numbers:
        """The samples from the time `since` [s] on."""
        return values[self.time[: len(values)] >= since - 1e-9]


@dataclass(frozen=True)
class Measure:
    """A number of a track, its name with the unit, and how much it may differ: `within`, or the fraction `share` of
    the reference where that is more.

    The reference is Gazebo's plugin. `closed` is the closed form, where there is one; `judge` says what ours is
    compared with, `plugin` or `closed`.
    """

    name: str
    of: Callable[[Track], float]
    within: float
    share: float = 0.02
    closed: float | None = None
    judge: str = "plugin"

    def agrees(self, ours: float, reference: float) -> bool:
        return abs(ours - reference) <= max(self.within, self.share * abs(reference))


@dataclass(frozen=True)
class Scene:
    """A world (`models` is the inside of `<world>`), run for `seconds` with steps of `step` [s], sampled each `every`
    [s]. `links` and `joints` are what is watched. A `short` one is run by `make test`.
    """

    name: str
    models: str
    seconds: float
    measures: tuple[Measure, ...]
    actions: tuple[Action, ...] = ()
    links: tuple[str, ...] = ()
    joints: tuple[str, ...] = ()
    step: float = 0.001
    every: float = 0.01
    gravity: float = 9.8
    short: bool = True
    engines: frozenset[str] = field(default=frozenset(("plugin", "dart")))

    @property
    def sdf(self) -> str:
        return (
            f"<sdf version='1.9'><world name='w'><gravity>0 0 {-self.gravity}</gravity><physics name='p' type='dart'>"
            f"<max_step_size>{self.step}</max_step_size></physics><plugin filename='gz-sim-physics-system' "
            f"name='gz::sim::systems::Physics'/>{self.models}</world></sdf>"
        )

    def phases(self) -> list[tuple[list[Action], int]]:
        """The actions in groups of one time, each with the number of steps that follow."""
        times = sorted({0.0, *(each.time for each in self.actions)})
        ends = [*times[1:], self.seconds]
        return [
            ([each for each in self.actions if each.time == begin], round((end - begin) / self.step))
            for begin, end in zip(times, ends, strict=True)
        ]

    @property
    def stride(self) -> int:
        """The number of steps from one sample to the next."""
        return max(1, round(self.every / self.step))

    def track(self, samples: list[list[float]]) -> Track:
        """The track of samples, each the numbers of all links, then of all joints."""
        table = np.array(samples)
        time = np.arange(1, len(samples) + 1) * self.stride * self.step
        links = {name: table[:, 7 * number : 7 * number + 7] for number, name in enumerate(self.links)}
        rest = table[:, 7 * len(self.links) :]
        joints = {name: rest[:, 2 * number : 2 * number + 2] for number, name in enumerate(self.joints)}
        return Track(time, links, joints)
