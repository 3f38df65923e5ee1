"""Shapes of static models that are added in portions are the same as those that are added one by one."""

from __future__ import annotations

import mujoco
import pytest

from gz_course.sim.gz.sim.physics import static_parts
from gz_course.sim.gz.sim.world import World

SHAPES = (
    "<box><size>1 2 3</size></box>",
    "<sphere><radius>0.3</radius></sphere>",
    "<cone><radius>0.3</radius><length>1</length></cone>",
)
MODEL = """<model name='m{number}'><static>true</static><pose>{number} 1 0.1 0.1 0.2 0.3</pose><link name='l'>
<collision name='c'><pose>0.1 0 0 0 0 0.7</pose><geometry>{shape}</geometry></collision>
<visual name='v'><geometry>{shape}</geometry><material><diffuse>0.{number} 1 0 1</diffuse></material></visual>
<light type='point' name='lamp'/><sensor name='s' type='imu'/></link></model>"""
MOVING = """<model name='box'><pose>0 0 9 0 0 0</pose><link name='l'><collision name='c'><geometry><box>
<size>1 1 1</size></box></geometry></collision></link></model>"""


def model_of_a_world() -> mujoco.MjModel:
    models = "".join(MODEL.format(number=n, shape=SHAPES[n % 3]) for n in range(7))
    imu = "<plugin filename='gz-sim-imu-system' name='gz::sim::systems::Imu'/>"
    imu += "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>"
    world = World.from_string(f"<sdf version='1.10'><world name='w'>{imu}{MOVING}{models}</world></sdf>")
    assert world.warnings == []
    world.step(10)
    return world.model


def names(model: mujoco.MjModel, kind: mujoco.mjtObj, count: int) -> list[str | None]:
    return [mujoco.mj_id2name(model, kind, number) for number in range(count)]


def test_portions_change_nothing(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> None:
    one_by_one = model_of_a_world()
    monkeypatch.setattr(static_parts, "FEWEST", 5)
    monkeypatch.setattr(static_parts, "PORTION", 3)
    portions = model_of_a_world()
    assert "prefix" not in "".join(capfd.readouterr())
    for kind, count in (("GEOM", "ngeom"), ("SITE", "nsite"), ("LIGHT", "nlight"), ("BODY", "nbody")):
        number, kind_of = getattr(one_by_one, count), getattr(mujoco.mjtObj, f"mjOBJ_{kind}")
        assert number == getattr(portions, count)
        assert names(one_by_one, kind_of, number) == names(portions, kind_of, number)
    for field in ("pos", "quat", "size", "type", "bodyid", "dataid", "matid", "group", "contype", "friction", "rgba"):
        assert (getattr(one_by_one, f"geom_{field}") == getattr(portions, f"geom_{field}")).all(), field
