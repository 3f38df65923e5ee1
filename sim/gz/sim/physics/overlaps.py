"""Bodies that start inside each other: found when the model is built, and pushed apart slowly.

MuJoCo takes a deep contact for a strong spring and throws the bodies apart. Gazebo's engine limits the speed at which
it corrects the depth. Here such a pair gets a contact of its own, damped so strongly that the depth shrinks with a
limited speed; once it is small, the pair gets the contact of all others. Worlds without such bodies are not changed.

Source: https://mujoco.readthedocs.io/en/stable/modeling.html (reference acceleration)
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics import recipe

DEEP = 0.01
"""Depth [m] from which an overlap is handled; a contact throws bodies out of it with 0.3 m/s."""
FASTEST = 1.0
"""Maximum speed [m/s] at which the depth of an overlap shrinks."""
_RATE = 4.0  # maximum shrinking of the depth per second, relative to the depth
_SHALLOW = 0.001  # depth [m] at which a pair becomes one like all others
_DAMPING_STEPS = 5.0  # time constant of the damping, in steps

Overlap = tuple[str, str, float]
"""The names of two geoms, and their depth [m]."""


def find(model: mujoco.MjModel, data: mujoco.MjData) -> list[Overlap]:
    """Return the pairs of geoms that overlap deeply in the present state, in the order of their contacts."""
    deepest: dict[tuple[int, int], float] = {}
    for (one, other), distance in zip(data.contact.geom.tolist(), data.contact.dist.tolist(), strict=True):
        if -distance > max(DEEP, deepest.get((one, other), 0.0)):
            deepest[one, other] = -distance
    return [(model.geom(one).name, model.geom(other).name, depth) for (one, other), depth in deepest.items()]


def add_pairs(spec: mujoco.MjSpec, model: mujoco.MjModel, data: mujoco.MjData, found: Iterable[Overlap]) -> None:
    """Add a pair for each overlap that has none, with the friction that its contact has now."""
    contacts = data.contact
    last = {frozenset(geoms): index for index, geoms in enumerate(contacts.geom.tolist())}
    known = {frozenset((pair.geomname1, pair.geomname2)) for pair in spec.pairs}
    for one, other, _ in found:
        if frozenset((one, other)) not in known:
            index = last[frozenset((model.geom(one).id, model.geom(other).id))]
            pair = spec.add_pair(name=f"{one} {other}", geomname1=one, geomname2=other)
            pair.condim = int(contacts.dim[index])
            pair.friction, pair.solimp = contacts.friction[index].tolist(), contacts.solimp[index].tolist()
            pair.solref = recipe.contact_solref(float(model.opt.timestep))


class Overlaps:
    """The overlapping pairs of one compiled model; `relax` is called after each step while `active`."""

    def __init__(self, model: mujoco.MjModel, found: Iterable[Overlap]) -> None:
        self._model = model
        self._found = {frozenset((one, other)): depth for one, other, depth in found}
        self._pairs: dict[tuple[int, int], int] = {}
        self._usual: dict[int, list[float]] = {}
        self.restart()

    @property
    def active(self) -> bool:
        """Whether a pair is still being pushed apart."""
        return bool(self._pairs)

    def restart(self) -> None:
        """Soften all pairs again, for a world that is reset."""
        self._soften(self._found)

    def soften(self, found: Iterable[Overlap]) -> bool:
        """Soften these pairs again; return False if one of them is new, which needs another model."""
        depths = {frozenset((one, other)): depth for one, other, depth in found}
        if depths.keys() <= self._found.keys():
            self._soften(depths)
            return True
        return False

    def _soften(self, depths: Mapping[frozenset[str], float]) -> None:
        if not depths:
            return
        model = self._model
        for pair in range(model.npair):
            one, other = int(model.pair_geom1[pair]), int(model.pair_geom2[pair])
            depth = depths.get(frozenset((model.geom(one).name, model.geom(other).name)))
            if depth is not None:
                self._usual.setdefault(pair, model.pair_solref[pair].tolist())
                self._pairs[min(one, other), max(one, other)] = pair
                model.pair_solref[pair] = gentle_solref(depth, float(model.opt.timestep))

    def relax(self, data: mujoco.MjData) -> None:
        """Give the pairs that hardly overlap any more the contact of all others."""
        deep = set()
        geoms, depths = data.contact.geom, -data.contact.dist
        for index in np.flatnonzero(depths > _SHALLOW).tolist():
            one, other = int(geoms[index, 0]), int(geoms[index, 1])
            deep.add((min(one, other), max(one, other)))
        for key in [key for key in self._pairs if key not in deep]:
            pair = self._pairs.pop(key)
            self._model.pair_solref[pair] = self._usual[pair]


def gentle_solref(depth: float, step: float) -> tuple[float, float]:
    """Return negative stiffness and damping, with which an overlap of `depth` [m] shrinks exponentially."""
    damping = 1.0 / (_DAMPING_STEPS * step)
    return -damping * min(_RATE, FASTEST / depth), -damping
