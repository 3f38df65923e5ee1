"""The shapes of static models in a large world, added in portions.

MuJoCo goes through all shapes whenever one is added, so 100,000 shapes one by one take minutes. A portion is a spec of
its own, which is attached when it is full; names, order and poses of the shapes are as if they were added one by one.

Source: https://mujoco.readthedocs.io/en/stable/programming/modeledit.html (attachment)
"""

from __future__ import annotations

import warnings
from typing import Any

import mujoco

from gz_course.sim.gz.sim.physics.compiler import EMPTY_PREFIX, hear_warnings
from gz_course.sim.gz.sim.sdf.description import WorldDescription

FEWEST = 5000
"""Number of static shapes from which they are added in portions."""
PORTION = 2000
"""Number of shapes of a portion."""


class StaticParts:
    """Takes the place of the world body for the parts of static models; `finish` attaches what is left."""

    def __init__(self, spec: mujoco.MjSpec, world: WorldDescription) -> None:
        links = [link for model in world.models if model.static for link in model.links]
        self._in_portions = sum(len(link.collisions) + len(link.visuals) for link in links) >= FEWEST
        self._spec = spec
        self._portion: mujoco.MjSpec | None = None
        self._count = 0

    def add_geom(self, **options: Any) -> mujoco.MjsGeom:
        """Add a shape. It can be changed until the next one is added."""
        if not self._in_portions:
            return self._spec.worldbody.add_geom(**options)
        if self._count == PORTION:
            self.finish()
        self._portion = self._portion or mujoco.MjSpec()
        self._count += 1
        return self._portion.worldbody.add_geom(**options)

    def add_site(self, **options: Any) -> mujoco.MjsSite:
        return self._spec.worldbody.add_site(**options)

    def add_light(self, **options: Any) -> mujoco.MjsLight:
        return self._spec.worldbody.add_light(**options)

    def finish(self) -> None:
        """Attach the portion that is open."""
        if self._portion is not None:
            hear_warnings()
            with warnings.catch_warnings():
                warnings.filterwarnings("ignore", message=EMPTY_PREFIX)
                self._spec.attach(self._portion, frame=self._spec.worldbody.add_frame(), prefix="")
        self._portion, self._count = None, 0
