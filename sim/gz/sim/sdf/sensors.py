"""`<sensor>` inside a `<joint>`: a force-torque sensor between two links.

Part of the reader, called by `gz.sim.sdf.joints`; the sensors of links are read with their link.
Source: SDFormat, element `<sensor>`, http://sdformat.org/spec
"""

from __future__ import annotations

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Sensor
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frames import Scope


def read_joint_sensors(joint: Joint, scope: Scope, model: Model, diagnostics: Diagnostics) -> list[Sensor]:
    """Return the sensors of a joint, with poses in the frame of the joint.

    Raises `SdfError` for a sensor without name or type and for two of the same name.
    """
    found: list[Sensor] = []
    for element in joint.element.all("sensor"):
        if not element.name:
            raise element.error("<sensor> needs a name attribute")
        if any(other.name == element.name for other in found):
            raise element.error(f"joint '{joint.name}' already has a <sensor> called '{element.name}'")
        kind = element.attributes.get("type", "")
        if not kind:
            raise element.error(f"<sensor> '{element.name}' needs a type attribute, for example type='force_torque'")
        pose = _pose(element, joint, scope, diagnostics)
        found.append(Sensor(element.name, kind, pose, element, joint.child, model.name, joint.name))
    return found


def _pose(element: Element, joint: Joint, scope: Scope, diagnostics: Diagnostics) -> Pose:
    child = element.find("pose")
    if child is None:
        return Pose()
    base = child.attributes.get("relative_to", "")
    if not base or base == joint.name:
        return child.pose()
    if base.split("::")[0] not in (*scope.frames, scope.own):
        diagnostics.warn(child.where, f"sensor pose relative_to='{base}' names no frame; the joint's frame is used")
        return child.pose()
    return scope.pose_of(joint.name, child).inverse() * scope.pose_of(base, child) * child.pose()
