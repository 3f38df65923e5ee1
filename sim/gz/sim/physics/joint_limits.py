"""The limits of position, effort and velocity of joints, which hold for whatever drives a joint, as in Gazebo.

A velocity servo with a limited effort is solved twice in a step in which it would need more: first as if it were strong
enough, then with its largest force in the direction of the first solution. So it never passes the commanded velocity,
however light the joint is. A joint that is faster than its limit is slowed down by an impulse between its two links. A
joint that flies into a limit of its position is stopped there by such an impulse, without rebound; MuJoCo's own limit,
which is a spring, holds a joint that leans on it.

Source: https://github.com/dartsim/dart/blob/v6.12.2/dart/constraint/ServoMotorConstraint.cpp (limits of a servo)
Source: https://github.com/dartsim/dart/blob/v6.12.2/dart/constraint/JointConstraint.cpp (limits of position)
Source: http://sdformat.org/spec?elem=joint (axis/limit)
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
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Joint, Model

_FULL = 1.0 + 1e-6  # of an effort or a velocity: more is too much
_LEANING = 0.05  # velocity into a limit [rad/s or m/s] up to which MuJoCo's spring stops a joint
_GIVE = 1e-4  # depth [rad or m] in the spring up to which nothing is looked at
_MOST_SOLUTIONS = 4  # of one step: servos that give way load others


@dataclass(slots=True)
class _Servo:
    """A velocity servo: its actuator, the degree of freedom that it moves, its largest force [N m or N] and command
    [rad/s or m/s], its gain, and the error of the velocity [rad/s or m/s] that takes the whole force.
    """

    actuator: int
    dof: int
    effort: float
    fastest: float
    gain: float = 0.0
    most: float = math.inf


@dataclass(frozen=True, slots=True)
class _Speed:
    """The largest velocity [rad/s or m/s] of a degree of freedom whose place in qpos is `position`, and the velocity
    beyond which it is slowed down.
    """

    dof: int
    position: int
    most: float
    beyond: float


@dataclass(frozen=True, slots=True)
class _Stop:
    """The limits [rad or m] of the position of a degree of freedom whose place in qpos is `position`, and the positions
    beyond which it is stopped.
    """

    dof: int
    position: int
    lower: float
    upper: float
    below: float
    above: float


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
        self._speeds: list[_Speed] = []
        self._stops: list[_Stop] = []
        for owner in models:
            for joint in owner.joints:
                self._find_limits(model, owner, joint)
            for servo in servos.get(owner.name, ()):
                self._find_servo(model, owner, servo)
        # Views, because making one takes as long as using it.
        self._qpos, self._qvel = data.qpos, data.qvel
        self._state = [(view, view.copy()) for view in (self._qpos, self._qvel, data.qacc_warmstart)]
        self._ctrl = data.ctrl
        self._impulse, self._change = np.zeros((1, model.nv)), np.zeros((1, model.nv))

    @property
    def active(self) -> bool:
        """Whether a step takes more than MuJoCo's own."""
        return bool(self._servos or self._speeds or self._stops)

    def bind(self, model: mujoco.MjModel) -> None:
        """Read the gains, which systems set when they are bound."""
        for servo in self._servos:
            servo.gain = model.actuator_gainprm.item(servo.actuator, 0)
            servo.most = servo.effort * _FULL / servo.gain if servo.gain else math.inf

    def advance(self, model: mujoco.MjModel, data: mujoco.MjData, between: Callable[[], None] | None = None) -> None:
        """Step a model; `between` is called between the two halves of the step, perhaps more than once."""
        if self._servos:
            begin = data.time
            for view, kept in self._state:
                kept[:] = view
        if between is None:
            mujoco.mj_step(model, data)
        else:
            _step(model, data, between)
        if self._servos and (weak := self._too_weak()):
            self._give_way(model, data, weak, begin, between)
        if self._speeds:
            qvel = self._qvel.item
            for limit in self._speeds:
                if not -limit.beyond <= qvel(limit.dof) <= limit.beyond:
                    self._slow_down(model, data, limit)
        qpos = self._qpos.item
        for stop in self._stops:
            if not stop.below <= qpos(stop.position) <= stop.above:
                self._stop(model, data, stop)

    def _too_weak(self) -> list[tuple[_Servo, float]]:
        """Return the servos that would have needed more than their effort in the last step, and how much they missed.

        The force of a step is implicit in the velocity with which it ends.
        """
        qvel, ctrl, found = self._qvel.item, self._ctrl.item, []
        for servo in self._servos:
            wanted, fastest = ctrl(servo.actuator), servo.fastest
            if not -fastest <= wanted <= fastest:
                wanted = math.copysign(fastest, wanted)
            error = wanted - qvel(servo.dof)
            if not -servo.most <= error <= servo.most:
                found.append((servo, error))
        return found

    def _give_way(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        weak: Sequence[tuple[_Servo, float]],
        begin: float,
        between: Callable[[], None] | None,
    ) -> None:
        """Repeat the step from its `begin` [s], with the largest force of each servo that would have needed more."""
        saturated: dict[int, _Servo] = {}
        for _ in range(_MOST_SOLUTIONS):
            more = [(servo, error) for servo, error in weak if servo.actuator not in saturated]
            if not more:
                break
            for servo, error in more:
                self._push(model, servo, math.copysign(servo.effort, error))
                saturated[servo.actuator] = servo
            for view, kept in self._state:
                view[:] = kept
            data.time = begin
            _step(model, data, between)
            weak = self._too_weak()
        for servo in saturated.values():
            self._hold(model, servo)

    @staticmethod
    def _push(model: mujoco.MjModel, servo: _Servo, force: float) -> None:
        """Let an actuator apply a force [N m or N] instead of holding a velocity."""
        model.actuator_gainprm[servo.actuator, 0] = 0.0
        model.actuator_biasprm[servo.actuator, 0], model.actuator_biasprm[servo.actuator, 2] = force, 0.0

    @staticmethod
    def _hold(model: mujoco.MjModel, servo: _Servo) -> None:
        """Let an actuator hold a velocity again."""
        model.actuator_gainprm[servo.actuator, 0] = servo.gain
        model.actuator_biasprm[servo.actuator, 0], model.actuator_biasprm[servo.actuator, 2] = 0.0, -servo.gain

    def _slow_down(self, model: mujoco.MjModel, data: mujoco.MjData, limit: _Speed) -> None:
        speed = self._qvel.item(limit.dof)
        excess = speed - math.copysign(limit.most, speed)
        self._slow(model, data, limit.dof, excess)
        self._qpos[limit.position] -= excess * model.opt.timestep

    def _stop(self, model: mujoco.MjModel, data: mujoco.MjData, stop: _Stop) -> None:
        """Stop a joint at the limit that it has passed, if it still flies away from it."""
        position, speed = self._qpos.item(stop.position), self._qvel.item(stop.dof)
        above = position > stop.upper
        if speed > _LEANING if above else speed < -_LEANING:
            self._slow(model, data, stop.dof, speed)
            self._qpos[stop.position] = stop.upper if above else stop.lower

    def _slow(self, model: mujoco.MjModel, data: mujoco.MjData, dof: int, excess: float) -> None:
        """Reduce the velocity of a joint by `excess` [rad/s or m/s] by an impulse between its links."""
        self._impulse[0, dof] = 1.0
        mujoco.mj_solveM(model, data, self._change, self._impulse)
        self._impulse[0, dof] = 0.0
        self._qvel -= self._change[0] * (excess / self._change.item(dof))

    def _find_limits(self, model: mujoco.MjModel, owner: Model, joint: Joint) -> None:
        found = find_axes(model, f"{owner.name}::{joint.name}")
        for axis, stated in zip(found, (joint.axis, joint.axis2), strict=False):
            if axis.part < 0 and (axis.lower > -math.inf or axis.upper < math.inf):
                ends = (axis.lower, axis.upper, axis.lower - _GIVE, axis.upper + _GIVE)
                self._stops.append(_Stop(axis.velocity, axis.position, *ends))
            if stated is not None and axis.part < 0 and 0.0 <= stated.velocity < UNLIMITED:
                most = stated.velocity
                self._speeds.append(_Speed(axis.velocity, axis.position, most, most * _FULL))

    def _find_servo(self, model: mujoco.MjModel, owner: Model, servo: JointServo) -> None:
        effort = servo.most_force(owner)
        if servo.kind not in (WHEEL, VELOCITY) or not effort < UNLIMITED:
            return
        axes = find_axes(model, f"{owner.name}::{servo.joint}")
        actuator = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_ACTUATOR, f"{owner.name}::{servo.actuator}")
        if actuator >= 0 and servo.axis < len(axes):
            dof = axes[servo.axis].velocity
            self._servos.append(_Servo(int(actuator), dof, effort, servo.most_speed(owner)))


def tell_what_stands(model: Model, servos: Iterable[JointServo], diagnostics: Diagnostics) -> None:
    """Warn about each driven joint that a limit of 0 keeps from moving."""
    for servo in servos:
        joint, axis = model.joint(servo.joint), servo.stated(model)
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
