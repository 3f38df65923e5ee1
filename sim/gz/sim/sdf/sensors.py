"""Reads `<sensor>` of a link or, for force-torque sensors, of a joint; the sensor itself reads its own parameters.

Source: SDFormat, element `<sensor>`, http://sdformat.org/spec
"""

from __future__ import annotations

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.description import Joint, Model, Sensor
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.frames import Scope


def part_pose(element: Element, holder: str, scope: Scope) -> Pose:
    """Return the pose of an element in the frame of `holder`, the link or joint it belongs to."""
    child = element.find("pose")
    if child is None:
        return Pose()
    base = child.attributes.get("relative_to", "") or child.attributes.get("frame", "")
    if not base or base == holder:
        return child.pose()
    return scope.pose_of(holder, child).inverse() * scope.pose_of(base, child) * child.pose()


def read_sensor(
    element: Element, link: str, model: Model, scope: Scope, diagnostics: Diagnostics, joint: str = ""
) -> Sensor:
    """Return a sensor of `link`, or of `joint`, whose child is `link`. Raises SdfError if it has no type."""
    kind = element.attributes.get("type", "")
    if not kind:
        example = "force_torque" if joint else "gpu_lidar"
        raise element.error(f"<sensor> '{element.name}' needs a type attribute, for example type='{example}'")
    child = element.find("pose")
    base = child.attributes.get("relative_to", "") if child is not None else ""
    if child is not None and base and base.split("::")[0] not in (*scope.frames, scope.own):
        # As in gz-sensors an unknown frame is ignored, so that the world still runs.
        frame = "joint's" if joint else "link's"
        diagnostics.warn(child.where, f"sensor pose relative_to='{base}' names no frame; the {frame} frame is used")
        pose = child.pose()
    else:
        pose = part_pose(element, joint or link, scope)
    return Sensor(element.name, kind, pose, element, link, model.name, joint)


def read_joint_sensors(joint: Joint, scope: Scope, model: Model, diagnostics: Diagnostics) -> list[Sensor]:
    """Return the sensors of a joint. Raises SdfError for a missing name or type and for a duplicate name."""
    found: list[Sensor] = []
    for element in joint.element.all("sensor"):
        if not element.name:
            raise element.error("<sensor> needs a name attribute")
        if any(other.name == element.name for other in found):
            raise element.error(f"joint '{joint.name}' already has a <sensor> called '{element.name}'")
        found.append(read_sensor(element, joint.child, model, scope, diagnostics, joint.name))
    return found
