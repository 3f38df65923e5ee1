"""MuJoCo actuators for the joints that systems drive; a system writes their controls before every step.

`System.servos` returns the joints a system drives, the builder adds actuators with `add_servo`, and `System.bind` looks
them up with `find_drive`. Servos hold a velocity (`WHEEL`, `VELOCITY`), motors apply a force (`FORCE`, `APPLIED`).

Source: https://mujoco.readthedocs.io/en/stable/computation/index.html (actuation model)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco

from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.physics.joint_axis import JointAxis, axis_name, find_axes
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Axis, Model

WHEEL = "wheel"
"""A velocity servo for wheels that carry a robot; its torque is limited by the traction (see `recipe`)."""
VELOCITY = "velocity"
"""A velocity servo that holds against any load, as in Gazebo."""
FORCE = "force"
"""A motor that applies the force computed by a controller."""
APPLIED = "applied"
"""A motor that applies a force in addition to other actuators."""

FASTEST = 1e4
"""Maximum commanded speed of any joint [rad/s or m/s]."""

MAX_WHEEL_SPEED = 200.0
"""Maximum commanded speed of a driven wheel [rad/s], higher than that of any real wheel; above it steps of 1 ms are
inaccurate.
"""

_NOTHING = 1e-12  # the least limit of an actuator [rad/s, m/s, N m or N]
_SUFFIX = {WHEEL: "", VELOCITY: "", FORCE: "#force", APPLIED: "#applied"}


@dataclass(frozen=True)
class JointServo:
    """A system's request to drive a joint.

    `joint` is the scoped name, `radius` [m] that of a wheel, `sharing` the number of driven wheels, `effort` [N m or N]
    the maximum force, `axis` 1 the second axis of a joint that has two. A wheel that `skids` moves sideways in turns.
    """

    joint: str
    kind: str = VELOCITY
    radius: float = 0.0
    sharing: int = 1
    effort: float = math.inf
    axis: int = 0
    skids: bool = False

    @property
    def actuator(self) -> str:
        """Return the scoped name of the actuator; requests with the same name share one."""
        return axis_name(self.joint, self.axis) + _SUFFIX[self.kind]

    def stated(self, model: Model) -> Axis | None:
        """Return the axis as the file describes it; None if the model has no such joint or axis."""
        joint = model.joint(self.joint)
        return None if joint is None else joint.axis2 if self.axis else joint.axis

    def most_force(self, model: Model) -> float:
        """Return the largest force [N m or N]: its own limit or that of the joint."""
        axis = self.stated(model)
        return self.effort if axis is None else min(self.effort, axis.effort)

    def most_speed(self, model: Model) -> float:
        """Return the largest velocity [rad/s or m/s] of the joint."""
        axis = self.stated(model)
        return math.inf if axis is None else axis.velocity


def add_servo(spec: mujoco.MjSpec, model: Model, servo: JointServo, name: str, *, soft: bool = False) -> None:
    """Add the actuator of a servo; `name` is the MuJoCo name of the joint. `recipe.wheel_gain` says what is `soft`."""
    target = axis_name(name, servo.axis)
    if spec.joint(target) is None:
        return  # Loop joints and joints of static links have no MuJoCo joint.
    actuator = spec.add_actuator(name=target + _SUFFIX[servo.kind], target=target)
    actuator.trntype = mujoco.mjtTrn.mjTRN_JOINT
    if servo.kind == WHEEL:
        actuator.set_to_velocity(kv=recipe.wheel_gain(model.mass(), servo.sharing, servo.radius, soft=soft))
    elif servo.kind == VELOCITY:
        actuator.set_to_velocity(kv=0.0)  # `find_drive` sets the gain once the inertia is known.
    else:
        actuator.set_to_motor()
    effort, velocity = servo.most_force(model), servo.most_speed(model)
    if servo.kind in (WHEEL, VELOCITY):  # `joint_limits` keeps the effort of these
        if velocity < UNLIMITED:
            actuator.ctrllimited = mujoco.mjtLimited.mjLIMITED_TRUE
            actuator.ctrlrange = _around_zero(velocity)
    elif effort < UNLIMITED:
        actuator.forcelimited = mujoco.mjtLimited.mjLIMITED_TRUE
        actuator.forcerange = _around_zero(effort)


def _around_zero(most: float) -> tuple[float, float]:
    """Return a range that MuJoCo accepts, also for 0."""
    return -max(most, _NOTHING), max(most, _NOTHING)


@dataclass(frozen=True, slots=True)
class Drive:
    """A servo or motor of the compiled model.

    `control` is its index in `data.ctrl`, `axis` the axis it moves, `limit` its largest command [rad/s or m/s for a
    servo, N m or N for a motor].
    """

    control: int
    axis: JointAxis
    limit: float

    def push(self, data: mujoco.MjData, force: float) -> None:
        """Apply `force` [N m or N] with a motor in the next step."""
        data.ctrl[self.control] = min(max(force, -self.limit), self.limit)

    def hold(self, data: mujoco.MjData, speed: float, dt: float) -> None:
        """Move a servo with `speed` [rad/s or m/s] in the next step of `dt` [s].

        The speed is reduced at the limits of the joint, because a servo is stronger than MuJoCo's limit constraint.
        """
        axis = self.axis
        speed = min(max(speed, -self.limit), self.limit)
        if axis.lower > -math.inf or axis.upper < math.inf:
            position = data.qpos.item(axis.position)
            if speed < 0.0:
                speed = max(speed, min(0.0, (axis.lower - position) / dt))
            else:
                speed = min(speed, max(0.0, (axis.upper - position) / dt))
        data.ctrl[self.control] = speed


def find_drive(mj_model: mujoco.MjModel, model: Model, servo: JointServo) -> Drive | None:
    """Find a servo in MuJoCo's model and set its gain from the inertia it moves; None for a joint that does not
    move.
    """
    name = f"{model.name}::{servo.joint}"
    axes = find_axes(mj_model, name)
    actuator = f"{model.name}::{servo.actuator}"
    control = int(mujoco.mj_name2id(mj_model, mujoco.mjtObj.mjOBJ_ACTUATOR, actuator))
    if control < 0 or servo.axis >= len(axes):
        return None
    axis = axes[servo.axis]
    inverse_inertia = float(mj_model.dof_invweight0[axis.velocity])
    if servo.kind in (FORCE, APPLIED):
        return Drive(control, axis, recipe.strongest_push(inverse_inertia))
    if mj_model.actuator_gainprm[control, 0] == 0.0:
        gain = recipe.servo_gain(inverse_inertia, float(mj_model.opt.timestep))
        mj_model.actuator_gainprm[control, 0] = gain
        mj_model.actuator_biasprm[control, 2] = -gain
    return Drive(control, axis, min(servo.most_speed(model), MAX_WHEEL_SPEED if servo.kind == WHEEL else FASTEST))
