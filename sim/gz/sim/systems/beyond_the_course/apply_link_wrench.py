"""ApplyLinkWrench: applies external forces and torques to links, for one step or until they are cleared.

A `gz.msgs.EntityWrench` ([N], [N m], world axes; at the link's origin or at `force_offset` in the link's axes) on
`/world/W/wrench` acts in the next step, on `/world/W/wrench/persistent` in every step until a `gz.msgs.Entity` arrives
on `/world/W/wrench/clear`. For a model it acts on the canonical link.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/apply_link_wrench/ApplyLinkWrench.cc
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.physics.pushes import push
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Vector, rotate
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

_ZERO = (0.0, 0.0, 0.0)
_MOST = 10_000
"""Maximum number of stored wrenches, because a sender may never clear them."""


@dataclass(frozen=True, slots=True)
class _Wrench:
    """A wrench and the entity it acts on (id, name and kind as in the message)."""

    number: int
    name: str
    kind: str
    force: Vector
    torque: Vector
    offset: Vector


@system("ApplyLinkWrench", "gz-sim-apply-link-wrench-system")
class ApplyLinkWrench(System):
    """The system of the whole world."""

    parameters = frozenset(("topic", "topic_persistent", "topic_clear", "persistent", "verbose"))
    pushes = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        if model is not None:
            raise element.error("ApplyLinkWrench belongs directly in the <world>, not inside a <model>")
        self.world = world
        stem = f"/world/{world.name}/wrench"
        self.topic = valid_topic(element.text_of("topic"), stem)
        self.persistent_topic = valid_topic(element.text_of("topic_persistent"), f"{stem}/persistent")
        self.clear_topic = valid_topic(element.text_of("topic_clear"), f"{stem}/clear")
        self._initial = [made for child in element.all("persistent") if (made := self._read(child)) is not None]

    def _read(self, element: Element) -> _Wrench | None:
        kind, name = element.text_of("entity_type"), element.text_of("entity_name")
        if kind not in ("link", "model") or not name:
            text = "<persistent> needs an <entity_name> and an <entity_type> that is link or model, it is left out"
            self.world.diagnostics.warn(element.where, f"ApplyLinkWrench's {text}")
            return None
        force, torque = (np.array(element.vector(tag, _ZERO)) for tag in ("force", "torque"))
        if not (np.isfinite(force).all() and np.isfinite(torque).all()):
            raise element.error("<force> and <torque> of ApplyLinkWrench must be finite")
        return _Wrench(0, name, kind, force, torque, np.zeros(3))

    def start(self) -> None:
        self._once: deque[_Wrench] = deque(maxlen=_MOST)
        self._persistent = list(self._initial)
        self._clear: deque[tuple[int, str, str]] = deque(maxlen=_MOST)

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.entity_pb2 import Entity
        from gz_course.sim.gz.msgs.entity_wrench_pb2 import EntityWrench

        node.subscribe(EntityWrench, self.topic, self._on_wrench)
        node.subscribe(EntityWrench, self.persistent_topic, self._on_persistent)
        node.subscribe(Entity, self.clear_topic, self._on_clear)

    def _on_wrench(self, message: Any) -> None:
        made = self._take(message, self.topic)
        if made is not None:
            self._once.append(made)

    def _on_persistent(self, message: Any) -> None:
        made = self._take(message, self.persistent_topic)
        if made is not None and len(self._persistent) < _MOST:
            self._persistent.append(made)

    def _on_clear(self, message: Any) -> None:
        self._clear.append(_entity(message))

    def _take(self, message: Any, topic: str) -> _Wrench | None:
        if not (message.HasField("entity") and message.HasField("wrench")):
            self.world.diagnostics.warn("", f"a message on {topic} was dropped because it lacks an entity or a wrench")
            return None
        wrench = message.wrench
        force, torque, offset = (
            np.array((each.x, each.y, each.z)) for each in (wrench.force, wrench.torque, wrench.force_offset)
        )
        if not all(map(math.isfinite, (*force, *torque, *offset))):
            self.world.drop_command(topic, f"force={force}, torque={torque}, force_offset={offset}")
            return None
        return _Wrench(*_entity(message.entity), force, torque, offset)

    def pre_update(self, info: UpdateInfo) -> None:
        while self._clear:
            gone = self._find(*self._clear.popleft())
            self._persistent = [
                each for each in self._persistent if self._find(each.number, each.name, each.kind) != gone
            ]
        while self._once:
            self._push(self._once.popleft(), warn=True)
        for wrench in self._persistent:
            # No warning, because the entity may be created later.
            self._push(wrench, warn=False)

    def _push(self, wrench: _Wrench, *, warn: bool) -> None:
        found = self._find(wrench.number, wrench.name, wrench.kind)
        body = -1
        if found:
            body = int(mujoco.mj_name2id(self.world.model, mujoco.mjtObj.mjOBJ_BODY, found))
        elif warn:
            known = (each.name for each in self.world.description.models)
            hint = did_you_mean(wrench.name.split("::")[0], known, listing="models are")
            self.world.diagnostics.warn(
                "", f"a wrench is for '{wrench.name or wrench.number}', which does not exist{hint}"
            )
        if body <= 0:
            return
        self.world.truth.refresh()
        place = self.world.data.xpos[body] + rotate(self.world.data.xquat[body], wrench.offset)
        push(self.world.data, body, wrench.force, place, wrench.torque)

    def _find(self, number: int, name: str, kind: str) -> str:
        """Return the MuJoCo name of the link a wrench acts on, empty if there is none."""
        if number:
            entity = self.world.entities.find(number)
            if entity is None or entity.kind not in ("link", "model"):
                return ""
            name, kind = "::".join(entity.path), entity.kind
        owner, _, inside = name.partition("::")
        model = next((each for each in self.world.description.models if each.name == owner), None)
        if model is None:
            return ""
        if inside and kind != "model" and model.link(inside) is not None:
            return name
        if kind == "link":
            return ""
        nested = next((each for each in model.nested if each.name == inside), None)
        if inside and nested is None:
            return ""
        return f"{owner}::{nested.canonical_link if nested is not None else model.canonical_link}"


def _entity(message: Any) -> tuple[int, str, str]:
    """Return id, name and kind (empty if not stated) of a `gz.msgs.Entity`."""
    kind = message.Type.Name(message.type).lower()
    return int(message.id), str(message.name), "" if kind == "none" else kind
