"""Makes SDF elements that stand where their URDF stands, so that every message about them names its file and line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element


def make(
    source: Element,
    tag: str,
    text: str = "",
    attributes: Mapping[str, str] | None = None,
    children: Sequence[Element] = (),
) -> Element:
    """Make an element at the file and line of `source`."""
    return Element(tag, dict(attributes or {}), text, list(children), source.file, source.line)


def write(values: Sequence[float]) -> str:
    """Write floats so that reading gives the same floats."""
    return " ".join(repr(float(value)) for value in values)


def place(source: Element, pose: Pose, relative_to: str = "") -> Element:
    """Make a `<pose>`; as a quaternion, which is exact where roll, pitch and yaw are not."""
    w, x, y, z = pose.quaternion
    attributes = {"relative_to": relative_to} if relative_to else {}
    attributes["rotation_format"] = "quat_xyzw"
    return make(source, "pose", write((*pose.position, x, y, z, w)), attributes)


def set_value(element: Element, path: str, text: str, source: Element) -> None:
    """Give `element` the text at `path` (`surface/friction/ode/mu`), instead of what stood there."""
    *above, last = path.split("/")
    for tag in above:
        below = element.find(tag)
        if below is None:
            below = make(source, tag)
            element.children.append(below)
        element = below
    element.children = [child for child in element.children if child.tag != last]
    element.children.append(make(source, last, text))
