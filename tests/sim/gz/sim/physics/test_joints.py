"""Every kind of joint moves as specified in SDF: single, coupled, in loops, between models, from initial positions."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gz_course.sim.gz.sim.pose import matrix
from gz_course.sim.gz.sim.world import World

Load = Callable[..., World]
SMALL = "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>"


def link(name: str, pose: str = "0 0 0 0 0 0", more: str = "") -> str:
    return f"<link name='{name}'><pose>{pose}</pose><gravity>0</gravity>{SMALL}{more}</link>"


def joint(name: str, kind: str, parent: str, child: str, inside: str = "", pose: str = "") -> str:
    place = f"<pose>{pose}</pose>" if pose else ""
    return f"<joint name='{name}' type='{kind}'>{place}<parent>{parent}</parent><child>{child}</child>{inside}</joint>"


def axis(xyz: str, inside: str = "", tag: str = "axis") -> str:
    return f"<{tag}><xyz>{xyz}</xyz>{inside}</{tag}>"


HELD = link("base") + joint("hold", "fixed", "world", "base")


def degree(world: World, name: str) -> int:
    return int(world.model.joint(name).dofadr[0])


def angle(world: World, name: str) -> float:
    return float(world.data.qpos[world.model.joint(name).qposadr[0]])


@pytest.mark.parametrize(
    ("pitch", "advance"),
    [
        ("<screw_thread_pitch>0.5</screw_thread_pitch>", 0.5),
        ("<thread_pitch>-4</thread_pitch>", 2 * math.pi / 4),
        ("<thread_pitch>9</thread_pitch><screw_thread_pitch>-0.5</screw_thread_pitch>", -0.5),
        ("", 1.0),
    ],
)
def test_a_screw_advances_by_its_pitch_at_each_turn(load_text: Load, pitch: str, advance: float) -> None:
    inside = axis("0 0 1") + pitch
    world = load_text(f"<model name='m'>{HELD}{link('nut')}{joint('screw', 'screw', 'base', 'nut', inside)}</model>")
    assert world.warnings == []
    world.data.qvel[degree(world, "m::screw")] = 4.0
    world.data.qvel[degree(world, "m::screw#slide")] = 4.0 * advance / (2 * math.pi)
    world.step(1500)
    turned = angle(world, "m::screw")
    assert turned > 3.0
    assert world.truth.link_pose("m", "nut").position[2] == pytest.approx(turned * advance / (2 * math.pi), rel=1e-2)


@pytest.mark.parametrize("kind", ["universal", "revolute2"])
def test_two_axes_turn_one_after_the_other(load_text: Load, kind: str) -> None:
    inside = axis("0 0 1") + axis("1 0 0", tag="axis2")
    world = load_text(f"<model name='m'>{HELD}{link('l')}{joint('j', kind, 'base', 'l', inside)}</model>")
    world.data.qpos[world.model.joint("m::j").qposadr[0]] = math.pi / 2
    world.data.qpos[world.model.joint("m::j#2").qposadr[0]] = 0.3
    world.step()
    turn = matrix(world.truth.link_pose("m", "l").quaternion)
    # After the rotation about z the second axis is y.
    assert turn[:, 0] == pytest.approx((0, 1, 0), abs=1e-6)
    assert turn[:, 2] == pytest.approx((math.sin(0.3), 0, math.cos(0.3)), abs=1e-6)


def test_a_ball_turns_about_everything(load_text: Load) -> None:
    world = load_text(f"<model name='m'>{HELD}{link('l')}{joint('j', 'ball', 'base', 'l')}</model>")
    assert world.model.joint("m::j").dofadr.shape and world.model.nv == 3


@pytest.mark.parametrize(("kind", "expected"), [("revolute", (0, 1, 0.2)), ("prismatic", (1, 0, 0.7))])
def test_a_joint_starts_at_its_initial_position(load_text: Load, kind: str, expected: tuple[float, ...]) -> None:
    start = math.pi / 2 if kind == "revolute" else 0.5
    inside = axis(
        "0 0 1", f"<initial_position>{start}</initial_position><limit><lower>-3</lower><upper>3</upper></limit>"
    )
    hand = link("hand", "2 0 0.2 0 0 0") + joint("grip", "fixed", "arm", "hand")
    arm = link("arm", "1 0 0.2 0 0 0") + joint("j", kind, "base", "arm", inside, "-1 0 0 0 0 0")
    world = load_text(f"<model name='m'>{HELD}{hand}{arm}</model>")
    assert angle(world, "m::j") == pytest.approx(start)
    assert world.truth.link_pose("m", "arm").position == pytest.approx(expected, abs=1e-9)
    far = (0, 2, 0.2) if kind == "revolute" else (2, 0, 0.7)
    assert world.truth.link_pose("m", "hand").position == pytest.approx(far, abs=1e-9)
    world.step(50)
    assert angle(world, "m::j") == pytest.approx(start, abs=1e-6)


def test_a_mimic_follows_its_leader(load_text: Load) -> None:
    follow = "<mimic joint='a'><multiplier>-2</multiplier><offset>0.3</offset><reference>0.1</reference></mimic>"
    model = (
        HELD + link("la") + link("lb")
        + joint("a", "revolute", "base", "la", axis("0 0 1", "<initial_position>0.4</initial_position>"))
        + joint("b", "prismatic", "base", "lb", axis("0 0 1", f"<initial_position>-0.3</initial_position>{follow}"))
    )  # fmt: skip
    world = load_text(f"<model name='m'><model name='inner'>{model}</model></model>")
    assert angle(world, "m::inner::b") == pytest.approx(-0.3)
    world.data.qvel[degree(world, "m::inner::a")] = 0.5
    world.step(2000)
    assert angle(world, "m::inner::a") > 0.41
    assert angle(world, "m::inner::b") == pytest.approx(-2 * (angle(world, "m::inner::a") - 0.1) + 0.3, abs=1e-3)


@pytest.mark.parametrize(
    ("mimic", "sentence"),
    [
        ("<mimic joint='aa'/>", "did you mean 'a'"),
        ("<mimic joint='a' axis='axis2'/>", "without <axis2>"),
        ("<mimic joint='b'/>", "follows itself"),
        ("<mimic/>", "needs the attribute joint"),
        ("<mimic joint='a'><multiplier>inf</multiplier></mimic>", "finite"),
    ],
)
def test_a_mimic_of_nothing_is_refused(load_text: Load, mimic: str, sentence: str) -> None:
    joints = joint("a", "revolute", "base", "la", axis("0 0 1")) + joint(
        "b", "revolute", "base", "lb", axis("0 0 1", mimic)
    )
    with pytest.raises(ValueError, match=sentence):
        load_text(f"<model name='m'>{HELD}{link('la')}{link('lb')}{joints}</model>")


@pytest.mark.parametrize(("flip", "sign"), [("0 0 1", -1.0), ("0 0 -1", 1.0)])
def test_a_gearbox_turns_its_child_backwards(load_text: Load, flip: str, sign: float) -> None:
    gear = axis("0 0 1") + axis("0 0 1", tag="axis2") + (
        "<gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>base</gearbox_reference_body>"
    )  # fmt: skip
    model = (
        HELD + link("one") + link("two", "1 0 0 0 0 0")
        + joint("a", "revolute", "base", "one", axis("0 0 1")) + joint("b", "revolute", "base", "two", axis(flip))
        + joint("g", "gearbox", "one", "two", gear)
    )  # fmt: skip
    world = load_text(f"<model name='m'>{model}</model>")
    assert world.warnings == []
    world.data.qvel[degree(world, "m::a")] = 1.0
    world.step(1500)
    assert abs(angle(world, "m::a")) > 0.1
    assert angle(world, "m::b") == pytest.approx(sign * 3 * angle(world, "m::a"), rel=2e-2)


def test_a_gearbox_without_its_hinges_says_so(load_text: Load) -> None:
    gear = joint("g", "gearbox", "base", "l", axis("0 0 1") + axis("0 0 1", tag="axis2"))
    free = link("l", "1 0 1 0 0 0").replace("<gravity>0</gravity>", "")
    world = load_text(f"<model name='m'>{HELD}{free}{gear}</model>")
    assert len(world.warnings) == 1 and "gearbox 'g' needs revolute joints" in world.warnings[0]
    world.step(300)
    assert world.truth.link_pose("m", "l").position == pytest.approx((1, 0, 1), abs=2e-3)


def test_a_loop_of_a_fixed_joint_is_welded_and_a_sliding_one_is_left_out(load_text: Load) -> None:
    heavy = link("far", "1 0 1 0 0.4 0").replace("<gravity>0</gravity>", "")
    held = HELD + heavy + joint("j", "ball", "base", "far", pose="-1 0 -1 0 0 0")
    for parent in ("base", "world"):
        world = load_text(
            f"<model name='m'><pose>0 3 0 0 0 1</pose>{held}{joint('again', 'fixed', parent, 'far')}</model>"
        )
        before = world.truth.link_pose("m", "far")
        world.step(500)
        assert world.model.neq == 1 and before.is_close(world.truth.link_pose("m", "far"), 2e-3)
    world = load_text(f"<model name='m'>{held}{joint('again', 'prismatic', 'base', 'far', axis('0 0 1'))}</model>")
    assert world.model.neq == 0 and "prismatic joint 'again' closes a loop" in world.warnings[0]


def falls(name: str, pose: str, static: bool = False) -> str:
    return f"<model name='{name}'><static>{static}</static><pose>{pose}</pose><link name='l'>{SMALL}</link></model>"


def test_joints_of_the_world_hold_models_together(load_text: Load) -> None:
    swing = joint("swing", "revolute", "rack::l", "bob", axis("0 1 0"), "0 0 1 0 0 0")
    weld = joint("weld", "fixed", "bob::l", "tail::l")
    models = falls("tail", "1 0 1 0 0 0") + falls("bob", "1 0 2 0 0 0") + falls("rack", "0 0 3 0 0 0", True)
    world = load_text(models + swing + weld)
    assert world.warnings == [] and world.model.nv == 1
    top = np.array((1, 0, 3))
    for _ in range(5):
        world.step(100)
        bob, tail = world.truth.pose("bob"), world.truth.pose("tail")
        assert np.linalg.norm(bob.position - top) == pytest.approx(1.0, abs=1e-6)
        assert (bob.inverse() * tail).position == pytest.approx((0, 0, -1), abs=1e-6)


def test_a_joint_of_the_world_to_a_link_that_hangs_already_is_a_constraint(load_text: Load) -> None:
    arm = f"<model name='arm'>{HELD}{link('l', '0 0 1 0 0 0')}{joint('j', 'ball', 'base', 'l')}</model>"
    world = load_text(arm + falls("other", "0 0 1 0 0 0") + joint("between", "ball", "other::l", "arm::l"))
    assert world.model.neq == 1
    world.step(300)
    assert world.truth.pose("other").position == pytest.approx(world.truth.link_pose("arm", "l").position, abs=5e-3)


def test_a_loop_is_closed_at_the_place_of_its_joint(load_text: Load) -> None:
    heavy = link("rod", "1 0 2 0 0.3 0").replace("<gravity>0</gravity>", "")
    held = HELD + heavy + joint("hang", "ball", "base", "rod", pose="0 0 1 0 0 0")
    world = load_text(f"<model name='m'>{held}{joint('pin', 'ball', 'world', 'rod', pose='0.5 0 -0.7 0 0 0')}</model>")
    place = world.truth.link_pose("m", "rod").transform((0.5, 0, -0.7))
    world.data.qvel[degree(world, "m::hang") :][:3] = (0.5, 0.4, 0.3)
    world.step(300)
    assert world.model.neq == 1
    assert world.truth.link_pose("m", "rod").transform((0.5, 0, -0.7)) == pytest.approx(place, abs=5e-3)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (joint("j", "fixed", "a", "nobody"), "'nobody', which the world does not have"),
        (joint("j", "fixed", "a", "a"), "with itself"),
        (joint("j", "revolute", "world", "a", axis("0 0 1", "<mimic joint='x'/>")), "cannot have a <mimic>"),
    ],
)
def test_joints_of_the_world_that_make_no_sense(load_text: Load, text: str, sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        load_text(falls("a", "0 0 0 0 0 0") + text)


def test_a_static_model_inside_a_moving_one_stays(load_text: Load) -> None:
    still = f"<model name='post'><static>1</static><pose>1 0 0 0 0 0</pose><link name='l'>{SMALL}</link></model>"
    world = load_text(f"<model name='m'><pose>0 0 2 0 0 0</pose><link name='l'>{SMALL}</link>{still}</model>")
    world.step(300)
    assert world.truth.link_pose("m", "post::l").position == pytest.approx((1, 0, 2))
    assert world.truth.pose("m").position[2] < 1.7


def test_a_chain_that_is_too_long_is_refused(load_text: Load) -> None:
    links = "".join(link(f"l{n}") for n in range(1200))
    joints = "".join(joint(f"j{n}", "revolute", f"l{n}", f"l{n + 1}", axis("0 0 1")) for n in range(1199))
    with pytest.raises(ValueError, match="more than 1000 links hang on each other in a row at link 'l1000'"):
        load_text(f"<model name='m'>{links}{joints}</model>")
