"""What the systems of a scene command to its joints in an engine that has no systems."""

from __future__ import annotations

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.description import WorldDescription
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.tests.conformance.physics.scene import Action, Drive, Scene, Servo


def read(scene: Scene) -> WorldDescription:
    return read_world(scene.sdf, scene.name, Diagnostics())


def servos(world: WorldDescription, actions: list[Action]) -> list[Action]:
    """The actions, with the servos of its wheels instead of each DiffDrive."""
    found: list[Action] = []
    for action in actions:
        found += _wheels(world, action) if isinstance(action, Drive) else [action]
    return found


def _wheels(world: WorldDescription, action: Drive) -> list[Action]:
    model = next(each for each in world.models if each.name == action.model)
    element = next(each.element for each in model.plugins if each.name.endswith("DiffDrive"))
    half, radius = element.number("wheel_separation", 1.0) / 2.0, element.number("wheel_radius", 0.2)
    found: list[Action] = []
    for side, sign in (("left_joint", -1.0), ("right_joint", 1.0)):
        speed = (action.linear + sign * action.angular * half) / radius
        found += [Servo(f"{model.name}::{each.text}", speed) for each in element.all(side)]
    return found
