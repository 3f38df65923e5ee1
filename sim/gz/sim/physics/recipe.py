"""Solver, contact and wheel servo parameters that make MuJoCo drive wheeled robots as Gazebo does.

Measured with four robots from 1 to 140 kg: steady speed and yaw rate are within 0.25 % at steps of 1 to 4 ms
(`tests/bench/bench_physics.py`). With softer contacts light robots hop or turn up to 30 % too slowly.

Source: https://mujoco.readthedocs.io/en/stable/modeling.html (solver parameters)
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import mujoco

GRAVITY = 9.8
"""Gazebo's default gravity [m/s^2]; the gain of wheel servos is proportional to the weight on the wheels."""

SLIP_SPEED = 0.01
"""Speed error [m/s] at the rim at which a wheel servo applies the full traction of its share of the weight."""

SERVO_GIVE = 1e-3
"""Speed error of a joint servo under a load, relative to the speed change of a free joint under that load in one step.
In measurements a stiffer servo was not better, and a softer one let an arm sink slowly.
"""

CONTACT_IMPEDANCE = (0.95, 0.97)
"""Impedance of a contact at zero and at full penetration. With these values a wheel sinks in by less than 0.25 % of its
radius, which is also the error of its speed; with MuJoCo's defaults it is up to 0.7 % at steps of 4 ms.
"""

SKIDDING = 0.1
"""Friction of a tyre along its axle, relative to the friction in the direction in which it rolls, for robots that must
skid to turn. A robot that is L long and W wide between its tyres turns with 1 / (1 + (SKIDDING L / W)^2) of the
commanded rate.
"""

BOUNCE_STEPS = 8.0
"""Duration of a bounce, in steps."""


def apply_options(spec: mujoco.MjSpec, step: float, gravity: tuple[float, float, float], *, bounces: bool) -> None:
    """Set time step [s], gravity [m/s^2], integrator and friction cone of a spec; shapes of the world may bounce."""
    option = spec.option
    option.timestep = step
    option.gravity = gravity
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST if bounces else mujoco.mjtIntegrator.mjINT_DISCRETE
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = 10.0
    spec.compiler.degree = False
    spec.compiler.autolimits = False


def contact_solref(step: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of a contact.

    Less damping ejects bodies that start inside the ground; more damping lets light robots rock at steps of 4 ms.
    """
    return max(0.004, 2.0 * step), 2.0


def bouncing_solref(step: float, restitution: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of a contact that returns a body with `restitution` times its speed.

    The contact is a damped spring that cannot pull: the body leaves it when the force ends.
    """
    low, high = 1e-4, 1.0 / math.sqrt(2.0)
    for _ in range(50):
        ratio = (low + high) / 2.0
        low, high = (ratio, high) if _returned(ratio) > restitution else (low, ratio)
    frequency = math.pi / (BOUNCE_STEPS * step * math.sqrt(1.0 - ratio * ratio))
    return 1.0 / (ratio * frequency), ratio


def _returned(ratio: float) -> float:
    """Return the fraction of its speed with which a body leaves a spring of this damping ratio."""
    root = math.sqrt(1.0 - ratio * ratio)
    angle = math.pi - math.atan2(2.0 * ratio * root, 1.0 - 2.0 * ratio * ratio)
    return math.exp(-ratio / root * angle)


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
    """Return the rotor inertia [kg m^2] of a wheel joint, which it needs with the integrator `implicitfast`."""
    return mass / sharing * radius * radius
