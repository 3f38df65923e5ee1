"""LogPlayback: moves the models of a world as LogRecord has recorded them; a plugin of the world.

`gz sim --playback FOLDER` adds it to the recorded world, which has no other systems but the broadcasters. The poses of
`/world/W/dynamic_pose/info` become positions of joints; nothing is simulated. Models that came while it was recorded
are not shown, and recordings of Gazebo itself, which hold its components, are not read.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/log/LogPlayback.cc
"""

from __future__ import annotations

import math
import sqlite3
from pathlib import Path
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from google.protobuf.message import DecodeError
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import LOG, Diagnostics, SimError
from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.pose import Pose, multiply, rotate
from gz_course.sim.gz.sim.scene.graph import SceneGraph, Vertex
from gz_course.sim.gz.sim.sdf.description import Model, Plugin, WorldDescription
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.sim.gz.sim.tlog import Log

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

_JOINT = mujoco.mjtJoint
_NOTHING_ACTS = int(
    mujoco.mjtDisableBit.mjDSBL_GRAVITY
    | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    | mujoco.mjtDisableBit.mjDSBL_CONTACT
    | mujoco.mjtDisableBit.mjDSBL_ACTUATION
)


def recorded_world(path: Path) -> tuple[WorldDescription, int]:
    """Return the world of a recording, without systems, and the simulated time of its end [ns].

    Raises SimError if the file is no recording of a world.
    """
    from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

    with Log(path) as log:
        try:
            topics = log.topics()
            sdf = next((each.topic for each in topics if each.topic.endswith("/log/sdf")), None)
            if sdf is None:
                raise SimError(f"'{log.path}' holds no world; gz sim --record writes one, gz log record does not")
            text = StringMsg.FromString(next(log.messages(sdf)).data).data
            description = read_world(text, "<recorded>", Diagnostics(quiet=True))
            if not any(each.topic == _topic(description.name) for each in topics):
                raise SimError(f"'{log.path}' has no poses on {_topic(description.name)}; only recordings made here do")
            description.plugins = []
            for model in description.models:
                model.plugins = []
            return description, max(each.last_ns for each in topics)
        except (sqlite3.Error, DecodeError) as error:
            raise SimError(f"'{log.path}' is damaged ({error}); record it again") from None


def _topic(world: str) -> str:
    from gz_course.sim.gz.sim.plugins.topics import valid_topic

    return valid_topic(f"/world/{world}/dynamic_pose/info")


