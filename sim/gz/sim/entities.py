"""Entity ids, which identify the parts of a world in Gazebo's messages (`Pose.id`, `Entity.id`, `Model.id`).

The world has the id 1; every model, link, visual, collision, sensor, joint and light gets the next number in file
order. The id of a removed entity is not used again until the world is reset.

Source: gz::sim::Entity and kNullEntity, https://github.com/gazebosim/gz-sim/blob/gz-sim8/include/gz/sim/Entity.hh
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from gz_course.sim.gz.sim.sdf.description import Light, Model, WorldDescription


@dataclass(frozen=True, slots=True)
class Entity:
    """One entity: its number, its `kind` (world, model, link, visual, collision, sensor, joint, light) and its `path`.

    The path holds the names below the world, outermost first; names of nested models are scoped: `arm::hand`.
    """

    number: int
    kind: str
    path: tuple[str, ...]

    @property
    def name(self) -> str:
        return self.path[-1].rsplit("::", 1)[-1]


class Entities:
    """All entities of one world, by number and by name."""

    def __init__(self, world: WorldDescription) -> None:
        self.restart(world)

    def restart(self, world: WorldDescription) -> None:
        """Assign all numbers again after a reset of the world."""
        self._by_number: dict[int, Entity] = {}
        self._numbers: dict[tuple[str, tuple[str, ...]], int] = {}
        self._last = 0
        self._add("world", (world.name,))
        for model in world.models:
            self.add_model(model)
        for light in world.lights:
            self.add_light(light)
        for joint in world.joints:
            self._add("joint", (joint.name,))

    def add_model(self, model: Model) -> int:
        """Add a new model with all its parts; return the model's number."""
        number = self._add("model", (model.name,))
        for nested in model.nested:
            self._add("model", (model.name, nested.name))
        for link in model.links:
            self._add("link", (model.name, link.name))
            for kind, part in link.parts():
                self._add(kind, (model.name, link.name, part.name))
        for joint in model.joints:
            self._add("joint", (model.name, joint.name))
            for sensor in joint.sensors:
                self._add("sensor", (model.name, joint.name, sensor.name))
        return number

    def add_light(self, light: Light) -> int:
        """Add a new light of the world; return its number."""
        return self._add("light", (light.name,))

    def remove(self, kind: str, name: str) -> list[int]:
        """Remove a model (with its parts) or a light of the world; return their numbers."""
        below = kind == "model"
        gone = [
            each
            for each in self._by_number.values()
            if each.path[0] == name and (each.kind == kind if len(each.path) == 1 else below)
        ]
        for each in gone:
            del self._by_number[each.number]
            del self._numbers[(each.kind, each.path)]
        return [each.number for each in gone]

    def number(self, kind: str, *path: str) -> int:
        """Return the number of an entity, 0 (Gazebo's null entity) if there is none of that name."""
        return self._numbers.get((kind, path), 0)

    def find(self, number: int) -> Entity | None:
        return self._by_number.get(number)

    def __iter__(self) -> Iterator[Entity]:
        """Yield all entities in the order of their numbers."""
        return iter(self._by_number.values())

    def _add(self, kind: str, path: tuple[str, ...]) -> int:
        self._last += 1
        self._by_number[self._last] = Entity(self._last, kind, path)
        self._numbers[(kind, path)] = self._last
        return self._last
