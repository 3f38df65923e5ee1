"""The limits of effort and velocity of joints, which hold for whatever drives a joint, as in Gazebo.

A velocity servo with a limited effort is solved twice in a step in which it would need more: first as if it were strong
enough, then with its largest force in the direction of the first solution. So it never passes the commanded velocity,
however light the joint is. A joint that is faster than its limit is slowed down by an impulse between its two links.

Source: https://github.com/dartsim/dart/blob/v6.12.2/dart/constraint/ServoMotorConstraint.cpp (limits of a servo)
Source: http://sdformat.org/spec?elem=joint (axis/limit: effort, velocity)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.physics.joint_axis import find_axes
from gz_course.sim.gz.sim.physics.servos import VELOCITY, WHEEL, JointServo
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Axis, Joint, Model

_TOLERANCE = 1e-6  # relative, of an effort or a velocity
_MOST_SOLUTIONS = 4  # of one step: servos that give way load others


@dataclass(slots=True)
class _Servo:
    """A velocity servo: its actuator, the degree of freedom that it moves, its largest force [N m or N] and command
    [rad/s or m/s], and its gain.
    """

    actuator: int
    dof: int
    effort: float
    fastest: float
    gain: float = 0.0

    def force(self, control: float, speed: float) -> float:
        """Return the force of a step that ended with a speed; it was implicit in the speed."""
        wanted = min(max(control, -self.fastest), self.fastest)
        return self.gain * (wanted - speed)


@dataclass(frozen=True, slots=True)
class _Speed:
    """The largest velocity [rad/s or m/s] of a degree of freedom whose place in qpos is `position`."""

    dof: int
    position: int
    most: float


class JointLimits:
    """The limits of all joints of one compiled model; `advance` steps it."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        models: Iterable[Model],
        servos: Mapping[str, Sequence[JointServo]],
    ) -> None:
        """Find the joints with limits. `servos` are those of the systems, by model."""
        self._servos: list[_Servo] = []
        self._strong: list[tuple[int, int, float]] = []  # actuator, dof, and the error that takes the whole effort
        self._speeds: list[_Speed] = []
        for owner in models:
            for joint in owner.joints:
                self._find_speeds(model, owner, joint)
            for servo in servos.get(owner.name, ()):
                self._find_servo(model, owner, servo)
        # Views, because making one takes as long as using it.
        self._qpos, self._qvel, self._warm = data.qpos, data.qvel, data.qacc_warmstart
        self._state = [(view, view.copy()) for view in (self._qpos, self._qvel, self._warm)]
        self._ctrl = data.ctrl
        self._impulse, self._change = np.zeros((1, model.nv)), np.zeros((1, model.nv))

    @property
    def active(self) -> bool:
        """Whether a step takes more than MuJoCo's own."""
        return bool(self._servos or self._speeds)

    def bind(self, model: mujoco.MjModel) -> None:
        """Read the gains, which systems set when they are bound."""
        for servo in self._servos:
            servo.gain = model.actuator_gainprm.item(servo.actuator, 0)
        self._strong = [(each.actuator, each.dof, each.effort / max(each.gain, 1e-300)) for each in self._servos]

    def advance(self, model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None] | None = None) -> None:
        """Step a model; `between` is called between the two halves of the step, perhaps more than once."""
        if self._strong:
            for view, kept in self._state:
                kept[:] = view
        if between is None:
            mujoco.mj_step(model, data)
        else:
            _step_in_halves(model, data, between)
        qvel, ctrl = self._qvel.item, self._ctrl.item
        for actuator, dof, error in self._strong:
            if not -error <= ctrl(actuator) - qvel(dof) <= error:
                self._give_way(model, data, between)
                break
        for limit in self._speeds:
            if not -limit.most <= qvel(limit.dof) <= limit.most:
                self._slow_down(model, data, limit)

    def _give_way(self, model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None] | None) -> None:
        """Repeat the step with the largest force of each servo that would have needed more."""
        begin = data.time - model.opt.timestep
        saturated: dict[int, _Servo] = {}
        for _ in range(_MOST_SOLUTIONS):
            found = False
            for servo in self._servos:
                force = servo.force(self._ctrl.item(servo.actuator), self._qvel.item(servo.dof))
                if servo.actuator in saturated or abs(force) <= servo.effort * (1.0 + _TOLERANCE):
                    continue
                saturated[servo.actuator] = servo
                bias = model.actuator_biasprm[servo.actuator]
                model.actuator_gainprm[servo.actuator, 0], bias[2] = 0.0, 0.0
                bias[0], found = math.copysign(servo.effort, force), True
            if not found:
                break
            for view, kept in self._state:
                np.copyto(view, kept)
            data.time = begin
            if between is None:
                mujoco.mj_step(model, data)
            else:
                _step_in_halves(model, data, between)
        for actuator, servo in saturated.items():
            model.actuator_gainprm[actuator, 0] = servo.gain
            model.actuator_biasprm[actuator, 0], model.actuator_biasprm[actuator, 2] = 0.0, -servo.gain

    def _slow_down(self, model: mujoco.MjModel, data: mujoco.MjData, limit: _Speed) -> None:
        speed = self._qvel.item(limit.dof)
        if abs(speed) <= limit.most * (1.0 + _TOLERANCE):
            return
        excess = speed - math.copysign(limit.most, speed)
        self._impulse[0, limit.dof] = 1.0
        mujoco.mj_solveM(model, data, self._change, self._impulse)
        self._impulse[0, limit.dof] = 0.0
        self._qvel -= self._change[0] * (excess / self._change.item(limit.dof))
        self._qpos[limit.position] -= excess * model.opt.timestep

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
            self._servos.append(_Servo(int(actuator), axes[servo.axis].velocity, effort, axis.velocity))


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


def _step_in_halves(model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None]) -> None:
    mujoco.mj_step1(model, data)
    between()
    mujoco.mj_step2(model, data)
