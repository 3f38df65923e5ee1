"""The scene graph: every entity of a world as a vertex below its parent, with its pose relative to that parent.

It is built from the description of the world and the entity ids, and rebuilt after models were added or removed.
SceneBroadcaster and PosePublisher publish its poses; `gz.sim.scene.message` converts it to gz.msgs.Scene,
`gz.sim.scene.state` to gz.msgs.SerializedStateMap. Links of nested models are below their nested model, as in Gazebo.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.physics.builder import scoped
from gz_course.sim.gz.sim.pose import IDENTITY, Pose
from gz_course.sim.gz.sim.sdf.description import Model

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

Array = NDArray[np.float64]
KINDS = ("model", "link", "visual", "light")
"""The kinds of entities whose poses are in `/world/W/pose/info`, in this order."""


@dataclass(eq=False, slots=True)
class Vertex:
    """One entity: its id, `kind` (as in `gz.sim.entities`), unscoped name, description, and the pose of its frame in
    its parent's, as of the last call of `SceneGraph.look`. `moves` tells whether the pose can change.
    """

    number: int
    kind: str
    name: str
    described: Any
    pose: Pose
    parent: Vertex | None = None
    static: bool = True
    moves: bool = False
    children: list[Vertex] = field(default_factory=list)

    def below(self) -> Iterator[Vertex]:
        """Yield this vertex and all descendants, parents first, in file order."""
        yield self
        for child in self.children:
            yield from child.below()

    def scoped_name(self) -> str:
        """Return the name with those of its parents below the world: `robot::arm::hand`."""
        if self.parent is None or self.parent.kind == "world":
            return self.name
        return f"{self.parent.scoped_name()}::{self.name}"


class SceneGraph:
    """The vertices of a world, or of some of its models.

    `movers` are the models and links whose pose in their parent can change, parents first; `poses` returns their poses.
    """

    def __init__(self, world: WorldAccess, models: Iterable[Model] | None = None) -> None:
        """Build the graph of the whole world, or of `models` below the world."""
        self._world = world
        description, entities = world.description, world.entities
        self.root = Vertex(entities.number("world", description.name), "world", description.name, description, IDENTITY)
        self.movers: list[Vertex] = []
        self._bodies: list[int] = []
        self._offsets: list[Pose] = []
        for model in description.models if models is None else models:
            self._add_model(model)
        if models is None:
            for light in description.lights:
                self._add(self.root, "light", light.name, (light.name,), light, light.pose)
            for joint in description.joints:
                self._add(self.root, "joint", joint.name, (joint.name,), joint, joint.pose)
        places = {id(vertex): place for place, vertex in enumerate(self.movers)}
        self._parents = np.array([places.get(id(vertex.parent), -1) for vertex in self.movers], dtype=np.intp)
        self._body_ids = np.array(self._bodies, dtype=np.intp)
        self._positions = np.array([pose.position for pose in self._offsets], dtype=np.float64).reshape(-1, 3)
        self._quaternions = np.array([pose.quaternion for pose in self._offsets], dtype=np.float64).reshape(-1, 4)

    def __iter__(self) -> Iterator[Vertex]:
        """Yield the vertices below the world, parents first, in file order."""
        for child in self.root.children:
            yield from child.below()

    def poses(self) -> tuple[Array, Array]:
        """Return the present poses of the movers in their parents: positions (n, 3) [m], unit quaternions (n, 4)
        (wxyz).
        """
        world = self._world
        world.truth.refresh()
        data = world.data
        positions, quaternions = _chain(
            data.xpos[self._body_ids], data.xquat[self._body_ids], self._positions, self._quaternions
        )
        # The additional last row is the world, parent number -1.
        above_positions = np.vstack((positions, np.zeros((1, 3))))[self._parents]
        above_quaternions = np.vstack((quaternions, [[1.0, 0.0, 0.0, 0.0]]))[self._parents]
        back = above_quaternions * (1.0, -1.0, -1.0, -1.0)
        return _chain(-_rotate(back, above_positions), back, positions, quaternions)

    def look(self) -> None:
        """Update the poses of the movers in their vertices."""
        for vertex, position, quaternion in zip(self.movers, *self.poses(), strict=True):
            vertex.pose = Pose(position, quaternion)

    def dot(self) -> str:
        """Return the graph in Graphviz's DOT language, in the layout of Gazebo's `/world/W/scene/graph`.

        Source: https://graphviz.org/doc/info/lang.html
        """
        vertices = sorted((self.root, *self), key=lambda vertex: vertex.number)
        lines = [f'  {vertex.number} [label="{vertex.name} ({vertex.number})"];' for vertex in vertices]
        lines += [
            f"  {vertex.parent.number} -> {vertex.number} [label=1];"
            for vertex in vertices
            if vertex.parent is not None
        ]
        return "\n".join(("digraph {", *lines, "}", ""))

    def _add_model(self, model: Model) -> None:
        top = self._add(self.root, "model", model.name, (model.name,), model, model.pose, static=model.static)
        self._let_move(top, model, model.canonical_link, model)
        owners = {"": (top, IDENTITY)}
        for nested in model.nested:
            above, place = _owner(owners, nested.name)
            path = (model.name, nested.name)
            vertex = self._add(above, "model", _own(nested.name), path, nested, place.inverse() * nested.pose)
            vertex.static = model.static
            owners[nested.name] = (vertex, nested.pose)
            self._let_move(vertex, model, nested.canonical_link, nested)
        for link in model.links:
            above, place = _owner(owners, link.name)
            path = (model.name, link.name)
            vertex = self._add(above, "link", _own(link.name), path, link, place.inverse() * link.pose)
            vertex.static = model.static or link.static
            for kind, part in link.parts():
                self._add(vertex, kind, part.name, (*path, part.name), part, part.pose, static=vertex.static)
            self._let_move(vertex, model, link.name, link)
        for joint in model.joints:
            path = (model.name, joint.name)
            vertex = self._add(_owner(owners, joint.name)[0], "joint", _own(joint.name), path, joint, joint.pose)
            for sensor in joint.sensors:
                self._add(vertex, "sensor", sensor.name, (*path, sensor.name), sensor, sensor.pose)

    def _add(
        self,
        parent: Vertex,
        kind: str,
        name: str,
        path: tuple[str, ...],
        described: Any,
        pose: Pose,
        *,
        static: bool = True,
    ) -> Vertex:
        number = self._world.entities.number(kind, *path)
        vertex = Vertex(number, kind, name, described, pose, parent, static)
        parent.children.append(vertex)
        return vertex

    def _let_move(self, vertex: Vertex, model: Model, link_name: str, described: Any) -> None:
        """Record the body that carries a frame of a model, and the pose of the frame in that body."""
        link = model.link(link_name)
        if model.static or link is None:
            return
        body = mujoco.mj_name2id(self._world.model, mujoco.mjtObj.mjOBJ_BODY, scoped(model, link.name))
        if body < 0:  # the frame is fixed to the world
            return
        place = IDENTITY if described is model else described.pose
        vertex.moves = True
        self.movers.append(vertex)
        self._bodies.append(body)
        self._offsets.append(IDENTITY if described is link else link.pose.inverse() * place)


def _own(name: str) -> str:
    return name.rsplit("::", 1)[-1]


def _owner(owners: dict[str, tuple[Vertex, Pose]], name: str) -> tuple[Vertex, Pose]:
    """Return the nested model that a scoped name belongs to, or the top model, with its pose in the top model."""
    return owners.get(name.rpartition("::")[0], owners[""])


def _chain(
    first_positions: Array, first_quaternions: Array, then_positions: Array, then_quaternions: Array
) -> tuple[Array, Array]:
    """Return the products of n pairs of poses (`Pose.__mul__` for arrays)."""
    positions = first_positions + _rotate(first_quaternions, then_positions)
    return positions, _multiply(first_quaternions, then_quaternions)


def _multiply(a: Array, b: Array) -> Array:
    """Return the Hamilton products of n pairs of quaternions (wxyz)."""
    aw, ax, ay, az = a.T
    bw, bx, by, bz = b.T
    return np.stack(
        (
            aw * bw - ax * bx - ay * by - az * bz,
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
        ),
        axis=1,
    )


def _rotate(quaternions: Array, vectors: Array) -> Array:
    """Return n vectors (n, 3) rotated by quaternions (n, 4): v + 2 w (q x v) + 2 q x (q x v)."""
    turned = 2.0 * np.cross(quaternions[:, 1:], vectors)
    rotated: Array = vectors + quaternions[:, :1] * turned + np.cross(quaternions[:, 1:], turned)
    return rotated
