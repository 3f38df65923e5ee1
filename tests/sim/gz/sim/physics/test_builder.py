"""SDF to MuJoCo: masses, joints, friction and servos have the values of the file."""

from __future__ import annotations

import math
from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.world import World

Load = Callable[..., World]


def box(name: str, pose: str, mu: float, static: bool, size: str = "0.2 0.2 0.2") -> str:
    return f"""<model name='{name}'><static>{static}</static><pose>{pose}</pose><link name='l'>
      <inertial><mass>1</mass><inertia><ixx>0.0067</ixx><iyy>0.0067</iyy><izz>0.0067</izz></inertia>
      </inertial>
      <collision name='c'><geometry><box><size>{size}</size></box></geometry>
      <surface><friction><ode><mu>{mu}</mu></ode></friction></surface></collision></link></model>"""


GROUND = box("ground", "0 0 -0.1 0 0 0", 1.0, True, "100 100 0.2")


@pytest.mark.parametrize(("mu", "ground"), [(0.2, 1.0), (0.2, 100.0), (0.5, 0.3)])
def test_the_lower_friction_of_two_surfaces_counts(load_text: Load, mu: float, ground: float) -> None:
    floor = GROUND.replace("<mu>1.0</mu>", f"<mu>{ground}</mu>")
    world = load_text(floor + box("slider", "0 0 0.1 0 0 0", mu, False))
    world.step(200)
    world.data.qvel[0] = 2.0
    start = world.truth.pose("slider").position[0]
    world.step(4000)
    expected = 2.0**2 / (2.0 * min(mu, ground) * 9.8)
    assert world.truth.pose("slider").position[0] - start == pytest.approx(expected, rel=0.02)


def test_a_body_without_friction_slides_on(load_text: Load) -> None:
    world = load_text(GROUND + box("slider", "0 0 0.1 0 0 0", 0.0, False))
    world.step(100)
    world.data.qvel[0] = 1.0
    world.step(1000)
    assert world.truth.velocity("slider").linear[0] == pytest.approx(1.0, rel=1e-3)


def test_free_fall_and_gravity_switched_off(load_text: Load) -> None:
    still = box("still", "3 0 5 0 0 0", 1, False).replace("<link name='l'>", "<link name='l'><gravity>0</gravity>")
    world = load_text(box("falls", "0 0 5 0 0 0", 1, False) + still)
    world.step(500)
    assert world.truth.velocity("falls").linear[2] == pytest.approx(-9.8 * 0.5, rel=1e-6)
    assert world.truth.pose("falls").position[2] == pytest.approx(5 - 9.8 * 0.125, rel=3e-3)
    assert world.truth.pose("still").position[2] == pytest.approx(5.0, abs=1e-9)


def test_collide_bitmask_decides_who_touches(load_text: Load) -> None:
    mask = "<surface><contact><collide_bitmask>0x0100</collide_bitmask></contact>"
    world = load_text(GROUND + box("ghost", "0 0 0.1 0 0 0", 1, False).replace("<surface>", mask))
    world.step(500)
    assert world.truth.pose("ghost").position[2] < -0.5


PENDULUM = """<model name='p'><link name='base'/><joint name='fix' type='fixed'><parent>world</parent>
      <child>base</child></joint>
  <link name='bob'><pose>0 0 1 0 0 0</pose>
    <inertial><pose>1 0 0 0 0 0</pose><mass>2</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz>
      </inertia></inertial></link>
  <joint name='swing' type='{kind}'><parent>base</parent><child>bob</child><axis>
      <xyz>0 1 0</xyz>{axis}</axis></joint></model>"""


def test_a_pendulum_swings_with_its_period(load_text: Load) -> None:
    world = load_text(PENDULUM.format(kind="revolute", axis=""))
    speed_at = []
    for _ in range(1400):
        world.step()
        speed_at.append(world.data.qvel[0])
    # The quarter period of a 1 m pendulum released horizontally is 1.8541 sqrt(L/g).
    assert int(np.argmax(speed_at)) * 1e-3 == pytest.approx(1.8541 * math.sqrt(1 / 9.8), rel=0.01)
    assert max(speed_at) == pytest.approx(math.sqrt(2 * 9.8), rel=0.01)


def test_joint_limits_hold(load_text: Load) -> None:
    world = load_text(PENDULUM.format(kind="revolute", axis="<limit><lower>-0.1</lower><upper>0.5</upper></limit>"))
    world.step(3000)
    assert world.data.qpos[0] == pytest.approx(0.5, abs=0.02)


def test_a_slider_moves_along_its_axis(load_text: Load) -> None:
    text = PENDULUM.format(kind="prismatic", axis="").replace("<xyz>0 1 0</xyz>", "<xyz>0 0 1</xyz>")
    world = load_text(text)
    world.step(100)
    assert world.truth.link_pose("p", "bob").position == pytest.approx((0, 0, 1 - 9.8 * 0.01 / 2), abs=1e-3)


