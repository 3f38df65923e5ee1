"""`<inertial>`: mass, inertia and centre of mass, as stated or (`auto="true"`) as those of the collisions.

Part of the reader, called by `gz.sim.sdf.links` once the collisions of a link are known.
Source: SDFormat, element `<inertial>`, http://sdformat.org/spec; `auto`:
https://gazebosim.org/api/sim/8/auto_inertia_calculation.html
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose, matrix
from gz_course.sim.gz.sim.sdf.description import Collision, Geometry, Inertial, Link, TriangleMesh
from gz_course.sim.gz.sim.sdf.element import Element

Matrix = NDArray[np.float64]
WATER = 1000.0
"""The default density of SDF [kg/m^3]."""
_HEAVIEST = 1e12  # [kg]


def is_automatic(element: Element) -> bool:
    """Return whether an `<inertial>` requests the inertia of the collisions."""
    return element.attributes.get("auto", "false").lower() in ("true", "1")


def read_inertial(element: Element, pose: Pose, static: bool) -> Inertial:
    """Return the values of an `<inertial>`. Raises SdfError for a physically impossible body, unless it is static."""
    mass = element.number("mass", 1.0)
    if not static and not 0.0 < mass < _HEAVIEST:
        raise _impossible_mass(element.find("mass") or element, mass)
    inertia = element.find("inertia")
    values = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    if inertia is not None:
        tags = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        values = [inertia.number(tag, default) for tag, default in zip(tags, values, strict=True)]
        if not all(abs(value) < 1e15 for value in values):
            raise inertia.error("<inertia> must be finite")
        if not static:
            _check(inertia, values)
    ixx, iyy, izz, ixy, ixz, iyz = values
    return Inertial(mass, (ixx, iyy, izz, ixy, ixz, iyz), pose)


def tell_what_gazebo_refuses(element: Element, link: Link, diagnostics: Diagnostics) -> None:
    """Say that Gazebo refuses the file of a link whose `<inertial>` is taken here: static, or wrong by up to 0.1 %.

    Source: libsdformat 14, `Link::Load` (LINK_INERTIA_INVALID); gz-math 7, `MassMatrix3::IsValid`
    """
    ixx, iyy, izz, ixy, _, _ = moments = link.inertial.moments
    rounding = 5.0 * np.finfo(float).eps * abs(ixx + iyy + izz)
    small, middle, large = np.linalg.eigvalsh(tensor(moments))
    minors = (ixx, ixx * iyy - ixy**2, np.linalg.det(tensor(moments)), small, small + middle - large)
    if link.inertial.mass < 0.0 or min(minors) < -rounding:
        diagnostics.differs(
            (element.find("inertia") or element).where,
            f"the inertia of link '{link.name}' is that of no body, for which Gazebo refuses the whole file: "
            f"'A link named {link.name} has invalid inertia'; no moment may be below 0, or above the sum of the others",
        )


def _check(element: Element, values: list[float]) -> None:
    small, middle, large = np.linalg.eigvalsh(tensor(values))
    if small <= 0.0:
        raise element.error(
            f"<inertia> is not that of a body: its smallest principal moment is {small:.3g}, not positive"
        )
    if small + middle < large * (1.0 - 1e-3):
        raise element.error(
            "<inertia> is not that of a body: the two smaller principal moments "
            f"({small:.3g} + {middle:.3g}) must add up to at least the largest ({large:.3g})"
        )


def _impossible_mass(element: Element, mass: float) -> SdfError:
    return element.error(f"<mass> must be greater than zero and below {_HEAVIEST:g} kg, got {mass:g}")


def tensor(moments: Sequence[float]) -> Matrix:
    """Return the inertia (3, 3) of `moments`, which are ixx iyy izz ixy ixz iyz [kg m^2]."""
    ixx, iyy, izz, ixy, ixz, iyz = moments
    return np.array(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz)))


def point_inertia(position: Matrix) -> Matrix:
    """Return the inertia (3, 3) of a unit mass at `position` [m] about the origin [m^2].

    Source: parallel axis theorem, https://en.wikipedia.org/wiki/Parallel_axis_theorem#Tensor_generalization
    """
    return float(position @ position) * np.eye(3) - np.outer(position, position)


def automatic_inertial(element: Element, collisions: Sequence[Collision], diagnostics: Diagnostics) -> Inertial:
    """Return the inertia of the collisions, each with its own density [kg/m^3], else that of the link's `<inertial>`,
    else that of water. A `<mass>` beside `auto` scales the result.
    """
    link_density = element.number("density", WATER)
    mass, moment = 0.0, np.zeros(3)
    bodies: list[tuple[float, NDArray[np.float64], Matrix]] = []
    for collision in collisions:
        body = solid(collision.geometry)
        if body is None:
            diagnostics.warn(
                collision.element.where,
                f"collision '{collision.name}' is a {collision.geometry.kind}, which has no volume; the automatic "
                "inertia leaves it out",
            )
            continue
        volume, centre, inertia = body
        density = collision.element.number("density", link_density)
        if not 0.0 < density < 1e9:
            raise collision.element.error(f"<density> must be greater than zero and below 1e+09, got {density:g}")
        turn = matrix(collision.pose.quaternion)
        place = collision.pose.transform(centre)
        bodies.append((density * volume, place, density * (turn @ inertia @ turn.T)))
        mass += density * volume
        moment += density * volume * place
    if not bodies:
        diagnostics.warn(
            element.where, "auto='true' finds no collision with a volume; mass 1 kg and inertia 1 are used"
        )
        return Inertial()
    centre = moment / mass
    total = np.zeros((3, 3))
    for part, place, inertia in bodies:
        total += inertia + part * point_inertia(place - centre)
    stated = element.number("mass", mass)
    if not 0.0 < stated < _HEAVIEST or not np.linalg.eigvalsh(total)[0] > 0.0:
        raise _impossible_mass(element, stated)
    total *= stated / mass
    moments = (total[0, 0], total[1, 1], total[2, 2], total[0, 1], total[0, 2], total[1, 2])
    ixx, iyy, izz, ixy, ixz, iyz = (float(value) for value in moments)
    return Inertial(stated, (ixx, iyy, izz, ixy, ixz, iyz), Pose(centre))


def solid(geometry: Geometry) -> tuple[float, NDArray[np.float64], Matrix] | None:
    """Return volume [m^3], centre of mass (3,) [m] and inertia about it (3, 3) [m^5] of a shape of density 1, in the
    frame of the shape; None for a shape without volume.

    Source: https://en.wikipedia.org/wiki/List_of_moments_of_inertia
    """
    x, y, z = geometry.size
    centre = np.zeros(3)
    if geometry.kind == "box":
        volume = x * y * z
        moments = np.array((y * y + z * z, x * x + z * z, x * x + y * y)) / 12.0
    elif geometry.kind in ("sphere", "ellipsoid"):
        volume = math.pi / 6.0 * x * y * z
        moments = np.array((y * y + z * z, x * x + z * z, x * x + y * y)) / 20.0
    elif geometry.kind == "cylinder":
        radius = x / 2.0
        volume = math.pi * radius**2 * z
        across = radius**2 / 4.0 + z * z / 12.0
        moments = np.array((across, across, radius**2 / 2.0))
    elif geometry.kind == "cone":
        radius = x / 2.0
        volume = math.pi * radius**2 * z / 3.0
        across = 3.0 / 20.0 * radius**2 + 3.0 / 80.0 * z * z
        moments = np.array((across, across, 0.3 * radius**2))
        centre = np.array((0.0, 0.0, -z / 4.0))
    elif geometry.kind == "capsule":
        radius = x / 2.0
        middle, caps = math.pi * radius**2 * z, 4.0 / 3.0 * math.pi * radius**3
        volume = middle + caps
        across = middle * (radius**2 / 4.0 + z * z / 12.0)
        across += caps * (0.4 * radius**2 + z * z / 4.0 + 0.375 * z * radius)
        along = middle * radius**2 / 2.0 + caps * 0.4 * radius**2
        return volume, centre, np.diag((across, across, along))
    elif geometry.mesh is not None and geometry.kind != "heightmap":
        return _mesh_solid(geometry.mesh)
    else:
        return None
    return volume, centre, np.diag(volume * moments)


def _mesh_solid(mesh: TriangleMesh) -> tuple[float, NDArray[np.float64], Matrix] | None:
    """Sum the tetrahedra between the triangles and the mean of the vertices, which is exact for a closed surface.

    Source: F. Tonon, Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor in Terms of its Vertex
    Coordinates, Journal of Mathematics and Statistics 1 (1), 2004
    """
    vertices = mesh.vertices.astype(np.float64)
    middle = vertices.mean(axis=0)
    corners = vertices[mesh.triangles] - middle
    signed = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
    volume = float(signed.sum())
    if abs(volume) < 1e-15:
        return None
    together = corners.sum(axis=1)
    centre = np.einsum("i,ij->j", signed, together) / (4.0 * volume)
    second = np.einsum("i,ij,ik->jk", signed, together, together)
    second += np.einsum("i,inj,ink->jk", signed, corners, corners)
    second = second / 20.0 - volume * np.outer(centre, centre)
    inertia = np.trace(second) * np.eye(3) - second
    # An inverted surface gives the same body with the opposite sign.
    return abs(volume), middle + centre, inertia * math.copysign(1.0, volume)
