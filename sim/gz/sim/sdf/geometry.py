"""Shapes and surfaces of `<collision>` and `<visual>`: geometry, friction, colour.

Part of the reader: `Element` -> `Geometry`, `mu`, `rgba`. Shapes this simulator does not build are reported
and left out.
"""

from __future__ import annotations

from gz.sim.errors import Diagnostics, nearest
from gz.sim.sdf.description import Geometry
from gz.sim.sdf.element import Element
from gz.sim.sdf.vocabulary import CHILDREN

Rgba = tuple[float, float, float, float]
_UNBUILT = ("mesh", "cone", "heightmap", "polyline", "image")
_SCRIPT_COLOURS: dict[str, tuple[float, float, float]] = {
    "grey": (0.7, 0.7, 0.7),
    "darkgrey": (0.175, 0.175, 0.175),
    "white": (1.0, 1.0, 1.0),
    "flatblack": (0.1, 0.1, 0.1),
    "black": (0.0, 0.0, 0.0),
    "red": (1.0, 0.0, 0.0),
    "green": (0.0, 1.0, 0.0),
    "blue": (0.0, 0.0, 1.0),
    "yellow": (1.0, 1.0, 0.0),
    "orange": (1.0, 0.51, 0.0),
    "purple": (1.0, 0.0, 1.0),
    "turquoise": (0.0, 1.0, 1.0),
    "indigo": (0.33, 0.0, 0.5),
    "gold": (0.8, 0.65, 0.2),
    "wood": (0.6, 0.45, 0.25),
}


def read_geometry(owner: Element, diagnostics: Diagnostics) -> Geometry | None:
    """Return the shape of a `<collision>` or `<visual>`, or None (with a warning) when there is none to
    build.
    """
    holder = owner.find("geometry")
    shapes = [child for child in holder.children if child.tag in CHILDREN["geometry"]] if holder else []
    if holder is None or not shapes:
        diagnostics.warn(owner.where, f"<{owner.tag}> '{owner.name}' has no <geometry> with a shape, it is left out")
        return None
    shape = shapes[0]
    if shape.tag == "empty":
        return None
    if shape.tag in _UNBUILT:
        diagnostics.warn(
            shape.where,
            f"<{shape.tag}> geometry is not simulated here, so <{owner.tag}> '{owner.name}' is left out; "
            "use box, sphere, cylinder, capsule, ellipsoid or plane",
        )
        return None
    return _primitive(shape)


def _primitive(shape: Element) -> Geometry:
    if shape.tag == "box":
        size = shape.vector("size", (1.0, 1.0, 1.0))
        return Geometry("box", _positive(shape, "size", size))
    if shape.tag == "sphere":
        diameter = 2.0 * shape.number("radius", 1.0)
        return Geometry("sphere", _positive(shape, "radius", (diameter, diameter, diameter)))
    if shape.tag in ("cylinder", "capsule"):
        diameter = 2.0 * shape.number("radius", 0.5)
        size = (diameter, diameter, shape.number("length", 1.0))
        return Geometry(shape.tag, _positive(shape, "radius and length", size))
    if shape.tag == "ellipsoid":
        radii = shape.vector("radii", (1.0, 1.0, 1.0))
        return Geometry("ellipsoid", _positive(shape, "radii", tuple(2.0 * radius for radius in radii)))
    extent = shape.vector("size", (1.0, 1.0))
    normal = shape.vector("normal", (0.0, 0.0, 1.0))
    if not any(normal):
        raise shape.error("the <normal> of <plane> has no length; use for example 0 0 1")
    width, depth, _ = _positive(shape, "size", (*extent, 1.0))
    return Geometry("plane", (width, depth, 0.0), (normal[0], normal[1], normal[2]))


def _positive(shape: Element, what: str, size: tuple[float, ...]) -> tuple[float, float, float]:
    if not all(0.0 < value < 1e9 for value in size):
        raise shape.error(f"the {what} of <{shape.tag}> must be greater than zero")
    return size[0], size[1], size[2]


def read_friction(collision: Element) -> float:
    """Return the Coulomb friction coefficient of a `<collision>` (Gazebo's default is 1)."""
    surface = collision.find("surface/friction/ode")
    mu = surface.number("mu", 1.0) if surface is not None else 1.0
    if mu < 0.0:
        raise collision.error(f"friction <mu> must not be negative, got {mu}")
    return min(mu, 1e6)


def read_colour(visual: Element, diagnostics: Diagnostics) -> Rgba:
    """Return the colour of a `<visual>`: diffuse, else ambient, else its Gazebo script, else grey."""
    transparency = min(1.0, max(0.0, visual.number("transparency", 0.0)))
    material = visual.find("material")
    red, green, blue, alpha = 0.7, 0.7, 0.7, 1.0
    if material is not None:
        stated = material.find("diffuse") or material.find("ambient")
        script = material.text_of("script/name")
        if stated is not None and stated.text:
            words = stated.text.split()
            values = stated.floats(4 if len(words) == 4 else 3)
            red, green, blue = (min(1.0, max(0.0, value)) for value in values[:3])
            alpha = min(1.0, max(0.0, values[3])) if len(values) == 4 else 1.0
        elif script:
            word = script.rsplit("/", 1)[-1].lower()
            if word in _SCRIPT_COLOURS:
                red, green, blue = _SCRIPT_COLOURS[word]
            else:
                hint = nearest(word, _SCRIPT_COLOURS, listing="colours that are known are")
                diagnostics.warn(material.where, f"material script '{script}' is not known, grey is used; {hint}")
    return red, green, blue, alpha * (1.0 - transparency)
