"""TouchPlugin: a lasting touch is reported once; interruptions, targets, the service, invalid parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

Run = Callable[..., tuple[World, list[float]]]
BODY = (
    "<inertial><mass>1</mass></inertial><collision name='c'><geometry><sphere><radius>0.5</radius></sphere></geometry>"
    "</collision>"
)
SENSOR = "<sensor name='s' type='contact'><contact><collision>c</collision></contact></sensor>"
CONTACT = "<plugin filename='gz-sim-contact-system' name='gz::sim::systems::Contact'/>"
PARAMETERS = "<target>ground</target><time>0.1</time><namespace>ball</namespace><enabled>true</enabled>"


def text(parameters: str = PARAMETERS, sensor: str = SENSOR, systems: str = CONTACT, height: float = 0.5) -> str:
    plugin = f"<plugin filename='gz-sim-touchplugin-system' name='gz::sim::systems::TouchPlugin'>{parameters}</plugin>"
    return (
        "<sdf version='1.10'><world name='w'>"
        "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>"
        f"{systems}<include><uri>model://ground_plane</uri></include>"
        f"<model name='m'><pose>0 0 {height} 0 0 0</pose><link name='l'>{BODY}{sensor}</link>{plugin}</model>"
        "</world></sdf>"
    )


@pytest.fixture
def run() -> Iterator[Run]:
    """Load a world; return it with the list of the times [s] at which a touch was reported."""
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        worlds = []

        def start(sdf: str) -> tuple[World, list[float]]:
            world = World.from_string(sdf, node=node)
            worlds.append(world)
            touches: list[float] = []
            node.subscribe(Boolean, "/ball/touched", lambda _: touches.append(round(world.sim_time_ns * 1e-9, 6)))
            return world, touches

        yield start
        for world in worlds:
            world.close()


def enable(world: World, on: bool) -> None:
    assert world.node is not None
    assert world.node.request("/ball/enable", Boolean(data=on), Boolean, Empty)[0]


def test_a_touch_is_told_once_after_its_time(run: Run) -> None:
    world, touches = run(text(height=0.4999))
    world.step(500)
    # Touching from the first step on; the time must be exceeded.
    assert touches == [0.102]


def test_a_break_begins_the_time_anew(run: Run) -> None:
    world, touches = run(text(height=0.4999))
    world.step(60)
    world.data.qpos[2] = 0.6
    world.step(20)
    assert touches == []
    world.step(500)
    landed = 0.06 + (2 * 0.1 / 9.8) ** 0.5
    assert len(touches) == 1 and touches[0] > landed + 0.1


def test_another_target_is_not_felt(run: Run) -> None:
    world, touches = run(text(PARAMETERS.replace("ground", "wall"), height=0.4999))
    world.step(300)
    assert touches == []


@pytest.mark.parametrize("target", ["world/w/model/ground_plane/link/link/collision/collision", "link/collision"])
def test_the_target_is_looked_for_in_the_whole_scoped_name(run: Run, target: str) -> None:
    world, touches = run(text(PARAMETERS.replace("ground", target), height=0.4999))
    world.step(300)
    assert len(touches) == 1


def test_the_service_switches_it_on_and_off(run: Run) -> None:
    world, touches = run(text(PARAMETERS.replace("true", "false"), height=0.4999))
    world.step(200)
    assert touches == []
    enable(world, True)
    world.step(200)
    assert touches == [0.302]
    enable(world, True)
    world.step(50)
    enable(world, False)
    world.step(300)
    assert touches == [0.302]


def test_after_a_reset_it_is_as_in_the_file(run: Run) -> None:
    world, touches = run(text(height=0.4999))
    world.step(300)
    world.reset()
    world.step(300)
    assert touches == [0.102, 0.102]


def test_a_target_that_comes_later_is_felt(run: Run) -> None:
    world, touches = run(text(PARAMETERS.replace("ground", "late"), height=0.4999))
    world.step(100)
    world.editor.remove("ground_plane")
    plane = "<collision name='c'><geometry><plane><normal>0 0 1</normal></plane></geometry></collision>"
    world.editor.spawn(
        f"<sdf version='1.10'><model name='late'><static>1</static><link name='l'>{plane}</link></model></sdf>"
    )
    world.step(200)
    assert touches == [0.202]


@pytest.mark.parametrize("missing", ["target", "time", "namespace"])
def test_what_is_needed_is_asked_for(missing: str) -> None:
    with pytest.raises(SdfError, match=f"TouchPlugin needs <{missing}>"):
        World.from_string(text(PARAMETERS.replace(missing, "other")))


@pytest.mark.parametrize(
    ("sdf", "sentence"),
    [
        (text(sensor=""), "no contact sensor of the model"),
        (text(systems=""), "gz-sim-contact-system"),
        (text(PARAMETERS.replace("0.1", "-1")), "from 0 on"),
        (text(PARAMETERS.replace("0.1", "1e300")), "from 0 on"),
    ],
)
def test_a_plugin_that_would_never_tell_says_why(sdf: str, sentence: str) -> None:
    try:
        warnings = World.from_string(sdf).warnings
    except SdfError as error:
        warnings = [str(error)]
    assert any(sentence in warning for warning in warnings)
