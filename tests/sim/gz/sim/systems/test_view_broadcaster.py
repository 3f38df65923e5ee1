"""ViewBroadcaster: a view gets the model and the state of the world, and may push its links for a moment."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np
import pytest

from gz_course.sim.gz.msgs.bytes_pb2 import Bytes
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.entity_wrench_pb2 import EntityWrench
from gz_course.sim.gz.sim.systems import view_broadcaster
from gz_course.sim.gz.sim.systems.view_broadcaster import STATE, ViewBroadcaster, split_stamp
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, Publisher
from gz_course.tests.own_time import OwnTime

BALL = """
<plugin filename="gz-course-view-broadcaster-system" name="gz_course::systems::ViewBroadcaster"/>
<gravity>0 0 0</gravity>
<model name="ball"><link name="link"><inertial><mass>1</mass></inertial>
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>
"""
LoadText = Callable[..., World]


@pytest.fixture(autouse=True)
def at_every_step(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(view_broadcaster, "_PICTURE_NS", 0)
    monkeypatch.setattr(view_broadcaster, "_REST_NS", 0)


def model_of(node: Node) -> tuple[int, mujoco.MjModel]:
    found, answer = node.request("/world/w/view/model", None, Empty, Bytes)
    assert found
    stamp, content = split_stamp(answer.data)
    return stamp, mujoco.MjModel.from_binary_path("world.mjb", {"world.mjb": content})


def test_model_and_state_belong_together(load_text: LoadText, node: Node) -> None:
    heard: list[Any] = []
    node.subscribe(Bytes, "/world/w/view/state", heard.append)
    world = load_text(BALL, node=node)
    world.data.qvel[0] = 1.0
    world.step(5)
    stamp, model = model_of(node)
    sent, numbers = split_stamp(heard[-1].data)
    assert sent == stamp
    assert (heard[-1].header.stamp.sec, heard[-1].header.stamp.nsec) == (0, 5_000_000)
    data = mujoco.MjData(model)
    mujoco.mj_setState(model, data, np.frombuffer(numbers), STATE)
    assert data.qpos == pytest.approx(world.data.qpos)
    assert model.body(1).name == "ball::link"

    second = BALL[BALL.index("<model") :].replace('"ball"', '"second"')
    world.editor.spawn(f"<sdf version='1.10'>{second}</sdf>")
    world.paused_update()
    later, model = model_of(node)
    assert later != stamp and model.body(2).name == "second::link"
    assert split_stamp(heard[-1].data)[0] == later


def test_nothing_is_sent_without_a_view(load_text: LoadText, node: Node) -> None:
    world = load_text(BALL, node=node)
    broadcaster: Any = next(each for each in world.systems if isinstance(each, ViewBroadcaster))
    sent: list[Any] = []
    broadcaster._publisher.publish = sent.append
    world.step(3)
    assert sent == []


def drag(publisher: Publisher, *push: float, name: str = "ball::link") -> None:
    message: Any = EntityWrench()
    message.entity.name = name
    force = message.wrench.force
    force.x, force.y, force.z = push
    publisher.publish(message)


def test_a_drag_pushes_until_it_is_let_go_or_forgotten(
    load_text: LoadText, node: Node, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [10**9]
    monkeypatch.setattr(view_broadcaster, "time", OwnTime(monotonic_ns=lambda: now[0]))
    world = load_text(BALL, node=node)
    hand = node.advertise("/world/w/view/drag", EntityWrench)
    drag(hand, 2.0, 0.0, 0.0)
    world.step(100)
    assert world.data.qvel[0] == pytest.approx(0.2)
    assert not world.data.xfrc_applied.any(), "only during the step, so forces of others stay as they are"
    drag(hand, 0.0, 0.0, 0.0)
    world.step(100)
    assert world.data.qvel[0] == pytest.approx(0.2)
    drag(hand, 2.0, 0.0, 0.0)
    now[0] += 10**9
    world.step(100)
    assert world.data.qvel[0] == pytest.approx(0.2), "a view that is gone pushes no more"
    drag(hand, float("nan"), 0.0, 0.0)
    drag(hand, 1.0, 0.0, 0.0, name="nobody")
    world.step(1)
    assert world.data.qvel[0] == pytest.approx(0.2)
    assert world.dropped_commands == {"/world/w/view/drag": 1}


def test_another_thread_gets_the_model_while_the_world_runs(load_text: LoadText, node: Node) -> None:
    world = load_text(BALL, node=node)
    got: list[int] = []
    asking = threading.Thread(target=lambda: got.append(model_of(node)[0]))
    asking.start()
    while asking.is_alive():
        world.step(1)
    assert len(got) == 1


def test_a_message_that_is_too_short_is_refused() -> None:
    with pytest.raises(ValueError, match="got 3"):
        split_stamp(b"abc")
