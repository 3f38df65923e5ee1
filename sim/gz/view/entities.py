"""The models of a MuJoCo model and their links, read from the names `model::link::part` of its parts."""

from __future__ import annotations

from dataclasses import dataclass, field

import mujoco
import numpy as np


@dataclass
class Entity:
    """A model of the world, or a link of one; `name` is its scoped name."""

    name: str
    bodies: list[int] = field(default_factory=list)
    geoms: list[int] = field(default_factory=list)
    links: dict[str, Entity] = field(default_factory=dict)

    def centre(self, data: mujoco.MjData) -> np.ndarray:
        """Return the middle of the entity in the world [m]."""
        if self.bodies:
            return data.xpos[self.bodies[0]].copy()
        return data.geom_xpos[self.geoms].mean(axis=0) if self.geoms else np.zeros(3)


def models_of(model: mujoco.MjModel) -> dict[str, Entity]:
    """Return the models of a world by name, each with its links, in the order of MuJoCo's bodies and shapes."""
    found: dict[str, Entity] = {}

    def link_of(name: str) -> tuple[Entity, Entity]:
        top = name.split("::", 1)[0]
        whole = found.setdefault(top, Entity(top))
        return whole, whole.links.setdefault(name, Entity(name))

    for body in range(1, model.nbody):
        name = model.body(body).name
        if "::" in name:
            for entity in link_of(name):
                entity.bodies.append(body)
    for geom in range(model.ngeom):
        link, _, _ = model.geom(geom).name.rpartition("::")
        if "::" in link:
            for entity in link_of(link):
                entity.geoms.append(geom)
    return found


def link_of_body(model: mujoco.MjModel, body: int) -> str:
    """Return the scoped name of the link that a body is; empty for the world."""
    return model.body(body).name if 0 < body < model.nbody else ""
