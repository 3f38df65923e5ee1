"""Makes SDF elements that keep the file and line of their URDF elements, for messages."""

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
    """Return a new element with the file and line of `source`."""
    return Element(tag, dict(attributes or {}), text, list(children), source.file, source.line)


def write(values: Sequence[float]) -> str:
    """Return floats as the shortest text from which the same floats are read."""
    return " ".join(repr(float(value)) for value in values)


def place(source: Element, pose: Pose, relative_to: str = "") -> Element:
    """Return a `<pose>` with a quaternion, because roll, pitch and yaw would be rounded."""
    w, x, y, z = pose.quaternion
    attributes = {"relative_to": relative_to} if relative_to else {}
    attributes["rotation_format"] = "quat_xyzw"
    return make(source, "pose", write((*pose.position, x, y, z, w)), attributes)


def set_value(element: Element, path: str, text: str, source: Element) -> None:
    """Set the text of the element at `path` (`surface/friction/ode/mu`) below `element`."""
    *above, last = path.split("/")
    for tag in above:
        below = element.find(tag)
        if below is None:
            below = make(source, tag)
            element.children.append(below)
        element = below
    element.children = [child for child in element.children if child.tag != last]
    element.children.append(make(source, last, text))
