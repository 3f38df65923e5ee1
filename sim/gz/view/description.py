"""The world in words: what a screen reader reads of the view.

`spoken` changes when something else happens: the world pauses, a model starts or stops moving, another is selected.
`whole` is read on request only, and has the pose of every model that can move.
"""

from __future__ import annotations

import json
import math
import time
from typing import TYPE_CHECKING

import mujoco
import numpy as np

if TYPE_CHECKING:
    from gz_course.sim.gz.view.window import Window

_PERIOD_S = 1.0
"""Wall time [s] between two looks at the world."""
_MOVED, _TURNED = 0.02, math.radians(2.0)
"""A model moves if it is further than this from where it was [m, rad] at the last look."""
_ELSEWHERE = 0.1
"""Distance [m] from where a model was said to stand at which that is said again."""
_SPOKEN, _LISTED = 3, 20
"""Models that are spoken of, and that are listed, at most."""


class Description:
    """What is said of one window."""

    def __init__(self) -> None:
        self.spoken = self.whole = ""
        self._next = 0.0
        self._last: dict[str, np.ndarray] = {}
        self._rests: dict[str, np.ndarray] = {}

    def update(self, window: Window) -> None:
        """Look at the world, if the last time is long enough ago."""
        if time.monotonic() < self._next:
            return
        self._next = time.monotonic() + _PERIOD_S
        poses = {name: _pose(window.data, entity.bodies[0]) for name, entity in window.models.items() if entity.bodies}
        for name, pose in poses.items():
            before = self._last.get(name, pose)
            if _apart(pose, before) or (name in self._rests and _far(pose, self._rests[name]) > _ELSEWHERE):
                self._rests.pop(name, None)
            else:
                self._rests.setdefault(name, pose)
        self._rests = {name: pose for name, pose in self._rests.items() if name in poses}
        self._last = poses
        link = window.link
        state = "paused" if link.paused else "running"
        models = [
            f"{name} {_place(self._rests[name]) if name in self._rests else 'moves'}." for name in list(poses)[:_SPOKEN]
        ]
        selected = [f"{window.selected} is selected."] if window.selected else []
        self.spoken = " ".join([f"World {link.world}, {state}.", *models, *selected, _sentence(link.said, link.world)])
        seconds = link.stats.sim_time.sec
        still = [name for name in window.models if name not in poses]
        self.whole = " ".join(
            [
                f"Simulated time {seconds} seconds.",
                *(f"{name} {_place(pose, exact=True)}." for name, pose in list(poses.items())[:_LISTED]),
                f"Models that cannot move: {', '.join(still[:_LISTED])}." if still else "",
            ]
        )

    def as_json(self) -> str:
        """Return both texts as the page asks for them."""
        return json.dumps({"spoken": self.spoken.strip(), "whole": self.whole.strip()})


def _pose(data: mujoco.MjData, body: int) -> np.ndarray:
    """Return x, y, z [m] and the heading [rad] of a body."""
    ahead = data.xmat[body].reshape(3, 3)[:, 0]
    return np.array([*data.xpos[body], math.atan2(ahead[1], ahead[0])])


def _far(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.linalg.norm(one[:3] - other[:3]))


def _apart(one: np.ndarray, other: np.ndarray) -> bool:
    turn = abs(math.remainder(one[3] - other[3], math.tau))
    return _far(one, other) > _MOVED or turn > _TURNED


def _place(pose: np.ndarray, *, exact: bool = False) -> str:
    digits = 2 if exact else 1
    x, y, z = (f"{value + 0.0:.{digits}f}" for value in np.round(pose[:3], digits))
    height = f", z {z}" if exact else ""
    return f"stands at x {x}, y {y}{height} metres, heading {round(math.degrees(pose[3]))} degrees"


def _sentence(said: str, world: str) -> str:
    """Return the status line as a sentence; nothing for what it says all the time."""
    return "" if said == f"world '{world}'" else f"{said[:1].upper()}{said[1:]}."
