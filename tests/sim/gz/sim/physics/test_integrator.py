"""Bodies without drives keep their energy."""

from __future__ import annotations

import mujoco
import pytest

from gz_course.sim.gz.sim.world import World

WORLD = """<sdf version='1.10'><world name='w'><physics type='x'><max_step_size>0.001</max_step_size></physics>
<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>{inside}</world></sdf>"""
BODY = """<link name='{name}'><pose>0 0 {z} 0 0 0</pose><inertial><pose>0 0 -0.5 0 0 0</pose><mass>1</mass><inertia>
<ixx>0.08</ixx><iyy>0.075</iyy><izz>0.01</izz></inertia></inertial></link>"""
HINGE = """<joint name='to_{child}' type='revolute'><parent>{parent}</parent><child>{child}</child>
<axis><xyz>0 1 0</xyz>{dynamics}</axis></joint>"""


def pendulum(dynamics: str = "") -> World:
    links = BODY.format(name="a", z=3) + BODY.format(name="b", z=2)
    joints = HINGE.format(parent="world", child="a", dynamics="") + HINGE.format(
        parent="a", child="b", dynamics=dynamics
    )
    return World.from_string(WORLD.format(inside=f"<model name='m'>{links}{joints}</model>"))


def energy(world: World) -> float:
    mujoco.mj_energyPos(world.model, world.data)
    mujoco.mj_energyVel(world.model, world.data)
    return float(world.data.energy.sum())


def test_a_tumbling_body_keeps_its_energy() -> None:
    inside = f"<gravity>0 0 0</gravity><model name='m'>{BODY.format(name='a', z=1)}</model>"
    world = World.from_string(WORLD.format(inside=inside))
    world.data.qvel[3:] = (1.0, 5.0, 0.3)
    before = energy(world)
    world.step(10_000)
    assert energy(world) == pytest.approx(before, rel=1e-6)


@pytest.mark.proof
def test_a_double_pendulum_keeps_its_energy() -> None:
    world = pendulum()
    world.data.qpos[:] = (1.5, 0.5)
    mujoco.mj_forward(world.model, world.data)
    before, peak = energy(world), 2 * 9.8
    for _ in range(30):
        world.step(1000)
        assert abs(energy(world) - before) < 1e-4 * peak


def test_what_is_stiff_or_driven_keeps_the_integrator_that_holds_it() -> None:
    kinds = mujoco.mjtIntegrator
    assert pendulum().model.opt.integrator == kinds.mjINT_RK4
    assert pendulum("<dynamics><damping>0.1</damping></dynamics>").model.opt.integrator == kinds.mjINT_RK4
    assert pendulum("<dynamics><damping>100</damping></dynamics>").model.opt.integrator == kinds.mjINT_DISCRETE
    springy = "<dynamics><spring_stiffness>1e6</spring_stiffness></dynamics>"
    assert pendulum(springy).model.opt.integrator == kinds.mjINT_DISCRETE
    assert World.load("sensors.sdf").model.opt.integrator == kinds.mjINT_DISCRETE
    assert World.load("lidar_room.sdf").model.opt.integrator == kinds.mjINT_DISCRETE
    assert World.load("empty.sdf").model.opt.integrator == kinds.mjINT_DISCRETE
