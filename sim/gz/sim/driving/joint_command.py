"""Base class of JointPositionController, JointController and ApplyJointForce: one number drives one or more joints.

The number arrives as a `gz.msgs.Double` or as one entry of a `gz.msgs.Actuators`. A number that is not finite is
dropped and counted by the world.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/joint_controller/JointController.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar

from gz_course.sim.gz.sim.physics.servos import Drive, JointServo, find_drive
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.system import System
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_AXES = {"fixed": 0, "ball": 0, "gearbox": 0, "universal": 2, "revolute2": 2}


class JointCommand(System):
    """Base of the systems that drive joints by a number.

    A subclass defines `quantity` and `command_kind`, sets `self.value` in `start`, and uses `self.drives` in
    `pre_update`.
    """

    quantity: ClassVar[str] = ""
    """The last part of the default topic, such as `cmd_vel`."""
    actuators_field: ClassVar[str] = ""
    """The field of `gz.msgs.Actuators` that holds the number, such as `velocity`."""
    TOPIC_PARAMETERS: ClassVar[frozenset[str]] = frozenset(
        ("joint_name", "topic", "sub_topic", "use_actuator_msg", "actuator_number")
    )

    @classmethod
    def servo_kind(cls, element: Element) -> str:
        """Return the kind of servo that the parameters request."""
        raise NotImplementedError

    @classmethod
    def servos(cls, model: Model, plugin: Plugin) -> list[JointServo]:
        """Request a servo for each named joint that exists and can be driven."""
        kind, axis = cls.servo_kind(plugin.element), _axis_index(plugin.element)
        prefix = f"{plugin.scope}::" if plugin.scope else ""
        found = (model.joint(prefix + child.text) for child in plugin.element.all("joint_name"))
        return [
            JointServo(joint.name, kind, axis=axis)
            for joint in found
            if joint is not None and axis < _count_axes(joint)
        ]

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the joints and the topic. Raises SdfError if no joint is named."""
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        self.value = 0.0
        self.index = _axis_index(element)
        self._kind = self.servo_kind(element)
        named = [child.text for child in element.all("joint_name") if child.text]
        if not named:
            raise element.error(f"{self.name} needs a <joint_name>, none was found")
        self.joints = [joint for joint in self.scope.find_joints(element) if self._can_drive(joint, element)]
        self.actuator_number = self._read_actuator_number(element)
        self.topic = self._choose_topic(element, named[0])
        self.drives: list[Drive] = []

    def default_topic(self, joint: str) -> str:
        """Return the topic to use when the parameters name none."""
        return f"/model/{self.scope.name}/joint/{joint}/{self.quantity}"

    def bind(self) -> None:
        model, mj_model = self.scope.model, self.world.model
        servos = (JointServo(joint.name, self._kind, axis=self.index) for joint in self.joints)
        found = (find_drive(mj_model, model, servo) for servo in servos)
        self.drives = [drive for drive in found if drive is not None]

    def connect(self, node: Node) -> None:
        if self.actuator_number >= 0:
            from gz_course.sim.gz.msgs.actuators_pb2 import Actuators

            node.subscribe(Actuators, self.topic, self._on_actuators)
        else:
            from gz_course.sim.gz.msgs.double_pb2 import Double

            node.subscribe(Double, self.topic, self._on_double)

    def command(self, value: float) -> bool:
        """Set the commanded number; return False if it is not finite and therefore refused."""
        if not math.isfinite(value):
            self.world.drop_command(self.topic, f"data={value}")
            return False
        self.value = value
        return True

    def _on_double(self, message: Any) -> None:
        self.command(message.data)

    def _on_actuators(self, message: Any) -> None:
        values = getattr(message, self.actuators_field)
        if self.actuator_number >= len(values):
            self.world.diagnostics.warn(
                "",
                f"a message on {self.topic} holds {len(values)} numbers in '{self.actuators_field}'; {self.name} of "
                f"model '{self.scope.full_name}' looks for number {self.actuator_number} (counted from 0)",
            )
            return
        self.command(values[self.actuator_number])

    def _can_drive(self, joint: Joint, element: Element) -> bool:
        count = _count_axes(joint)
        if self.index < count:
            return True
        own = self.scope.own_name(joint.name)
        text = f"{self.name} cannot drive joint '{own}': a {joint.kind} joint has "
        if count == 0:
            text += "no axis that can be commanded"
        else:
            text += f"{count} axes or less, <joint_index> is {self.index} (counted from 0)"
        self.world.diagnostics.warn(element.where, text)
        return False

    def _read_actuator_number(self, element: Element) -> int:
        if not element.flag("use_actuator_msg", False):
            return -1
        number = element.integer("actuator_number", -1)
        if number < 0:
            text = f"{self.name} has <use_actuator_msg> but no <actuator_number> of 0 or more; it listens to a Double"
            self.world.diagnostics.warn(element.where, text)
        return number

    def _choose_topic(self, element: Element, first_joint: str) -> str:
        sub_topic = element.text_of("sub_topic")
        default = "/actuators" if self.actuator_number >= 0 else self.default_topic(first_joint)
        return valid_topic(
            element.text_of("topic"), f"/model/{self.scope.name}/{sub_topic}" if sub_topic else "", default
        )


def _axis_index(element: Element) -> int:
    index = element.integer("joint_index", 0)
    if index < 0:
        raise element.error(f"<joint_index> counts from 0, got {index}")
    return index


def _count_axes(joint: Joint) -> int:
    return _AXES.get(joint.kind, 1)
