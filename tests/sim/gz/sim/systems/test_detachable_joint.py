"""DetachableJoint: holds, lets go and holds again, over resets and rebuilds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

BOX = """<model name='{name}'><pose>{x} 0 {z} 0 0 {yaw}</pose>{more}<link name='l'><inertial><mass>1</mass></inertial>
<collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link>{plugin}</model>"""
PLUGIN = """<plugin filename='gz-sim-detachable-joint-system' name='gz::sim::systems::DetachableJoint'>
<parent_link>l</parent_link><child_model>load</child_model><child_link>l</child_link>{more}</plugin>"""
LOAD = BOX.format(name="load", x=0.5, z=2, yaw=1, more="", plugin="")
STATIC = "<static>true</static>"


def text(*models: str) -> str:
    plugin = "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>"
    return f"<sdf version='1.10'><world name='w'>{plugin}{''.join(models)}</world></sdf>"


def carrier(more: str = "", inside: str = STATIC) -> str:
    return BOX.format(name="crane", x=0, z=2, yaw=0.5, more=inside, plugin=PLUGIN.format(more=more))


@pytest.fixture
def node() -> Iterator[Node]:
    with Node(NodeOptions(scope=Scope.PROCESS)) as made:
        yield made


@pytest.mark.parametrize("inside", [STATIC, ""], ids=["from a static model", "from a moving one"])
def test_a_load_is_held_let_go_and_held_again(node: Node, inside: str) -> None:
    told: list[str] = []
    node.subscribe(StringMsg, "/model/load/detachable_joint/state", lambda message: told.append(message.data))
    world = World.from_string(text(carrier(inside=inside), LOAD), node=node)
    gravity = world.model.opt.gravity
    gravity[:] = (0, 0, -9.8) if inside else (0, 0, 0)
    start = world.truth.pose("crane").inverse() * world.truth.pose("load")
    if not inside:
        world.data.qvel[:6] = (0.3, 0.1, 0.2, 0.5, -0.2, 0.4)
    world.step(500)
    held = world.truth.pose("crane").inverse() * world.truth.pose("load")
    assert np.allclose(held.position, start.position, atol=2e-3), "it moves along"
    assert told == ["attached"] and world.warnings == []

    node.advertise("/model/crane/detachable_joint/detach", Empty).publish(Empty())
    gravity[:] = (0, 0, -9.8)
    before = world.truth.pose("load").position[2]
    world.step(300)
    if inside:
        assert world.truth.pose("load").position[2] < before - 0.4, "it falls"
    node.advertise("/model/crane/detachable_joint/attach", Empty).publish(Empty())
    world.step(100)
    caught = world.truth.pose("crane").inverse() * world.truth.pose("load")
    world.editor.spawn(f"<sdf version='1.10'>{BOX.format(name='late', x=9, z=9, yaw=0, more='', plugin='')}</sdf>")
    world.step(200)
    still = world.truth.pose("crane").inverse() * world.truth.pose("load")
    assert np.allclose(still.position, caught.position, atol=2e-3), "also after a rebuild"
    assert told == ["attached", "detached", "attached"]
    world.reset()
    world.step(50)
    again = world.truth.pose("crane").inverse() * world.truth.pose("load")
    assert np.allclose(again.position, start.position, atol=2e-3) and told[-1] == "attached"
    world.close()


def test_a_child_that_comes_later_is_attached_then(node: Node) -> None:
    world = World.from_string(text(carrier()), node=node)
    world.step(10)
    assert [each for each in world.warnings if "finds no link 'load::l'" in each]
    world.editor.spawn(f"<sdf version='1.10'>{LOAD}</sdf>")
    world.step(200)
    assert world.truth.pose("load").position[2] == pytest.approx(2.0, abs=2e-3)
    world.editor.remove("load")
    world.step(10)
    world.editor.spawn(f"<sdf version='1.10'>{LOAD.replace('0.5 0 2 0 0 1', '1 0 1 0 0 1')}</sdf>")
    world.step(100)
    assert np.allclose(world.truth.pose("load").position, (1, 0, 1), atol=2e-3)
    world.close()


def test_it_may_start_detached() -> None:
    world = World.from_string(text(carrier("<initial_attach>false</initial_attach>"), LOAD))
    world.step(300)
    assert world.truth.pose("load").position[2] < 1.7


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("<child_link>l</child_link>", "", "DetachableJoint needs a <child_link>"),
        ("<parent_link>l<", "<parent_link>x<", "<parent_link> 'x' is no link of model 'crane'; its links are: l"),
    ],
)
def test_a_fault_is_named(old: str, new: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        World.from_string(text(carrier().replace(old, new), LOAD))
