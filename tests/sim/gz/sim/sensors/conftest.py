"""Fixtures for tests of sensors: worlds with the required systems, and the messages of a topic."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.sim.plugins.sensor import SensorBase
from gz_course.sim.gz.sim.plugins.sensor_system import SensorSystem
from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

INERTIAL = (
    "<inertial><mass>{mass}</mass><inertia><ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz>"
    "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>"
)


def inertial(mass: float = 1.0, moment: float = 0.1) -> str:
    """Return an <inertial> with a mass [kg] and the same moment of inertia [kg m^2] about every axis."""
    return INERTIAL.format(mass=mass, i=moment)


def sensor_world(inside: str, *names: str, version: str = "1.10", step: float = 0.001, **options: Any) -> World:
    """Load a world named `w` with Physics and the named systems."""
    known = systems()
    plugins = "".join(f"<plugin filename='{known[n].filename}' name='gz::sim::systems::{n}'/>" for n in names)
    return World.from_string(
        f"<sdf version='{version}'><world name='w'><physics type='x'><max_step_size>{step}</max_step_size></physics>"
        "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>"
        f"{plugins}{inside}</world></sdf>",
        **options,
    )


def sensors_of(world: World) -> list[SensorBase]:
    """Return all running sensors of a world."""
    return [sensor for each in world.systems if isinstance(each, SensorSystem) for sensor in each.sensors]


@pytest.fixture
def listen() -> Iterator[Callable[..., list[Any]]]:
    """Return `listen(world, topic, "gz.msgs.IMU")`, which returns the list of messages received during steps."""
    with Node(NodeOptions(scope=Scope.PROCESS)) as own, contextlib.ExitStack() as worlds:

        def hear(world: World, topic: str, kind: str) -> list[Any]:
            if world.node is None:
                world.attach(own)
                worlds.callback(world.close)
            heard: list[Any] = []
            own.subscribe(message_class(kind), topic, heard.append)
            return heard

        yield hear
