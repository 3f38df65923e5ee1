"""Robots that must skid turn as commanded, and shapes bounce with the product of their restitutions."""

from __future__ import annotations

import math

import pytest

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.physics.wheeled_robots import drive_of

WORLD = """<sdf version='1.10'><world name='w'><physics type='x'><max_step_size>{step}</max_step_size></physics>
<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>{inside}</world></sdf>"""
PLANE = """<model name='ground'><static>true</static><link name='l'><collision name='c'><geometry><plane/></geometry>
<surface><bounce><restitution_coefficient>{e}</restitution_coefficient></bounce></surface></collision></link></model>"""


def four_wheels(length: float, width: float, radius: float, mass: float, step: float, shape: str = "cylinder") -> World:
    """Return a world with a robot; its wheels are `length` and `width` [m] apart."""
    sizes = {
        "box": f"<size>{radius} {radius} {radius}</size>",
        "cylinder": f"<radius>{radius}</radius><length>{radius / 2}</length>",
        "sphere": f"<radius>{radius}</radius>",
    }
    tyre = f"<geometry><{shape}>{sizes[shape]}</{shape}></geometry>"
    wheels = joints = ""
    for number, (x, y) in enumerate(((1, 1), (-1, 1), (1, -1), (-1, -1))):
        m = mass / 20
        place = f"{x * length / 2} {y * width / 2} {radius} -1.5707963267948966 0 0"
        wheels += f"""<link name='w{number}'><pose>{place}</pose>
          <inertial><mass>{m}</mass><inertia><ixx>{m * radius**2 / 3}</ixx><iyy>{m * radius**2 / 3}</iyy>
          <izz>{m * radius**2 / 2}</izz></inertia></inertial><collision name='tyre'>{tyre}</collision></link>
          <joint name='j{number}' type='revolute'><parent>base</parent><child>w{number}</child>
          <axis><xyz>0 0 1</xyz></axis></joint>"""
        joints += f"<{'left' if y > 0 else 'right'}_joint>j{number}</{'left' if y > 0 else 'right'}_joint>"
    robot = f"""<model name='robot'><link name='base'><pose>0 0 {radius} 0 0 0</pose><inertial><mass>{mass}</mass>
      <inertia><ixx>{mass * width**2 / 12}</ixx><iyy>{mass * length**2 / 12}</iyy>
      <izz>{mass * (length**2 + width**2) / 12}</izz></inertia></inertial></link>{wheels}
      <plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'>{joints}
      <wheel_separation>{width}</wheel_separation><wheel_radius>{radius}</wheel_radius></plugin></model>"""
    return World.from_string(WORLD.format(step=step, inside=PLANE.format(e=0) + robot))


@pytest.mark.parametrize(
    ("length", "width", "radius", "mass", "step", "shape"),
    [
        (0.4, 0.5, 0.1, 20.0, 0.001, "cylinder"),
        (0.6, 0.4, 0.1, 20.0, 0.001, "sphere"),
        (0.3, 0.2, 0.04, 2.0, 0.004, "cylinder"),
    ],
)
def test_a_robot_with_four_wheels_turns_as_commanded(
    length: float, width: float, radius: float, mass: float, step: float, shape: str
) -> None:
    world = four_wheels(length, width, radius, mass, step, shape)
    drive = drive_of(world)
    drive.command(0.0, 1.0)
    world.step(round(1.0 / step))
    before = world.truth.pose("robot").yaw()
    world.step(round(1.0 / step))
    assert not any("skid" in warning for warning in world.warnings)
    assert world.truth.pose("robot").yaw() - before == pytest.approx(1.0, rel=0.1)
    drive.command(0.5, 0.0)
    world.step(round(1.0 / step))
    place = world.truth.pose("robot").position
    world.step(round(1.0 / step))
    assert math.dist(place, world.truth.pose("robot").position) == pytest.approx(0.5, rel=0.01)


@pytest.mark.parametrize(("ball", "ground", "step"), [(0.5, 1.0, 0.001), (0.9, 0.9, 0.001), (0.8, 1.0, 0.004)])
def test_a_ball_bounces_with_the_product_of_both_restitutions(ball: float, ground: float, step: float) -> None:
    inside = (
        PLANE.format(e=ground)
        + f"""<model name='ball'><pose>0 0 1.1 0 0 0</pose><link name='l'>
      <collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry><surface><bounce>
      <restitution_coefficient>{ball}</restitution_coefficient></bounce></surface></collision></link></model>"""
    )
    world = World.from_string(WORLD.format(step=step, inside=inside))
    assert world.warnings == []
    heights = []
    for _ in range(round(0.9 / step)):
        world.step()
        heights.append(world.truth.pose("ball").position[2] - 0.1)
    bottom = heights.index(min(heights))
    assert math.sqrt(max(heights[bottom:])) == pytest.approx(ball * ground, rel=0.05)


def test_a_body_without_restitution_on_either_side_does_not_bounce() -> None:
    inside = (
        PLANE.format(e=1)
        + """<model name='box'><pose>0 0 0.6 0 0 0</pose><link name='l'><collision name='c'>
      <geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model>"""
    )
    world = World.from_string(WORLD.format(step=0.001, inside=inside))
    world.step(1000)
    assert world.truth.pose("box").position[2] == pytest.approx(0.1, abs=0.002)
    with pytest.raises(SdfError, match="<restitution_coefficient> must be from 0 to 1, got 2"):
        World.from_string(WORLD.format(step=0.001, inside=PLANE.format(e=2)))


def test_only_wheels_one_behind_the_other_skid() -> None:
    for length, radius, skid in ((0.4, 0.1, 4), (0.01, 0.2, 0)):  # the second has twin wheels on one axle
        sideways, along, *_ = four_wheels(length, 0.5, radius, 20.0, 0.001).model.pair_friction.T
        assert sum(sideways < along) == skid
    warning = next(each for each in four_wheels(0.4, 0.5, 0.1, 20.0, 0.001, "box").warnings if "skid" in each)
    assert "wheel collision 'tyre' is a box" in warning and "make it a cylinder" in warning
