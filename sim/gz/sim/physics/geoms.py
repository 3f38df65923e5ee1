"""Adds the shapes of links as MuJoCo geoms: collisions in group 3, visuals in group 1.

Names: collision `model::link::name`, visual `model::link::name#visual`. A collision that is not convex becomes several
geoms: the first has the name, the others are `name#1`, `name#2`, ... So does a visible mesh that has several looks.
Equal meshes share one MuJoCo mesh, equal textures one MuJoCo texture.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.physics import recipe
from gz_course.sim.gz.sim.physics.contact_pairs import Shape
from gz_course.sim.gz.sim.physics.materials import Materials
from gz_course.sim.gz.sim.physics.static_parts import StaticParts
from gz_course.sim.gz.sim.pose import Pose, Vector, quaternion_between, rotate
from gz_course.sim.gz.sim.sdf.description import (
    Collision,
    Geometry,
    Look,
    Model,
    TriangleMesh,
    Visual,
    WorldDescription,
)
from gz_course.sim.gz.sim.sdf.materials import GREY
from gz_course.sim.gz.sim.sdf.tyres import ROUND, Tyre, read_tyre

COLLISION_GROUP = 3
VISUAL_GROUP = 1
SITE_GROUP = 5
VISUAL_SUFFIX = "#visual"
_WHOLE = -1
"""The piece of a mesh that is its whole surface; -2, -3, ... are the parts of its first, second, ... look."""
_UNDERGROUND = 1.0
"""Thickness [m] of the ground below the lowest point of a heightmap."""
_TYRE = 0.002
"""Length of the capsule of a tyre that skids, relative to its diameter."""
_LENS = 0.1
"""Least thickness of the ellipsoid of a wheel, relative to its diameter; of a thinner one contacts are inexact."""
_PLATE = 0.001
"""Half the thickness [m] of a plane that moves."""

_TYPES = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE,
    "ellipsoid": mujoco.mjtGeom.mjGEOM_ELLIPSOID,
    "plane": mujoco.mjtGeom.mjGEOM_PLANE,
}


def geom_names(name: str, part: Collision | Visual) -> list[str]:
    """Return the names of all geoms of a part; `name` is `model::link::part`."""
    if isinstance(part, Visual):
        name += VISUAL_SUFFIX
        count = len(looks_of(part))
    else:
        mesh = part.geometry.mesh
        count = len(mesh.pieces) if mesh is not None and mesh.pieces else 1
    return [name, *(f"{name}#{number}" for number in range(1, count))]


def looks_of(part: Visual) -> list[Look]:
    """Return the looks of the geoms of a visual: one, or those of its mesh's file if it has no `<material>`."""
    mesh = part.geometry.mesh
    red, green, blue, alpha = part.rgba
    if mesh is None or not mesh.looks or part.element.find("material") is not None or (red, green, blue) != GREY[:3]:
        return [Look(part.rgba, part.texture)]
    return [Look((*look.rgba[:3], look.rgba[3] * alpha), look.texture) for look in mesh.looks]


@dataclass(frozen=True)
class Wheel:
    """A driven wheel: whether it skids, and the direction of its axle in the frame of its link."""

    skids: bool
    axle: Vector


