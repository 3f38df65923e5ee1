"""Plain data of an SDF file: a world of models with links, joints, shapes, sensors and plugins.

The reader creates it; builder, systems, sensors and viewer read it. Nested models are flattened into their top model:
names of links and joints are scoped (`arm::hand`), poses are in the frame of the top model.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.pose import IDENTITY, Pose
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.spherical_coordinates import SphericalCoordinates

UNLIMITED = 1e16
"""Joint limits of this magnitude and above mean "no limit" in Gazebo."""


@dataclass(frozen=True, eq=False)
class Look:
    """The appearance of a surface: `rgba`, values 0..1, times the `texture` (rows, columns, 3), if it has one."""

    rgba: tuple[float, float, float, float]
    texture: NDArray[np.uint8] | None = None


@dataclass(eq=False)
class TriangleMesh:
    """A surface of triangles: `vertices` (n, 3) [m] in the frame of the shape, `triangles` (m, 3) indices of vertices.

    `pieces` are the convex bodies that collide, each the points (k, 3) [m] of its hull; empty for visuals and for
    heightmaps. Shapes with the same file and scale share one instance.

    `uv` (m, 3, 2) are the places of the corners in a texture, from its upper left corner, in fractions of its size.
    `looks` are the materials of the file, `look` (m,) the one of each triangle.
    """

    vertices: NDArray[np.float32]
    triangles: NDArray[np.int32]
    pieces: tuple[NDArray[np.float64], ...] = ()
    uv: NDArray[np.float32] | None = None
    looks: tuple[Look, ...] = ()
    look: NDArray[np.int32] | None = None


@dataclass(eq=False)
class Geometry:
    """One shape; `kind` is its name in SDF.

    `size` holds the full extents [m] as documented at `gz.sim.visuals.VisualShape.size`. `mesh` is the surface of a
    mesh, cone, polyline or heightmap. `heights` (rows, columns) are those of a heightmap [m]: the first row lies at
    -y, the first column at -x.
    """

    kind: str
    size: tuple[float, float, float]
    normal: tuple[float, float, float] = (0.0, 0.0, 1.0)
    mesh: TriangleMesh | None = None
    heights: NDArray[np.float64] | None = None


@dataclass(eq=False)
class Collision:
    """A collision shape: `mu` is the friction coefficient, `bitmask` decides which pairs can touch, `density` is in
    [kg/m^3]. Two shapes bounce off each other with the product of their `restitution`, each 0 to 1.
    """

    name: str
    pose: Pose
    geometry: Geometry
    element: Element
    mu: float = 1.0
    bitmask: int = 0xFF
    density: float = 1000.0
    restitution: float = 0.0


@dataclass(eq=False)
class Visual:
    """A visible shape; each value of `rgba` is 0..1.

    `texture` (rows, columns, 3) is that of its `<material>`. A mesh without a `<material>` has the looks of its file.
    """

    name: str
    pose: Pose
    geometry: Geometry
    element: Element
    rgba: tuple[float, float, float, float] = (0.7, 0.7, 0.7, 1.0)
    texture: NDArray[np.uint8] | None = None


@dataclass(eq=False)
class Inertial:
    """Mass [kg] and inertia [kg m^2] (ixx iyy izz ixy ixz iyz) about the centre of mass, in the frame `pose`."""

    mass: float = 1.0
    moments: tuple[float, float, float, float, float, float] = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
    pose: Pose = IDENTITY


@dataclass(eq=False)
class Sensor:
    """A sensor of a link or of a joint; `element` holds the parameters of its type.

    `pose` is in the frame of the link. For a sensor of a joint, `joint` is that joint's scoped name, `pose` is in the
    joint's frame, and `link` is the child link.
    """

    name: str
    kind: str
    pose: Pose
    element: Element
    link: str
    model: str
    joint: str = ""


@dataclass(eq=False)
class Light:
    """A light: `kind` is directional, point or spot; `direction` (unit) in the light's own frame.

    `pose` is in the world for a light of the world, in the link's frame for a light of a link. Colours are 0..1;
    `range` [m] and the three factors are SDF's attenuation; the angles of a spot are full cone angles [rad].
    """

    name: str
    kind: str
    pose: Pose
    direction: tuple[float, float, float]
    diffuse: tuple[float, float, float]
    specular: tuple[float, float, float] = (0.1, 0.1, 0.1)
    intensity: float = 1.0
    cast_shadows: bool = False
    on: bool = True
    visualize: bool = True
    range: float = 10.0
    constant: float = 1.0
    linear: float = 1.0
    quadratic: float = 0.0
    inner_angle: float = 0.0
    outer_angle: float = 0.0
    falloff: float = 0.0
    element: Element = field(default_factory=lambda: Element("light"))


@dataclass(eq=False)
class Link:
    """A rigid body: scoped name, pose in the frame of the top model, and its shapes, sensors and lights.

    A link of a static model nested in a moving one is `static`: it is fixed to the world.
    """

    name: str
    pose: Pose
    element: Element
    inertial: Inertial = field(default_factory=Inertial)
    collisions: list[Collision] = field(default_factory=list)
    visuals: list[Visual] = field(default_factory=list)
    sensors: list[Sensor] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    gravity: bool = True
    self_collide: bool = False
    static: bool = False

    def parts(self) -> Iterator[tuple[str, Collision | Visual | Sensor | Light]]:
        """Yield (kind, part) of each shape, sensor and light, in the order in which entities are numbered."""
        for kind, parts in (
            ("visual", self.visuals),
            ("collision", self.collisions),
            ("sensor", self.sensors),
            ("light", self.lights),
        ):
            for part in parts:
                yield kind, part


@dataclass(eq=False)
class Mimic:
    """`<mimic>`: the axis follows that of `joint` (scoped name; its second axis when `axis` is axis2) at
    position = multiplier * (leader - reference) + offset.

    Source: SDFormat, element `<mimic>`, http://sdformat.org/spec
    """

    joint: str
    axis: str = "axis"
    multiplier: float = 1.0
    offset: float = 0.0
    reference: float = 0.0


@dataclass(eq=False)
class Axis:
    """One axis of a joint: `direction` (unit) in the child link's frame, limits of position [rad or m], effort [N m or
    N] and velocity [rad/s or m/s], damping, friction, spring, and the initial position [rad or m].
    """

    direction: tuple[float, float, float]
    lower: float = -UNLIMITED
    upper: float = UNLIMITED
    effort: float = float("inf")
    velocity: float = float("inf")
    damping: float = 0.0
    friction: float = 0.0
    spring_stiffness: float = 0.0
    spring_reference: float = 0.0
    initial_position: float = 0.0
    mimic: Mimic | None = None


@dataclass(eq=False)
class Joint:
    """A joint between `parent` and `child` (scoped link names, `parent` may be `world`); `pose` is in the frame of the
    child link.

    `axis2` is the second axis of a universal or revolute2 joint and of a gearbox. `thread_pitch` is the advance of a
    screw [m per turn], positive for a right-handed thread. A gearbox turns `child` by -`gearbox_ratio` times the angle
    of `parent`, both seen from the link `gearbox_reference`. In a joint of the world the names of links begin with
    their model: `model::link`.
    """

    name: str
    kind: str
    parent: str
    child: str
    pose: Pose
    element: Element
    axis: Axis | None = None
    axis2: Axis | None = None
    thread_pitch: float = 1.0
    gearbox_ratio: float = 1.0
    gearbox_reference: str = ""
    sensors: list[Sensor] = field(default_factory=list)


@dataclass(eq=False)
class Plugin:
    """A system requested by `<plugin filename=... name=...>`; `scope` is the nested model that holds it, if any."""

    name: str
    filename: str
    element: Element
    scope: str = ""


@dataclass(eq=False)
class NestedModel:
    """A nested model whose parts were moved into the top model: scoped name (`arm`, `arm::hand`), pose in the frame of
    the top model, scoped name of its canonical link.
    """

    name: str
    pose: Pose
    element: Element
    canonical_link: str = ""


@dataclass(eq=False)
class Model:
    """A top-level model: pose in the world, flattened links and joints, plugins, and whether it can move."""

    name: str
    pose: Pose
    element: Element
    static: bool = False
    self_collide: bool = False
    canonical_link: str = ""
    links: list[Link] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    plugins: list[Plugin] = field(default_factory=list)
    nested: list[NestedModel] = field(default_factory=list)
    version: tuple[int, int] = (1, 10)
    """SDF version of its file, whose rules its frames follow."""

    def link(self, name: str) -> Link | None:
        """Return the link of that scoped name, or None."""
        return next((link for link in self.links if link.name == name), None)

    def joint(self, name: str) -> Joint | None:
        """Return the joint of that scoped name, or None."""
        return next((joint for joint in self.joints if joint.name == name), None)

    def sensors(self) -> list[Sensor]:
        """Return the sensors of all links, then those of all joints, in file order."""
        holders: list[Link | Joint] = [*self.links, *self.joints]
        return [sensor for holder in holders for sensor in holder.sensors]

    def mass(self) -> float:
        """Return the total mass of the links [kg]."""
        return sum(link.inertial.mass for link in self.links)


@dataclass(eq=False)
class WorldDescription:
    """A whole world: step size [ns], `gravity` [m/s^2], `real_time_factor` (0: as fast as possible), `joints` between
    its models, `magnetic_field` [T] and `wind` [m/s] along the world's axes.
    """

    name: str
    element: Element
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.8)
    step_size_ns: int = 1_000_000
    real_time_factor: float = 1.0
    models: list[Model] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    plugins: list[Plugin] = field(default_factory=list)
    spherical_coordinates: SphericalCoordinates | None = None
    magnetic_field: tuple[float, float, float] = (5.5645e-6, 22.8758e-6, -42.3884e-6)
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ambient: tuple[float, float, float] = (0.4, 0.4, 0.4)
    background: tuple[float, float, float] = (0.7, 0.7, 0.7)
    version: tuple[int, int] = (1, 10)
    """SDF version of its file, whose rules its frames follow."""