def test_inertia_of_a_flat_wheel_is_accepted_and_kept(load_text: Load) -> None:
    wheel = box("wheel", "0 0 1 0 0 0", 1, False).replace("0.0067</ixx>", "5.445e-05</ixx>")
    wheel = wheel.replace("0.0067</iyy>", "5.445e-05</iyy>").replace("0.0067</izz>", "1.089e-04</izz>")
    world = load_text(wheel)
    body = world.model.body("wheel::l")
    assert sorted(body.inertia) == pytest.approx([5.445e-05, 5.445e-05, 1.089e-04], rel=1e-3)


moments = st.tuples(*[st.floats(0.1, 1.0)] * 3).map(lambda v: (v[0] + v[1], v[0] + v[2], v[1] + v[2]))


@given(moments, st.tuples(*[st.floats(-3, 3)] * 3))
def test_full_inertia_matrices_keep_their_meaning(
    principal: tuple[float, float, float], rpy: tuple[float, ...]
) -> None:
    from gz_course.sim.gz.sim.pose import matrix

    turn = matrix(Pose.from_rpy((0, 0, 0), rpy).quaternion)
    full = turn @ np.diag(principal) @ turn.T
    tags = {
        "ixx": full[0, 0],
        "iyy": full[1, 1],
        "izz": full[2, 2],
        "ixy": full[0, 1],
        "ixz": full[0, 2],
        "iyz": full[1, 2],
    }
    inertia = "".join(
        f"<{tag}>{value!r}</{tag}>".replace("np.float64(", "").replace(")", "") for tag, value in tags.items()
    )
    world = World.from_string(
        "<sdf version='1.9'><world name='w'><model name='m'><link name='l'><inertial><pose>0 0 0 "
        "0.3 0.2 0.1</pose>"
        f"<inertia>{inertia}</inertia></inertial></link></model></world></sdf>"
    )
    body = world.model.body("m::l")
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, body.iquat)
    axes = axes.reshape(3, 3)
    tilt = matrix(Pose.from_rpy((0, 0, 0), (0.3, 0.2, 0.1)).quaternion)
    assert np.allclose(axes @ np.diag(body.inertia) @ axes.T, tilt @ full @ tilt.T, atol=1e-5)


def test_links_of_one_model_do_not_collide_unless_asked(load_text: Load) -> None:
    part = (
        "<link name='{}'><collision name='c'><geometry><sphere><radius>0.5</radius></sphere>"
        "</geometry></collision></link>"
    )
    both = part.format("a") + part.format("b")
    apart = load_text(f"<model name='m'>{both}</model>")
    touching = load_text(f"<model name='m'><self_collide>1</self_collide>{both}</model>")
    assert apart.data.ncon == 0 and touching.data.ncon == 1


def test_a_second_joint_closes_a_loop(load_text: Load) -> None:
    links = (
        "<link name='a'/><link name='b'><pose>1 0 0 0 0 0</pose></link><link name='c'><pose>2 0 0 0 0 0</pose></link>"
    )
    joint = (
        "<joint name='{0}{1}' type='revolute'><parent>{0}</parent><child>{1}</child><axis>"
        "<xyz>0 0 1</xyz></axis></joint>"
    )
    joints = joint.format("a", "b") + joint.format("b", "c") + joint.format("c", "a")
    world = load_text(f"<model name='m'>{links}{joints}</model>")
    assert world.model.neq == 1
    world.step(100)
    reach = world.truth.link_pose("m", "c").position - world.truth.link_pose("m", "a").position
    assert np.linalg.norm(reach) == pytest.approx(2.0, abs=1e-2)


def test_friction_ranks_are_highest_for_the_lowest() -> None:
    assert recipe.friction_ranks([1.0, 0.2, 1.0, 100.0]) == {100.0: 0, 1.0: 1, 0.2: 2}


def test_what_mujoco_refuses_is_one_sentence(load_text: Load) -> None:
    with pytest.raises(SdfError, match=r"^<string>:\d+: .* refuses link 'l' of model 'm'"):
        load_text("<model name='m'><link name='l'><inertial><mass>1e-300</mass></inertial></link></model>")


def test_more_moving_links_than_physics_can_take_are_refused(load_text: Load, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.physics.builder.MOST_MOVING", 3)
    models = "".join(box(f"m{n}", f"{n} 0 0 0 0 0", 1, n > 2) for n in range(9))
    assert len(load_text(models).truth.model_names()) == 3
    with pytest.raises(SdfError, match="the world has 4 links that move, more than 3"):
        load_text(models + box("one_more", "0 0 9 0 0 0", 1, False))
