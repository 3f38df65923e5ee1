"""Finds the `<visual>` or `<collision>` of each MuJoCo geom, for sensors that need more than its shape.

MuJoCo's model holds shapes and colours; retro-reflection, visibility flags, labels and entities are only in the
description of the world. Sensors look them up in `bind`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import mujoco

from gz_course.sim.gz.sim.physics.geoms import VISUAL_GROUP, geom_names
from gz_course.sim.gz.sim.sdf.description import Collision, Link, Model, Visual

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


class GeomPart(NamedTuple):
    """MuJoCo's geom id with the model, link and part it was made of; `number` counts the geoms of one part."""

    geom: int
    model: Model
    link: Link
    part: Visual | Collision
    number: int


def geom_parts(world: WorldAccess, group: int) -> Iterator[GeomPart]:
    """Yield the parts of a geom group (visuals or collisions) that have a geom, in file order."""
    for model in world.description.models:
        for link in model.links:
            parts: list[Visual | Collision] = [*(link.visuals if group == VISUAL_GROUP else link.collisions)]
            for part in parts:
                for number, name in enumerate(geom_names(f"{model.name}::{link.name}::{part.name}", part)):
                    geom = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_GEOM, name)
                    if geom >= 0:
                        yield GeomPart(geom, model, link, part, number)
