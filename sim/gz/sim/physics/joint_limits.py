"""The limits of effort and velocity of joints, which hold for whatever drives a joint, as in Gazebo.

A velocity servo with a limited effort is solved twice in a step in which it would need more: first as if it were strong
enough, then with its largest force in the direction of the first solution. So it never passes the commanded velocity,
however light the joint is. A joint that is faster than its limit is slowed down by an impulse between its two links.

Source: https://github.com/dartsim/dart/blob/v6.12.2/dart/constraint/ServoMotorConstraint.cpp (limits of a servo)
Source: http://sdformat.org/spec?elem=joint (axis/limit: effort, velocity)
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.physics.joint_axis import find_axes
from gz_course.sim.gz.sim.physics.servos import VELOCITY, WHEEL, JointServo
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Axis, Joint, Model

_STATE = mujoco.mjtState.mjSTATE_INTEGRATION
_TOLERANCE = 1e-6  # relative, of an effort or a velocity
_MOST_SOLUTIONS = 4  # of one step: servos that give way load others


@dataclass(frozen=True, slots=True)
class _Servo:
    """A velocity servo: its actuator, the degree of freedom that it moves, and its largest force [N m or N]."""

    actuator: int
    dof: int
    effort: float


@dataclass(frozen=True, slots=True)
class _Speed:
    """The largest velocity [rad/s or m/s] of a degree of freedom whose place in qpos is `position`."""

    dof: int
    position: int
    most: float


class JointLimits:
    """The limits of all joints of one compiled model; `advance` steps it."""

    def __init__(
        self, model: mujoco.MjModel, models: Iterable[Model], servos: Mapping[str, Sequence[JointServo]]
    ) -> None:
        """Find the joints with limits. `servos` are those of the systems, by model."""
        self._servos: list[_Servo] = []
        self._speeds: list[_Speed] = []
        for owner in models:
            for joint in owner.joints:
                self._find_speeds(model, owner, joint)
            for servo in servos.get(owner.name, ()):
                self._find_servo(model, owner, servo)
        self._before = np.empty(mujoco.mj_stateSize(model, _STATE))
        self._impulse, self._change = np.zeros((1, model.nv)), np.zeros((1, model.nv))

    @property
    def active(self) -> bool:
        """Whether a step takes more than MuJoCo's own."""
        return bool(self._servos or self._speeds)

    def advance(self, model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None] | None = None) -> None:
        """Step a model; `between` is called between the two halves of the step, perhaps more than once."""
        if self._servos:
            mujoco.mj_getState(model, data, self._before, _STATE)
        _step(model, data, between)
        if self._servos:
            self._give_way(model, data, between)
        for each in self._speeds:
            self._slow_down(model, data, each)

    def _give_way(self, model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None] | None) -> None:
        """Repeat the step with the largest force of each servo that would have needed more."""
        saturated: dict[int, tuple[float, float, float]] = {}
        for _ in range(_MOST_SOLUTIONS):
            found = {
                servo.actuator: float(np.copysign(servo.effort, force))
                for servo in self._servos
                if servo.actuator not in saturated
                and abs(force := _force(model, data, servo)) > servo.effort * (1.0 + _TOLERANCE)
            }
            if not found:
                break
            for actuator, force in found.items():
                gain, bias = model.actuator_gainprm[actuator], model.actuator_biasprm[actuator]
                saturated[actuator] = float(gain[0]), float(bias[0]), float(bias[2])
                gain[0], bias[0], bias[2] = 0.0, force, 0.0
            mujoco.mj_setState(model, data, self._before, _STATE)
            _step(model, data, between)
        for actuator, (gain0, bias0, bias2) in saturated.items():
            model.actuator_gainprm[actuator, 0] = gain0
            model.actuator_biasprm[actuator, 0], model.actuator_biasprm[actuator, 2] = bias0, bias2

    def _slow_down(self, model: mujoco.MjModel, data: mujoco.MjData, limit: _Speed) -> None:
        speed = data.qvel.item(limit.dof)
        if abs(speed) <= limit.most * (1.0 + _TOLERANCE):
            return
        excess = speed - float(np.copysign(limit.most, speed))
        self._impulse[0, limit.dof] = 1.0
        mujoco.mj_solveM(model, data, self._change, self._impulse)
        self._impulse[0, limit.dof] = 0.0
        data.qvel -= self._change[0] * (excess / self._change.item(limit.dof))
        data.qpos[limit.position] -= excess * model.opt.timestep

    def _find_speeds(self, model: mujoco.MjModel, owner: Model, joint: Joint) -> None:
        found = find_axes(model, f"{owner.name}::{joint.name}")
        for axis, stated in zip(found, (joint.axis, joint.axis2), strict=False):
            if stated is not None and axis.part < 0 and 0.0 <= stated.velocity < UNLIMITED:
                self._speeds.append(_Speed(axis.velocity, axis.position, stated.velocity))

    def _find_servo(self, model: mujoco.MjModel, owner: Model, servo: JointServo) -> None:
        axis, effort = stated_axis(owner, servo), effort_of(owner, servo)
        if axis is None or servo.kind not in (WHEEL, VELOCITY) or not effort < UNLIMITED:
            return
        axes = find_axes(model, f"{owner.name}::{servo.joint}")
        actuator = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, f"{owner.name}::{servo.actuator}")
        if actuator >= 0 and servo.axis < len(axes):
            self._servos.append(_Servo(int(actuator), axes[servo.axis].velocity, effort))


def stated_axis(model: Model, servo: JointServo) -> Axis | None:
    """Return the axis that a servo moves, as the file describes it."""
    joint = model.joint(servo.joint)
    return None if joint is None else joint.axis2 if servo.axis else joint.axis


def effort_of(model: Model, servo: JointServo) -> float:
    """Return the largest force [N m or N] of a servo or motor: its own limit or that of the joint."""
    axis = stated_axis(model, servo)
    return servo.effort if axis is None else min(servo.effort, axis.effort)


def tell_what_stands(model: Model, servos: Iterable[JointServo], diagnostics: Diagnostics) -> None:
    """Warn about each driven joint that a limit of 0 keeps from moving."""
    for servo in servos:
        joint, axis = model.joint(servo.joint), stated_axis(model, servo)
        if joint is None or axis is None:
            continue
        for word, value, unit in (("velocity", axis.velocity, "speed"), ("effort", axis.effort, "force")):
            if value == 0.0:
                diagnostics.warn(
                    joint.element.where,
                    f"joint '{joint.name}' is driven, but has the limit {word} 0, so it cannot be moved, as in Gazebo; "
                    f"set the largest {unit} it can have, or leave the limit out",
                )


def _step(model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None] | None) -> None:
    if between is None:
        mujoco.mj_step(model, data)
        return
    mujoco.mj_step1(model, data)
    between()
    mujoco.mj_step2(model, data)


def _force(model: mujoco.MjModel, data: mujoco.MjData, servo: _Servo) -> float:
    """Return the force of a servo in the last step, which was implicit in the velocity."""
    wanted = data.ctrl.item(servo.actuator)
    if model.actuator_ctrllimited[servo.actuator]:
        lower, upper = model.actuator_ctrlrange[servo.actuator].tolist()
        wanted = min(max(wanted, lower), upper)
    return model.actuator_gainprm.item(servo.actuator, 0) * (wanted - data.qvel.item(servo.dof))
