"""Solver, contact and wheel servo parameters that make MuJoCo drive wheeled robots as Gazebo does.

Measured with four robots from 1 to 140 kg: steady speed and yaw rate are within 0.25 % at steps of 1 to 4 ms
(`tests/bench/bench_physics.py`). With softer contacts light robots hop or turn up to 30 % too slowly.

Source: https://mujoco.readthedocs.io/en/stable/modeling.html (solver parameters)
"""

from __future__ import annotations

from collections.abc import Iterable

import mujoco

GRAVITY = 9.8
"""Gazebo's default gravity (m/s^2); the wheel servo is scaled with the weight the wheels carry."""

SLIP_SPEED = 0.01
"""Speed error (m/s at the rim) at which a wheel servo pushes with the full traction its share of the weight
gives.
"""

SERVO_GIVE = 1e-3
"""How much a load may slow a joint servo, as a fraction of what it does to a free joint in one step. Measured: stiffer
gains nothing, softer lets an arm creep.
"""

CONTACT_IMPEDANCE = (0.95, 0.97)
"""Impedance of a contact that just touches and of one pressed in: so hard that a wheel sinks in by less than 0.25 % of
its radius, which is its error in speed (with MuJoCo's default up to 0.7 % at steps of 4 ms).
"""

DISCRETE = True
"""Use MuJoCo's `discrete` integrator. With False, `implicitfast` and a rotor inertia on the wheels give the
same numbers.
"""


def apply_options(spec: mujoco.MjSpec, step: float, gravity: tuple[float, float, float]) -> None:
    """Set time step [s], gravity [m/s^2], integrator and friction cone of a spec."""
    option = spec.option
    option.timestep = step
    option.gravity = gravity
    option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE if DISCRETE else mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0
    spec.compiler.degree = False
    spec.compiler.autolimits = False


def contact_solref(step: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of a contact.

    Less damping ejects bodies that start inside the ground; more damping lets light robots rock at steps of 4 ms.
    """
    return max(0.004, 2.0 * step), 2.0


def friction_ranks(coefficients: Iterable[float]) -> dict[float, int]:
    """Return the geom priority of each friction coefficient: the lowest coefficient has the highest priority.

    Gazebo uses the smaller coefficient of the two surfaces, MuJoCo the one of the geom with higher priority.
    """
    ordered = sorted(set(coefficients), reverse=True)
    return {coefficient: rank for rank, coefficient in enumerate(ordered)}


def wheel_gain(mass: float, sharing: int, radius: float) -> float:
    """Return the servo gain kv [N m s/rad] of one of `sharing` driven wheels under a model of `mass` [kg]."""
    return mass * GRAVITY / sharing * radius * radius / SLIP_SPEED


def servo_gain(inverse_inertia: float, step: float) -> float:
    """Return the gain kv of a servo that holds the velocity of a joint against loads.

    `inverse_inertia` is MuJoCo's `dof_invweight0` of the joint [1/(kg m^2) or 1/kg]. A load causes a speed error of
    SERVO_GIVE times the speed change it would cause in one free `step` [s].
    """
    return 1.0 / (max(inverse_inertia, 1e-12) * step * SERVO_GIVE)


def strongest_push(inverse_inertia: float) -> float:
    """Return the largest force [N m or N] of a motor: it accelerates a free joint by 1e6 rad/s^2 or m/s^2, more than
    any machine, and keeps the solver stable.
    """
    return 1e6 / max(inverse_inertia, 1e-12)


def wheel_armature(mass: float, sharing: int, radius: float) -> float:
    """Return the rotor inertia [kg m^2] of a wheel joint; zero with the discrete integrator."""
    return 0.0 if DISCRETE else mass / sharing * radius * radius
