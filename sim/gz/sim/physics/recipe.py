"""Solver, contact and wheel servo parameters that make MuJoCo drive wheeled robots as Gazebo does.

Measured with four robots from 1 to 140 kg: steady speed and yaw rate are within 0.35 % at steps of 1 to 4 ms
(`tests/bench/bench_physics.py`).

Source: https://mujoco.readthedocs.io/en/stable/modeling.html (solver parameters)
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import mujoco

GRAVITY = 9.8
"""Gazebo's default gravity [m/s^2]; the gain of wheel servos is proportional to the weight on the wheels."""

SLIP_SPEED = 0.0005
"""Speed error [m/s] at the rim at which a wheel servo applies the full traction of its share of the weight. Parked on a
slope, a robot creeps with this speed times the sine of the slope.
"""

SOFT_SLIP_SPEED = 0.01
"""SLIP_SPEED [m/s] with the integrator `implicitfast`, which does not see how stiff a servo is when it solves contacts:
wheels with a stiffer one jump at steps of 4 ms.
"""

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

JOINT_FRICTION_IMPEDANCE = (0.9999, 0.99999)
"""Impedance of the friction of a joint: under a load below it, the joint creeps with less than 1e-4 rad/s. With the
default of MuJoCo it creeps with 0.02 rad/s, however large the friction is.
"""

GRIPPING = 100.0
"""Rate [1/s] at which the friction of a body on the ground takes away its sliding speed; at more it is the whole
friction.

MuJoCo's friction cone is convex, so a contact that slides with speed v is also pushed apart, with friction times rate
times v [m/s^2]. A contact resists that with its give, (1 - impedance) / impedance times its load: beyond it, the body
hops. At the rate of all other contacts, 500/s, a pushed box hops by 2 cm, and a wheel that spins before a wall makes
the speed of its robot noisy.
"""

GROUND_IMPEDANCE = 0.5
"""Impedance of a contact with the ground at steps of 1 ms, which lets it slide without hops. Its depth is a few
hundredths of a millimetre, because the contact is as stiff as the step allows (`ground_solref`).
"""

DRAGGING = 2.0
"""GRIPPING [1/s] of a rigid caster. At 100/s a caster of friction 1 hops, takes the load off the driven wheels, and its
robot drives at a third of its speed.
"""

SLIPPERY = 0.02
"""Friction up to which a rigid caster is one of all contacts: it does not hop, and loads the servos little."""

FRICTION_RATIO = 1000.0
"""Stiffness of friction relative to that of the contact: under a load below the friction nothing slides by more than
0.1 mm/s.
"""

BOUNCE_STEPS = 8.0
"""Duration of a bounce, in steps."""

_WEAK = 1.0 / math.sqrt(2.0)  # damping ratio of a contact that returns a fifth of the speed


def apply_options(spec: mujoco.MjSpec, step: float, gravity: tuple[float, float, float], *, bounces: bool) -> None:
    """Set time step [s], gravity [m/s^2], integrator and friction cone of a spec; shapes of the world may bounce."""
    option = spec.option
    option.timestep = step
    option.gravity = gravity
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST if bounces else mujoco.mjtIntegrator.mjINT_DISCRETE
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = FRICTION_RATIO
    spec.compiler.degree = False
    spec.compiler.autolimits = False


def contact_solref(step: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of a contact.

    Less damping ejects bodies that start inside the ground; more damping lets light robots rock at steps of 4 ms.
    """
    return max(0.004, 2.0 * step), 2.0


def ground_solref(step: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of a contact with the ground: the stiffest that is stable, and the
    least damped that does not rebound.
    """
    return 2.0 * step, 1.7


def ground_impedance(step: float) -> tuple[float, float]:
    """Return the impedance of a contact with the ground at zero and at full penetration.

    The depth of a contact grows with the square of the step; longer steps than 1 ms have a larger impedance instead.
    """
    give = (1.0 - GROUND_IMPEDANCE) * min(1.0, (0.001 / step) ** 2)
    return 1.0 - give, max(1.0 - give, CONTACT_IMPEDANCE[1])


def joint_solref(step: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of the limits and of the friction of a joint."""
    return contact_solref(step)[0], 1.0


def bouncing_solref(step: float, restitution: float) -> tuple[float, float]:
    """Return time constant [s] and damping ratio of a contact that returns a body with `restitution` times its speed.

    The contact is a damped spring that cannot pull: the body leaves it when the force ends. With the ratio 2 it returns
    5 % in theory, and nothing at steps as long as these.
    """
    low, high = (1e-4, _WEAK) if restitution >= _returned(_WEAK) else (_WEAK, 2.0)
    for _ in range(50):
        ratio = (low + high) / 2.0
        low, high = (ratio, high) if _returned(ratio) > restitution else (low, ratio)
    frequency = math.pi / (BOUNCE_STEPS * step * math.sqrt(max(1.0 - ratio * ratio, 0.5)))
    return 1.0 / (ratio * frequency), ratio


def _returned(ratio: float) -> float:
    """Return the fraction of its speed with which a body leaves a spring of this damping ratio."""
    root = math.sqrt(abs(1.0 - ratio * ratio))
    if root < 1e-6:
        return math.exp(-2.0)
    if ratio > 1.0:
        angle = math.atanh(2.0 * ratio * root / (2.0 * ratio * ratio - 1.0))
    else:
        angle = math.pi - math.atan2(2.0 * ratio * root, 1.0 - 2.0 * ratio * ratio)
    return math.exp(-ratio / root * angle)


def friction_ranks(coefficients: Iterable[float]) -> dict[float, int]:
    """Return the geom priority of each friction coefficient: the lowest coefficient has the highest priority.

    Gazebo uses the smaller coefficient of the two surfaces, MuJoCo the one of the geom with higher priority.
    """
    ordered = sorted(set(coefficients), reverse=True)
    return {coefficient: rank for rank, coefficient in enumerate(ordered)}


def gripping(step: float) -> float:
    """Return the rate [1/s] of the friction of a body on the ground: at steps longer than 1 ms, with their larger
    impedance, nearer to that of other contacts.
    """
    return GRIPPING * min(3.0, max(1.0, step / 0.001))


def friction_solref(rate: float) -> tuple[float, float]:
    """Return stiffness and damping of friction that takes away a sliding speed at `rate` [1/s], both negative as MuJoCo
    takes them.
    """
    return -1.0, -rate


def wheel_gain(mass: float, sharing: int, radius: float, *, soft: bool = False) -> float:
    """Return the servo gain kv [N m s/rad] of one of `sharing` driven wheels under a model of `mass` [kg]; `soft` for
    the integrator `implicitfast`.
    """
    return mass * GRAVITY / sharing * radius * radius / (SOFT_SLIP_SPEED if soft else SLIP_SPEED)


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
