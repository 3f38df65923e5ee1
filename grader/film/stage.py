"""The recorded world as a world of the simulator, with a camera that looks at it from outside.

Nothing is simulated: each visual is a model of its own, put where the recording says. The camera follows the robot; its
pictures are those of the simulator's cameras, the same bytes each time.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.grader.errors import UsageError
from gz_course.grader.process.temporary_folder import TemporaryFolder
from gz_course.grader.record.bodies import SHAPES, chain_of, rgba, rotation
from gz_course.grader.record.reading import Poses, Recording

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.world import World

OFFSET = np.array([-2.3, -2.9, 2.8])  # from what is looked at to the camera [m]
TURNS = (0, 1, -1, 2, -2, 3, -3, 4)  # eighths of a turn from which it may be seen instead if something hides it
ABOVE = np.array([-0.5, -0.6, 4.6])  # and from above
LOOKS = 12  # moments at which it is tried what the camera sees
ROBOT = 0.5  # [m] what is met so near to the middle of the robot is the robot
VIEW_ANGLE = 0.9  # [rad] of the horizontal field of view
FOLLOWED_S = 1.0  # [s] before and after a moment whose mean place the camera looks at
NEAR = 0.03  # [m] what is so close to a surface is on it
EYE = "eye"

_WORLD = """<sdf version='1.11'><world name='recording'>
<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>
<plugin filename='gz-sim-sensors-system' name='gz::sim::systems::Sensors'/>
<scene><ambient>0.45 0.45 0.45 1</ambient><background>0.86 0.90 0.94 1</background></scene>
<light name='sun' type='directional'><pose>0 0 10 0 0 0</pose><direction>0.35 0.45 -1</direction>
<diffuse>0.7 0.7 0.7 1</diffuse><cast_shadows>true</cast_shadows></light>
{models}
<model name='eye'><link name='link'><gravity>false</gravity><sensor name='camera' type='camera'><camera>
<horizontal_fov>{angle}</horizontal_fov><image><width>{width}</width><height>{height}</height></image>
<clip><near>0.01</near><far>200</far></clip></camera></sensor></link></model>
</world></sdf>"""
_MODEL = """<model name='{name}'><link name='link'><gravity>false</gravity><visual name='visual'>{pose}
<geometry>{geometry}</geometry><material><diffuse>{colour}</diffuse></material></visual></link></model>"""


class Stage:
    """A recorded world, seen from outside; `robot` is the model that the camera follows."""

    def __init__(self, recording: Recording, width: int, height: int) -> None:
        """Build it. Raises UsageError if the recording holds no world."""
        from gz_course.sim.gz.sim.errors import SimError
        from gz_course.sim.gz.sim.world import World

        self.recording = recording
        self.width, self.height = width, height
        self.robot = _followed(recording)
        self._chains: dict[str, tuple[Poses, ...]] = {}
        models = []
        with TemporaryFolder("course-film-") as meshes:
            for kind in SHAPES:
                for entity in recording.entities("world", kind):
                    models += self._models(entity, kind, meshes)
            if not models:
                raise UsageError(f"{recording.path} holds no world: nothing was simulated in this run")
            text = _WORLD.format(models="\n".join(models), angle=VIEW_ANGLE, width=width, height=height)
            try:
                self.world: World = World.from_string(text)
            except SimError as error:
                first = str(error).splitlines()[0]
                raise UsageError(f"the world in {recording.path} cannot be drawn: {first}") from None
        self._camera: Any = next(self.world.systems.sensors())
        self._places = {name: self._place_of(name) for name in (*self._chains, EYE)}
        self._offset = self._clearest()

    def _clearest(self) -> np.ndarray:
        """Return the offset of the camera from which the robot is hidden least often, the first of equals."""
        halves = [turn * math.pi / 8 for turn in TURNS]
        offsets = [rotation(np.array([0.0, 0.0, math.sin(half), math.cos(half)])) @ OFFSET for half in halves]
        offsets.append(ABOVE)
        seen = np.zeros(len(offsets))
        for time_ns in np.linspace(0, self.recording.end_ns, LOOKS):
            self._arrange(int(time_ns))
            target = self.target(int(time_ns)) + np.array([0.0, 0.0, 0.1])
            seen += [self._unhidden(target + each, target[None], ROBOT)[0] for each in offsets]
        return offsets[int(np.argmax(seen))]

    def _models(self, entity: str, kind: str, meshes: Path) -> list[str]:
        facts = self.recording.static(entity)
        geometry, shift = _geometry(kind, facts, meshes / f"{len(self._chains)}.obj")
        if not geometry:
            return []
        name = f"visual{len(self._chains)}"
        self._chains[name] = chain_of(self.recording, entity)
        return [
            _MODEL.format(
                name=name,
                pose=f"<pose>{_words(shift)} 0 0 0</pose>",
                geometry=geometry,
                colour=_words([each / 255 for each in rgba(kind, facts)]),
            )
        ]

    def _place_of(self, model: str) -> int:
        """Return where the pose of a model is in MuJoCo's `qpos`."""
        body = self.world.model.body(f"{model}::link")
        return int(self.world.model.jnt_qposadr[int(body.jntadr[0])])

    def image(self, time_ns: int) -> np.ndarray:
        """Return the picture (height, width, 3) of a moment [ns], uint8."""
        self._eye = self.eye(time_ns)
        self._put(EYE, *self._eye)
        self._arrange(time_ns)
        image: np.ndarray = self._camera.image()
        return image

    def _arrange(self, time_ns: int) -> None:
        """Put every visual where it is at a moment [ns]."""
        import mujoco

        for name, chain in self._chains.items():
            self._put(name, *pose_at(chain, time_ns))
        mujoco.mj_kinematics(self.world.model, self.world.data)

    def _put(self, model: str, position: np.ndarray, axes: np.ndarray) -> None:
        import mujoco

        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(axes).ravel())
        at = self._places[model]
        self.world.data.qpos[at : at + 3] = position
        self.world.data.qpos[at + 3 : at + 7] = quaternion

    def eye(self, time_ns: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the place of the camera (3,) [m] and its axes forward, left, up as columns (3, 3)."""
        target = self.target(time_ns)
        forward = -self._offset / np.linalg.norm(self._offset)
        left = np.cross([0.0, 0.0, 1.0], forward)
        left /= np.linalg.norm(left)
        return target + self._offset, np.stack([forward, left, np.cross(forward, left)], axis=1)

    def target(self, time_ns: int) -> np.ndarray:
        """Return the mean place of the robot around a moment, so that the camera moves smoothly."""
        poses = self.recording.poses(f"world/{self.robot}")
        if poses is None:
            return np.zeros(3)
        near = np.abs(poses.times - time_ns) <= FOLLOWED_S * 1e9
        if not near.any():
            near = np.arange(len(poses.times)) == np.argmin(np.abs(poses.times - time_ns))
        mean: np.ndarray = poses.positions[near].mean(axis=0)
        return mean

    def project(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the pixels (n, 2) of points (n, 3) [m] in the last image, and whether the camera saw each (n,)."""
        eye, axes = self._eye
        local = (points - eye) @ axes
        seen = local[:, 0] > 0.01
        ahead = np.where(seen, local[:, 0], 1.0)
        focal = self.width / 2 / math.tan(VIEW_ANGLE / 2)
        columns = self.width / 2 - focal * local[:, 1] / ahead
        rows = self.height / 2 - focal * local[:, 2] / ahead
        seen &= (columns >= 0) & (columns < self.width) & (rows >= 0) & (rows < self.height)
        inside = np.flatnonzero(seen)
        seen[inside] = self._unhidden(eye, points[inside])
        return np.stack([columns, rows], axis=1), seen

    def _unhidden(self, eye: np.ndarray, points: np.ndarray, near: float = NEAR) -> np.ndarray:
        """Tell for each point (n, 3) whether nothing is before it; what is met `near` [m] to it is it."""
        import mujoco

        if not len(points):
            return np.zeros(0, dtype=bool)
        way = points - eye
        distance = np.linalg.norm(way, axis=1)
        met, geom = np.zeros(len(points)), np.zeros(len(points), dtype=np.int32)
        rays = np.ascontiguousarray(way / distance[:, None]).ravel()
        mujoco.mj_multiRay(
            self.world.model, self.world.data, eye, rays, None, True, -1, geom, met, None, len(points), 1e3
        )
        return (met < 0) | (met > distance - near)

    def close(self) -> None:
        self.world.close()


def _followed(recording: Recording) -> str:
    """Return the model that the camera follows: the exercise's robot, in a run without it what has most links.

    Of equals it is what moved farthest.
    """
    robot = str(recording.properties("run").get("robot", ""))
    if recording.poses(f"world/{robot}") is not None:
        return robot
    entities = recording.entities("world", "Transform3D")
    best, model = (0, -1.0), ""
    for entity in entities:
        poses = recording.poses(entity)
        if entity.count("/") == 1 and poses is not None and len(poses.times) > 1:
            links = sum(each.startswith(f"{entity}/") and each.count("/") == 2 for each in entities)
            way = float(np.linalg.norm(np.ptp(poses.positions, axis=0)))
            best, model = max((best, model), ((links, way), entity.partition("/")[2]))
    return model


def pose_at(chain: tuple[Poses, ...], time_ns: int) -> tuple[np.ndarray, np.ndarray]:
    """Return position (3,) [m] and axes (3, 3) in the world of the innermost frame of a chain, at a moment [ns]."""
    position, axes = np.zeros(3), np.eye(3)
    for poses in reversed(chain):
        index = max(int(np.searchsorted(poses.times, time_ns, side="right")) - 1, 0)
        turn = rotation(poses.quaternions[index])
        position, axes = turn @ position + poses.positions[index], turn @ axes
    return position, axes


def _geometry(kind: str, facts: dict[str, Any], mesh: Path) -> tuple[str, list[float]]:
    """Return the SDF of a recorded shape ("" if it has no size) and its place in its own frame [m]."""
    middle = [0.0, 0.0, 0.0]
    if kind == "Boxes3D":
        size = [max(2 * float(each), 1e-4) for each in facts["Boxes3D:half_sizes"]]
        return f"<box><size>{_words(size)}</size></box>", facts.get("Boxes3D:centers", middle)
    if kind == "Ellipsoids3D":
        radii = [max(float(each), 1e-4) for each in facts["Ellipsoids3D:half_sizes"]]
        return f"<ellipsoid><radii>{_words(radii)}</radii></ellipsoid>", middle
    if kind == "Mesh3D":
        corners = np.asarray(facts.get("Mesh3D:vertex_positions", []), dtype=float).reshape(-1, 3)
        triangles = np.asarray(facts.get("Mesh3D:triangle_indices", []), dtype=int).reshape(-1, 3) + 1
        if not len(triangles):
            return "", middle
        lines = [f"v {_words(each)}" for each in corners.tolist()]
        mesh.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in triangles.tolist()]))
        return f"<mesh><uri>file://{mesh}</uri></mesh>", middle
    length, radius = max(float(facts[f"{kind}:lengths"]), 1e-4), max(float(facts[f"{kind}:radii"]), 1e-4)
    name = "capsule" if kind == "Capsules3D" else "cylinder"
    if kind == "Capsules3D":  # recorded from its lower end
        low = facts.get("Capsules3D:translations", middle)
        middle = [low[0], low[1], low[2] + length / 2]
    return f"<{name}><radius>{radius!r}</radius><length>{length!r}</length></{name}>", middle


def _words(numbers: Any) -> str:
    return " ".join(repr(float(each)) for each in numbers)
