"""ViewBroadcaster: sends MuJoCo's model and state to views of the world; a plugin of the world, added by `gz sim`.

A view in another process draws them (`gz_course.sim.gz.view`). This is the whole protocol, below `/world/W/view`:

- service `model` (Empty -> Bytes): the stamp of the model, then the model as MuJoCo's binary file (MJB);
- topic `state` (Bytes): the stamp of the model that the state belongs to, then MuJoCo's integration state;
- topic `drag` (EntityWrench): force and torque at the centre of mass of a link in the world frame, for a moment.

The stamp changes with every new model, for example when a model was created or removed. A state is sent at the rate of
pictures of wall time, if somebody listens; the simulation only copies the numbers.
"""

from __future__ import annotations

import math
import struct
import time
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.sim.sdf.description import Model, Plugin
    from gz_course.sim.gz.transport import Node

STATE = int(mujoco.mjtState.mjSTATE_INTEGRATION)
_PICTURE_NS = 16_000_000
"""Shortest wall time [ns] between two states."""
_DRAG_NS = 300_000_000
"""Wall time [ns] for which a drag lasts if it is not renewed: a view that ends lets go."""
_REST_NS = 5_000_000
"""Simulated time [ns] between two looks at the wall clock."""
_STAMP = struct.Struct("<Q")


def split_stamp(data: bytes) -> tuple[int, bytes]:
    """Return the stamp of the model and the rest of a message. Raises ValueError if it is too short."""
    if len(data) < _STAMP.size:
        raise ValueError(f"a message of a view needs {_STAMP.size} bytes or more, got {len(data)}")
    return _STAMP.unpack_from(data)[0], data[_STAMP.size :]


def model_bytes(model: mujoco.MjModel) -> bytes:
    """Return a model as the content of an MJB file."""
    buffer = np.empty(mujoco.mj_sizeModel(model), np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return buffer.tobytes()


@system("ViewBroadcaster", "gz-course-view-broadcaster-system")
class ViewBroadcaster(System):
    """Serves all views of one world; without a view it does nothing."""

    once = True

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        if model is not None:
            raise plugin.element.error("ViewBroadcaster belongs directly in the <world>, not inside a <model>")
        self._world = world
        self._publisher: Any = None
        self._next_ns = 0
        self._stamp = b""
        self._drag: tuple[str, np.ndarray, int] | None = None
        """The name of the dragged link, its force and torque, and the monotonic time [ns] of their end."""
        self._pushed: tuple[int, np.ndarray] | None = None
        """The dragged body during a step, and what was applied to it by others."""

    def bind(self) -> None:
        """Give the new model a stamp that no earlier one had, of this server or of one before it."""
        self._stamp = _STAMP.pack(time.time_ns())
        self._next_ns = 0

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.bytes_pb2 import Bytes
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.entity_wrench_pb2 import EntityWrench

        self._bytes = Bytes
        root = f"{self._world.topic}/view"
        self._publisher = node.advertise(f"{root}/state", Bytes)
        node.advertise_service(f"{root}/model", Empty, Bytes, self._on_model)
        node.subscribe(EntityWrench, f"{root}/drag", self._on_drag)

    def pre_update(self, info: UpdateInfo) -> None:
        drag = self._drag
        if drag is None:
            return
        name, push, end_ns = drag
        data = self._world.data
        body = int(mujoco.mj_name2id(self._world.model, mujoco.mjtObj.mjOBJ_BODY, name))
        if body <= 0 or time.monotonic_ns() > end_ns:
            self._drag = None
            return
        self._pushed = body, data.xfrc_applied[body].copy()
        data.xfrc_applied[body] += push

    def post_update(self, info: UpdateInfo) -> None:
        if self._pushed is not None:
            body, before = self._pushed
            self._world.data.xfrc_applied[body] = before
            self._pushed = None
        self._publish(info.sim_time_ns)

    def rests_until(self, info: UpdateInfo) -> int:
        return 0 if self._drag is not None else info.sim_time_ns + _REST_NS

    def paused_update(self, info: UpdateInfo) -> None:
        self._next_ns = 0
        self._publish(info.sim_time_ns)

    def _publish(self, sim_time_ns: int) -> None:
        now = time.monotonic_ns()
        if now < self._next_ns or self._publisher is None:
            return
        self._next_ns = now + _PICTURE_NS
        if not self._publisher.has_connections():
            return
        model = self._world.model
        state = np.empty(mujoco.mj_stateSize(model, STATE))
        mujoco.mj_getState(model, self._world.data, state, STATE)
        message = self._bytes(data=self._stamp + state.tobytes())
        message.header.stamp.sec, message.header.stamp.nsec = divmod(sim_time_ns, 1_000_000_000)
        self._publisher.publish(message)

    def _on_model(self, _: Any) -> Any:
        return self._bytes(data=self._world.requests.call(lambda: self._stamp + model_bytes(self._world.model)))

    def _on_drag(self, message: Any) -> None:
        wrench = message.wrench
        push = [getattr(vector, axis) for vector in (wrench.force, wrench.torque) for axis in "xyz"]
        if not all(map(math.isfinite, push)):
            self._world.drop_command(f"{self._world.topic}/view/drag", f"{push}")
        elif any(push):
            self._drag = message.entity.name, np.array(push), time.monotonic_ns() + _DRAG_NS
        else:
            self._drag = None
