"""LiftDrag: the force of a wing at an angle of attack, in the wind and beyond the stall."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.systems.lift_drag import LiftDrag
from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.systems.floating_world import body
from gz_course.tests.sim.gz.sim.systems.motion_world import arm, plugin, world

WING = "<link_name>l</link_name><cla>4</cla><cda>0.5</cda><air_density>1.2</air_density><area>2</area>"
STALL = "<alpha_stall>0.2</alpha_stall><cla_stall>-3</cla_stall><cda_stall>1</cda_stall>"
X, Z = np.array((1.0, 0, 0)), np.array((0, 0, 1.0))


def wing(inside: str = WING, more: str = "") -> World:
    return world(more + body(plugins=plugin("LiftDrag", inside)), gravity="0 0 0")


def system(made: World) -> LiftDrag:
    return next(each for each in made.systems if isinstance(each, LiftDrag))


def flow(alpha: float, speed: float = 10.0) -> Any:
    """Return the velocity of a wing that goes along x with its nose up by `alpha` [rad]."""
    return speed * np.array((math.cos(alpha), 0.0, -math.sin(alpha)))


def test_lift_and_drag_grow_with_the_angle_of_attack() -> None:
    lifting = system(wing())
    q = 0.5 * 1.2 * 10.0**2 * 2.0
    for alpha in (0.1, -0.1):
        force = lifting.force(flow(alpha), X, Z)
        along, across = force @ flow(alpha) / 10.0, force @ np.array((math.sin(alpha), 0, math.cos(alpha)))
        assert across == pytest.approx(4 * alpha * q)
        assert along == pytest.approx(-0.5 * abs(alpha) * q)
    assert not lifting.force(flow(0.1, 0.009), X, Z).any()
    swept = flow(0.1) + np.array((0.0, 10.0, 0.0))
    assert np.linalg.norm(lifting.force(swept, X, Z)) == pytest.approx(
        np.linalg.norm(lifting.force(flow(0.1), X, Z)) / 2
    )


def test_beyond_the_stall_the_slopes_are_others() -> None:
    lifting, q = system(wing(WING + STALL)), 120.0
    for alpha, lift, drag in ((0.25, 0.8 - 0.15, 0.1 + 0.05), (-0.25, -0.65, 0.15), (0.6, 0.0, 0.5)):
        force = lifting.force(flow(alpha), X, Z)
        assert force @ flow(alpha) / 10.0 == pytest.approx(-drag * q)
        assert force @ np.array((math.sin(alpha), 0, math.cos(alpha))) == pytest.approx(lift * q, abs=1e-9)


def test_a_round_body_is_lifted_in_the_plane_of_its_flow() -> None:
    lifting = system(wing(WING + "<radial_symmetry>true</radial_symmetry>"))
    rolled = np.array((flow(0.1)[0], flow(0.1)[2], 0.0))
    assert np.linalg.norm(lifting.force(rolled, X, Z)) == pytest.approx(np.linalg.norm(lifting.force(flow(0.1), X, Z)))


def test_the_force_acts_at_the_centre_of_pressure() -> None:
    made = wing(WING + "<cp>0.5 0 0</cp><a0>0.1</a0>")
    made.data.qvel[0] = 10.0
    made.step(1)
    lift = 4 * 0.1 * 120.0
    assert made.truth.velocity("a").linear[2] == pytest.approx(lift / 10 * 0.001)
    assert made.truth.velocity("a").angular[1] == pytest.approx(-0.5 * lift / 1.0 * 0.001)


def test_the_wind_lifts_a_wing_at_rest() -> None:
    made = wing(WING + "<a0>0.1</a0>", "<wind><linear_velocity>-10 0 0</linear_velocity></wind>")
    made.step(1)
    assert made.truth.velocity("a").linear[2] == pytest.approx(4 * 0.1 * 120.0 / 10 * 0.001)


def test_a_control_joint_adds_to_the_lift() -> None:
    parameters = WING.replace(">l<", ">lower<") + "<control_joint_name>elbow</control_joint_name>"
    made = world(arm(plugin("LiftDrag", parameters + "<upward>0 1 0</upward>")), gravity="0 0 0")
    assert not made.warnings
    axis = system(made)._axis
    assert axis is not None and axis.read_position(made.data) == 0.0
    assert system(made).force(flow(0.0), X, Z, 0.3) @ Z == pytest.approx(0.3 * 120.0)


def test_a_wing_is_a_link() -> None:
    with pytest.raises(SdfError, match="LiftDrag needs a <link_name>"):
        wing("")
    with pytest.raises(SdfError, match="<forward> must be a direction, got '0 0 0'"):
        wing(WING + "<forward>0 0 0</forward>")
    assert "names link 'm', which model 'a' does not have" in wing(WING.replace(">l<", ">m<")).warnings[0]
