"""Fixtures for tests of the simulator: small worlds as text, and nodes within the process."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

PLUGINS = """
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
"""


@pytest.fixture
def world_text() -> Callable[..., str]:
    """Wrap the content of a <world> in an SDF text."""

    def wrap(inside: str, *, version: str = "1.10", step: float = 0.001) -> str:
        physics = f"<physics type='x'><max_step_size>{step}</max_step_size></physics>"
        return f"<sdf version='{version}'><world name='w'>{physics}{PLUGINS}{inside}</world></sdf>"

    return wrap


@pytest.fixture
def load_text(world_text: Callable[..., str]) -> Callable[..., World]:
    def load(inside: str, **options: object) -> World:
        wrapping = {key: options.pop(key) for key in ("version", "step") if key in options}
        return World.from_string(world_text(inside, **wrapping), **options)  # type: ignore[arg-type]

    return load


@pytest.fixture
def node() -> Iterator[Node]:
    with Node(NodeOptions(scope=Scope.PROCESS)) as made:
        yield made


@pytest.fixture(autouse=True)
def worlds_are_closed(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Close the worlds of a test, because those of the next one use the same topics."""
    attached: list[World] = []
    attach = World.attach

    def note(self: World, node: Node | None) -> None:
        attached.append(self)
        attach(self, node)

    monkeypatch.setattr(World, "attach", note)
    yield
    for world in attached:
        world.close()
