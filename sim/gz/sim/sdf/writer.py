"""Writes elements as XML text, the inverse of `gz.sim.sdf.element.parse`."""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr

from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element


def to_xml(element: Element, indent: str = "") -> str:
    """Return an element with its children as indented XML lines, without a final newline."""
    attributes = "".join(f" {name}={quoteattr(_clean(value))}" for name, value in element.attributes.items())
    text = escape(_clean(element.text))
    if not element.children:
        return f"{indent}<{element.tag}{attributes}>{text}</{element.tag}>" if text else (
            f"{indent}<{element.tag}{attributes}/>"
        )  # fmt: skip
    lines = [f"{indent}<{element.tag}{attributes}>"]
    if text:
        lines.append(f"{indent}  {text}")
    lines += (to_xml(child, indent + "  ") for child in element.children)
    lines.append(f"{indent}</{element.tag}>")
    return "\n".join(lines)


def pose_element(pose: Pose, version: tuple[int, int]) -> Element:
    """Return a `<pose>` that reads back as `pose`: an exact quaternion from SDF 1.9 on, roll, pitch and yaw before."""
    position = " ".join(_number(value) for value in pose.position)
    if version >= (1, 9):
        w, x, y, z = (_number(value) for value in pose.quaternion)
        return Element("pose", {"rotation_format": "quat_xyzw"}, f"{position} {x} {y} {z} {w}")
    return Element("pose", {}, f"{position} {' '.join(_number(value) for value in pose.rpy())}")


def _number(value: float) -> str:
    return repr(float(value) + 0.0).removesuffix(".0")


def _clean(text: str) -> str:
    """Remove control characters, which XML cannot hold."""
    return "".join(letter for letter in text if letter >= " " or letter in "\t\n\r")