class Geoms:
    """Adds geoms to one spec; holds the friction ranks of the world and the meshes already added."""

    def __init__(self, spec: mujoco.MjSpec, world: WorldDescription, diagnostics: Diagnostics) -> None:
        self._spec = spec
        self._diagnostics = diagnostics
        self._solref = recipe.contact_solref(world.step_size_ns * 1e-9)
        collisions = [c for model in world.models for link in model.links for c in link.collisions]
        self._ranks = recipe.friction_ranks(collision.mu for collision in collisions)
        self._meshes: dict[tuple[TriangleMesh, int], str] = {}
        self._fields: dict[TriangleMesh, str] = {}
        self._materials = Materials(spec)
        self.shapes: list[Shape] = []
        """The collisions that were added."""

    def add_collision(
        self,
        body: mujoco.MjsBody | StaticParts,
        name: str,
        base: Pose,
        part: Collision,
        model: Model,
        *,
        wheel: Wheel | None,
        moving: bool,
        drags: bool = False,
    ) -> None:
        """Add a collision of a model; `base` is the pose of its link in the body.

        The cylinder of a driven `wheel` becomes an ellipsoid. If it is a tyre with directions, cylinder and sphere
        become a short capsule along the axle (`contact_pairs`). A sphere that is fixed to a robot with driven wheels
        `drags` on the ground.
        """
        geometry = part.geometry
        pose = base * part.pose
        tyre = self._tyre(part, wheel)
        if wheel is not None and tyre is not None:
            if geometry.kind == "sphere":
                axle = rotate(pose.inverse().quaternion, rotate(base.quaternion, wheel.axle))
                pose = pose * Pose(quaternion=quaternion_between((0.0, 0.0, 1.0), axle))
            x, y, _ = geometry.size
            geometry = Geometry("capsule", (x, y, _TYRE * x))
        elif wheel is not None and geometry.kind == "cylinder":
            # An ellipsoid has one contact point, in the middle plane of the wheel, so that the wheel separation is
            # exact.
            x, y, width = geometry.size
            geometry = Geometry("ellipsoid", (x, y, max(width, _LENS * x)))
        if geometry.kind == "plane" and moving:
            text = f"a plane cannot move; collision '{part.name}' becomes a thin box"
            self._diagnostics.warn(part.element.where, text)
        names = geom_names(name, part)
        for number, each in enumerate(names):
            geom = self._add(body, each, pose, geometry, moving, piece=number)
            if geometry.kind == "plane" and not moving:
                geom.size = (0.0, 0.0, 1.0)  # infinite
            drags = drags and geometry.kind == "sphere"
            self.shapes.append(Shape(each, part, model, moving, tyre, drags))
            geom.group = COLLISION_GROUP
            geom.contype = geom.conaffinity = part.bitmask
            geom.solref = self._solref
            geom.solimp[:2] = recipe.CONTACT_IMPEDANCE
            geom.priority = self._ranks[part.mu]
            geom.condim = 3 if part.mu > 0.0 else 1
            geom.friction = (max(part.mu, 1e-6), 0.005, 0.0001)

    def _tyre(self, part: Collision, wheel: Wheel | None) -> Tyre | None:
        """Return the directions of the friction of a wheel: what it states, or those of one that skids. Warn if that is
        no tyre.
        """
        stated = read_tyre(part, wheel.axle) if wheel is not None else None
        if wheel is None or not wheel.skids or stated is not None:
            return stated
        kind = part.geometry.kind
        if kind in ROUND:
            return Tyre(recipe.SKIDDING * part.mu, part.mu)
        text = f"wheel collision '{part.name}' is a {kind} and grips in all directions, so its robot, which must "
        self._diagnostics.warn(part.element.where, f"{text}skid to turn, turns too slowly; make it a cylinder")
        return None

    def add_visual(
        self, body: mujoco.MjsBody | StaticParts, name: str, base: Pose, part: Visual, *, moving: bool
    ) -> None:
        """Add a visual, without contacts or mass; `base` is the pose of its link in the body."""
        looks = looks_of(part)
        for number, (each, look) in enumerate(zip(geom_names(name, part), looks, strict=True)):
            piece = _WHOLE if len(looks) == 1 else _WHOLE - 1 - number
            geom = self._add(body, each, base * part.pose, part.geometry, moving, piece=piece)
            geom.group = VISUAL_GROUP
            geom.contype = geom.conaffinity = 0
            geom.rgba = look.rgba
            if look.texture is not None or part.element.find("material") is not None:
                geom.material = self._materials.name_of(part, look)

    def _add(
        self, body: mujoco.MjsBody | StaticParts, name: str, pose: Pose, geometry: Geometry, moving: bool, *, piece: int
    ) -> mujoco.MjsGeom:
        """Add the shape alone: the convex `piece` of a mesh, its whole surface, or the part of one look."""
        if geometry.heights is not None and geometry.mesh is not None:
            field = self._fields.get(geometry.mesh) or self._add_field(geometry.mesh, geometry)
            lift = Pose((0.0, 0.0, float(geometry.heights.min())))
            geom = _placed(body, name, pose * lift, mujoco.mjtGeom.mjGEOM_HFIELD)
            geom.hfieldname = field
        elif geometry.mesh is not None:
            key = (geometry.mesh, piece)
            mesh = self._meshes.get(key) or self._add_mesh(key)
            geom = _placed(body, name, pose, mujoco.mjtGeom.mjGEOM_MESH)
            geom.meshname = mesh
        elif geometry.kind == "plane":
            pose = pose * Pose(quaternion=quaternion_between((0.0, 0.0, 1.0), geometry.normal))
            x, y = geometry.size[0] / 2.0, geometry.size[1] / 2.0
            geom = _placed(body, name, pose, mujoco.mjtGeom.mjGEOM_BOX if moving else mujoco.mjtGeom.mjGEOM_PLANE)
            geom.size = (x, y, _PLATE if moving else 1.0)
        else:
            geom = _placed(body, name, pose, _TYPES[geometry.kind])
            geom.size = _half_sizes(geometry)
        geom.mass = 0.0  # the mass is that of the link
        return geom

    def _add_mesh(self, key: tuple[TriangleMesh, int]) -> str:
        surface, piece = key
        name = self._meshes[key] = f"mesh{len(self._meshes)}"
        mesh = self._spec.add_mesh(name=name)
        # A mesh may be open; MuJoCo accepts any mesh with shell inertia.
        mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        if piece >= 0:
            mesh.uservert = surface.pieces[piece].ravel()
            return name
        vertices, triangles, uv = surface.vertices.astype(np.float64), surface.triangles, surface.uv
        if piece < _WHOLE and surface.look is not None:
            rows = surface.look == _WHOLE - 1 - piece
            used, flat = np.unique(triangles[rows], return_inverse=True)
            triangles = flat.astype(np.int32)
            vertices, uv = vertices[used], None if uv is None else uv[rows]
        if uv is not None:
            mesh.usertexcoord = uv.ravel()
            mesh.userfacetexcoord = np.arange(3 * len(uv))
        while len(vertices) < 4:
            vertices = np.concatenate((vertices, vertices[:1]))
        mesh.uservert = vertices.ravel()
        mesh.userface = triangles.ravel()
        return name

    def _add_field(self, surface: TriangleMesh, geometry: Geometry) -> str:
        heights = geometry.heights
        assert heights is not None
        name = self._fields[surface] = f"heightmap{len(self._fields)}"
        low, high = float(heights.min()), float(heights.max())
        size = (geometry.size[0] / 2.0, geometry.size[1] / 2.0, max(high - low, 1e-6), _UNDERGROUND)
        field = self._spec.add_hfield(name=name, size=size, nrow=heights.shape[0], ncol=heights.shape[1])
        # MuJoCo requires values from 0 to 1.
        field.userdata = ((heights - low) / max(high - low, 1e-6)).ravel()
        return name


def _placed(body: mujoco.MjsBody | StaticParts, name: str, pose: Pose, kind: mujoco.mjtGeom) -> mujoco.MjsGeom:
    return body.add_geom(name=name, type=kind, pos=pose.position, quat=pose.quaternion)


def _half_sizes(geometry: Geometry) -> Vector:
    x, y, z = (value / 2.0 for value in geometry.size)
    if geometry.kind == "sphere":
        return np.array((x, 0.0, 0.0))
    if geometry.kind in ("cylinder", "capsule"):
        return np.array((x, z, 0.0))
    return np.array((x, y, z))
