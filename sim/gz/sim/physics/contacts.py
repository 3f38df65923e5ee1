"""The contacts of the last step, by the names of their SDF collisions; used by the contact sensor and by TouchPlugin.

Source: https://mujoco.readthedocs.io/en/stable/computation/index.html (contact)
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.builder import COLLISION_GROUP
from gz_course.sim.gz.sim.pose import Vector

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

CollisionPath = tuple[str, str, str]
"""The names of model, link and collision; link names of nested models are scoped."""


@dataclass(frozen=True, slots=True)
class ContactPoint:
    """One point where geom `geom` touches geom `other`.

    `position` [m], `normal` (unit vector from `other` to `geom`) and `force` [N] on `geom` are in the world frame;
    `depth` [m] is positive if the geoms overlap.
    """

    geom: int
    other: int
    position: Vector
    normal: Vector
    depth: float
    force: Vector


class CollisionGeoms:
    """The MuJoCo geoms of each `<collision>`. Valid for one MuJoCo model: create a new one after every rebuild."""

    def __init__(self, world: WorldAccess) -> None:
        known: dict[str, CollisionPath] = {}
        for model in world.description.models:
            for link in model.links:
                for part in link.collisions:
                    known[f"{model.name}::{link.name}::{part.name}"] = (model.name, link.name, part.name)
        self.paths: dict[int, CollisionPath] = {}
        """The collision of each geom."""
        self._geoms: dict[CollisionPath, list[int]] = {}
        for geom in np.flatnonzero(world.model.geom_group == COLLISION_GROUP).tolist():
            name = world.model.geom(geom).name
            # A shape of several convex parts has one geom for each, numbered after a '#'.
            path = known.get(name) or known.get(name.rpartition("#")[0])
            if path is not None:
                self.paths[geom] = path
                self._geoms.setdefault(path, []).append(geom)

    def of(self, path: CollisionPath) -> list[int]:
        """Return the geoms of a collision; empty if it does not exist."""
        return self._geoms.get(path, [])


def touching(world: WorldAccess, geoms: Collection[int]) -> Iterator[tuple[int, int, int]]:
    """Yield (contact, geom, other) for every contact of one of `geoms`, in MuJoCo's order; if both are in `geoms`,
    yield the contact from both sides.
    """
    contacts = world.data.contact
    pairs, rows = contacts.geom.tolist(), contacts.efc_address.tolist()
    for index, ((first, second), row) in enumerate(zip(pairs, rows, strict=True)):
        if row < 0:  # the geoms are near each other, but there is no force
            continue
        if first in geoms:
            yield index, first, second
        if second in geoms:
            yield index, second, first


def contact_points(world: WorldAccess, geoms: Collection[int]) -> Iterator[ContactPoint]:
    """Yield every contact of the last step that involves one of `geoms`, seen from that geom."""
    contacts, force = world.data.contact, np.zeros(6)
    for index, geom, other in touching(world, geoms):
        mujoco.mj_contactForce(world.model, world.data, index, force)
        frame = contacts.frame[index].reshape(3, 3)
        # MuJoCo's normal points from the first geom to the second; its force acts on the second.
        sign = 1.0 if int(contacts.geom[index][1]) == geom else -1.0
        position, depth = contacts.pos[index].copy(), -float(contacts.dist[index])
        yield ContactPoint(geom, other, position, sign * frame[0], depth, sign * (force[:3] @ frame))