@system("LogPlayback", "gz-sim-log-playback-system")
class LogPlayback(System):
    """Sets the recorded state at each step. Parameter: playback_path."""

    once = True
    parameters = frozenset(["playback_path"])

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Open the recording. Raises SdfError if there is none."""
        element = plugin.element
        if model is not None:
            raise element.error("LogPlayback belongs directly in the <world>, not inside a <model>")
        self._world = world
        self._log: Log | None = None
        self._shown_ns: int | None = None
        self._positions: NDArray[np.float64] | None = None
        if not world.resources.opens_files:
            world.diagnostics.warn(element.where, "LogPlayback reads no file here, nothing is played back")
            return
        try:
            self._log = Log(Path(element.text_of("playback_path")))
        except SimError as error:
            raise element.error(f"<playback_path>: {error}") from None

    def bind(self) -> None:
        """Find the bodies of the links that can move, and let nothing act on them."""
        world = self._world
        world.model.opt.disableflags |= _NOTHING_ACTS
        self._links: list[tuple[int, list[Vertex]]] = []
        for vertex in SceneGraph(world).movers:
            if vertex.kind == "link":
                above = [vertex]
                while above[0].parent is not None and above[0].parent.kind != "world":
                    above.insert(0, above[0].parent)
                name = scoped(above[0].described, vertex.described.name)
                self._links.append((mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_BODY, name), above))
        self._links.sort(key=lambda each: each[0])
        self._shown_ns, self._positions = None, None

    def start(self) -> None:
        """Show the state at the present time, also after a reset."""
        self._shown_ns = None
        self._show(self._world.sim_time_ns)

    def post_update(self, info: UpdateInfo) -> None:
        self._show(info.sim_time_ns)

    def close(self) -> None:
        log, self._log = self._log, None
        if log is not None:
            log.close()

    def _show(self, now_ns: int) -> None:
        if self._log is None:
            return
        data = self._world.data
        try:
            found = self._log.latest(_topic(self._world.name), now_ns)
            if found is not None and found.time_ns != self._shown_ns:
                self._shown_ns = found.time_ns
                positions = self._decoded(found.data)
                if np.isfinite(positions).all():
                    self._positions = positions
        except (sqlite3.Error, DecodeError) as error:
            LOG.error("%s is damaged (%s); the playback ends here", self._log.path, error)
            self._log = None
        if self._positions is not None:
            data.qpos[:] = self._positions
        data.qvel[:] = 0.0
        self._world.truth.stale = True

    def _decoded(self, message: bytes) -> NDArray[np.float64]:
        """Return the positions of the joints (nq,) for a recorded gz.msgs.Pose_V."""
        from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

        recorded: dict[int, Any] = {each.id: each for each in Pose_V.FromString(message).pose}
        model = self._world.model
        positions: NDArray[np.float64] = model.qpos0.copy()
        placed: dict[int, Pose] = {}
        for body, above in self._links:
            pose = Pose()
            for vertex in above:
                each = recorded.get(vertex.number)
                pose = pose * (vertex.pose if each is None else _read(each))
            placed[body] = pose
            parent = placed.get(int(model.body_parentid[body]), Pose())
            _set_joints(model, body, parent.inverse() * pose, positions)
        return positions


def _read(message: Any) -> Pose:
    at, turn = message.position, message.orientation
    quaternion = np.array((turn.w, turn.x, turn.y, turn.z))
    norm = float(np.linalg.norm(quaternion))
    return Pose((at.x, at.y, at.z), quaternion / norm if norm > 1e-9 else (1.0, 0.0, 0.0, 0.0))


def _set_joints(model: mujoco.MjModel, body: int, pose: Pose, positions: NDArray[np.float64]) -> None:
    """Set the joints of a body so that it has a pose in its parent's body; what they cannot reach is left out."""
    base = Pose(model.body_pos[body], model.body_quat[body])
    first = int(model.body_jntadr[body])
    joints = range(first, first + int(model.body_jntnum[body]))
    turn = (base.inverse() * pose).quaternion
    for joint in joints:
        kind, place, axis = model.jnt_type[joint], int(model.jnt_qposadr[joint]), model.jnt_axis[joint]
        if kind == _JOINT.mjJNT_FREE:
            positions[place : place + 7] = (*pose.position, *pose.quaternion)
        elif kind == _JOINT.mjJNT_BALL:
            positions[place : place + 4] = turn
        elif kind == _JOINT.mjJNT_SLIDE:
            way = pose.position - base.position
            positions[place] = model.qpos0[place] + float(way @ rotate(base.quaternion, axis))
        else:
            later = [each for each in joints if each > joint and model.jnt_type[each] == _JOINT.mjJNT_HINGE]
            angle = _angle(turn, axis, model.jnt_axis[later[0]] if later else None)
            positions[place] = model.qpos0[place] + angle
            half = -angle / 2.0
            turn = multiply(np.array((math.cos(half), *(math.sin(half) * axis))), turn)


def _angle(turn: NDArray[np.float64], axis: NDArray[np.float64], then: NDArray[np.float64] | None) -> float:
    """Return the angle [rad] about `axis` of a rotation, which goes on about the axis `then` if there is one."""
    if then is None:
        return math.remainder(2.0 * math.atan2(float(turn[1:] @ axis), float(turn[0])), 2.0 * math.pi)
    turned = rotate(turn, then)
    across = then - float(then @ axis) * axis
    return math.atan2(float(np.cross(across, turned) @ axis), float(across @ turned))
