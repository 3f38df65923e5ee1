"""`<gazebo>` tags of a URDF, which add to the SDF of the robot, of a link or of a joint.

Words older than SDF (`mu1`, `turnGravityOff`, `springStiffness`) are translated; every other element is already SDF and
is copied unchanged (sensors, plugins, `<gravity>`, ...).

Source: https://classic.gazebosim.org/tutorials?tut=ros_urdf
Source: sdformat 14, `InsertSDFExtension*`, https://github.com/gazebosim/sdformat/blob/sdf14/src/parser_urdf.cc
"""

from __future__ import annotations

from dataclasses import dataclass, field

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.urdf.making import make, place, set_value
from gz_course.sim.gz.sim.sdf.urdf.robot import Robot

LUMP = "_fixed_joint_lump__"
"""The text in the name of a lumped shape between the name of the body and its own name."""

_TRUE = ("true", "yes", "1")
_COLLISION = {
    "kp": "surface/contact/ode/kp",
    "kd": "surface/contact/ode/kd",
    "maxVel": "surface/contact/ode/max_vel",
    "minDepth": "surface/contact/ode/min_depth",
    "mu1": "surface/friction/ode/mu",
    "mu2": "surface/friction/ode/mu2",
    "fdir1": "surface/friction/ode/fdir1",
    "laserRetro": "laser_retro",
    "maxContacts": "max_contacts",
}
"""The path in `<collision>` that the value of each word is written to."""
_JOINT = {
    "springReference": "axis/dynamics/spring_reference",
    "springStiffness": "axis/dynamics/spring_stiffness",
    "stopCfm": "physics/ode/limit/cfm",
    "stopErp": "physics/ode/limit/erp",
    "fudgeFactor": "physics/ode/fudge_factor",
}
_JOINT_FLAGS = {
    "provideFeedback": "physics/ode/provide_feedback",
    "implicitSpringDamper": "physics/ode/implicit_spring_damper",
    "cfmDamping": "physics/ode/implicit_spring_damper",
}
_PRESERVING = ("preserveFixedJoint", "disableFixedJointLumping")
_TRANSLATED = {
    *_COLLISION, *_JOINT, *_JOINT_FLAGS, *_PRESERVING,
    "material", "collision", "visual", "static", "turnGravityOff", "dampingFactor", "selfCollide", "canonicalBody",
}  # fmt: skip
_PLACED = ("sensor", "light", "projector")


@dataclass(eq=False)
class GazeboTag:
    """One `<gazebo>`; `reference` names its link or joint and is empty for the robot."""

    reference: str
    element: Element

    @property
    def sdf_children(self) -> list[Element]:
        """Return the children that are SDF elements and need no translation."""
        return [child for child in self.element.children if child.tag not in _TRANSLATED]


@dataclass(eq=False)
class GazeboTags:
    """The `<gazebo>` tags of a robot by reference."""

    by_reference: dict[str, list[GazeboTag]] = field(default_factory=dict)

    def of(self, reference: str) -> list[GazeboTag]:
        """Return the tags of a link or joint (empty text: of the robot), in file order."""
        return self.by_reference.get(reference, [])

    def references_with(self, *words: str) -> set[str]:
        """Return the references whose tags set one of the elements `words` to true."""
        return {
            tag.reference
            for tags in self.by_reference.values()
            for tag in tags
            for child in tag.element.all(*words)
            if _yes(child)
        }

    def preserved(self) -> set[str]:
        """Return the names of the fixed joints to preserve."""
        return self.references_with(*_PRESERVING)


def read_gazebo_tags(robot: Robot, diagnostics: Diagnostics) -> GazeboTags:
    """Return the tags of a robot; warn about unknown references, which Gazebo ignores silently."""
    tags = GazeboTags()
    for element in robot.element.all("gazebo"):
        reference = element.attributes.get("reference", "")
        if reference and reference not in robot.links and reference not in robot.joints:
            hint = did_you_mean(reference, [*robot.links, *robot.joints], listing="its links and joints are")
            diagnostics.warn(
                element.where,
                f"<gazebo reference='{reference}'> names no link or joint of the robot, so it does nothing{hint}",
            )
        if reference:
            for plugin in element.all("plugin"):
                diagnostics.warn(
                    plugin.where,
                    f"a <plugin> in <gazebo reference='{reference}'> is not run; plugins of a robot stand in a "
                    "<gazebo> without reference, those of a sensor in the <sensor>",
                )
        tags.by_reference.setdefault(reference, []).append(GazeboTag(reference, element))
    return tags


def value_of(element: Element) -> str:
    """Return the value of a tag: its attribute `value`, else its text."""
    return element.attributes.get("value", element.text).strip()


def _yes(element: Element) -> bool:
    return value_of(element).lower() in _TRUE


def add_to_model(model: Element, tags: GazeboTags, lumped: dict[str, str]) -> None:
    """Add the tags without reference to `<model>`: plugins, `static`, and joints, with lumped links renamed."""
    for tag in tags.of(""):
        for child in tag.element.all("static"):
            set_value(model, "static", "true" if _yes(child) else "false", child)
        for child in tag.sdf_children:
            if child.tag == "joint":
                ends = ("parent", "child")
                renamed = [
                    make(each, each.tag, lumped[value_of(each)])
                    if each.tag in ends and value_of(each) in lumped
                    else each
                    for each in child.children
                ]
                child = make(child, "joint", "", child.attributes, renamed)
            model.children.append(child)


def add_to_link(link: Element, tags: GazeboTags, reference: str, pose: Pose | None) -> None:
    """Add the tags of a URDF link to the SDF `<link>`; `pose` is that of a lumped link in it, else None."""
    for tag in tags.of(reference):
        for child in tag.element.all("turnGravityOff"):
            off = value_of(child).lower() not in ("false", "no", "0")
            set_value(link, "gravity", "false" if off else "true", child)
        for child in tag.element.all("selfCollide"):
            set_value(link, "self_collide", "true" if _yes(child) else "false", child)
        for child in tag.element.all("dampingFactor"):
            parts = [make(child, word, value_of(child)) for word in ("linear", "angular")]
            link.children.append(make(child, "velocity_decay", children=parts))
        for child in tag.sdf_children:
            link.children.append(_moved(child, pose) if pose is not None and child.tag in _PLACED else child)


def _moved(element: Element, pose: Pose) -> Element:
    """Return a sensor or light of a lumped link with its pose in the frame of the body."""
    stated = element.find("pose")
    if stated is not None and stated.attributes.get("relative_to", ""):
        return element
    own = stated.pose() if stated is not None else Pose()
    children = [child for child in element.children if child.tag != "pose"]
    return make(
        element, element.tag, element.text, element.attributes, [*children, place(stated or element, pose * own)]
    )


def add_to_collision(
    collision: Element, tags: GazeboTags, reference: str, lumped: bool, diagnostics: Diagnostics
) -> None:
    """Add the tags of a URDF link to one of its `<collision>` elements: surface, contacts, blocks."""
    for tag in tags.of(reference):
        blocks = [child for block in tag.element.all("collision") for child in block.children]
        words = [child for child in tag.element.children if child.tag in _COLLISION]
        if not blocks and not words:
            continue
        if not _reaches(collision, reference, lumped, "collision"):
            _warn_of_name(collision, reference, (*blocks, *words)[0], diagnostics)
            continue
        for block in blocks:
            if block.tag == "surface":
                collision.children = [child for child in collision.children if child.tag != "surface"]
            collision.children.append(_copy(block))
        for word in words:
            set_value(collision, _COLLISION[word.tag], value_of(word), word)


def add_to_visual(visual: Element, tags: GazeboTags, reference: str, lumped: bool, diagnostics: Diagnostics) -> None:
    """Add the tags of a URDF link to one of its `<visual>` elements: material, `<visual>` blocks."""
    for tag in tags.of(reference):
        blocks = [child for block in tag.element.all("visual") for child in block.children]
        materials = list(tag.element.all("material"))
        if not blocks and not materials:
            continue
        if not _reaches(visual, reference, lumped, "visual"):
            _warn_of_name(visual, reference, (*blocks, *materials)[0], diagnostics)
            continue
        for block in blocks:
            if block.tag == "material":
                visual.children = [child for child in visual.children if child.tag != "material"]
            visual.children.append(_copy(block))
        for material in materials:
            if material.children:
                diagnostics.warn(
                    material.where,
                    f"<material> of <gazebo reference='{reference}'> takes a name such as Gazebo/Blue; put "
                    "<ambient> and <diffuse> into <visual><material> there",
                )
            elif value_of(material):
                set_value(visual, "material/script/name", value_of(material), material)
                set_value(visual, "material/script/uri", "file://media/materials/scripts/gazebo.material", material)


def _reaches(shape: Element, reference: str, lumped: bool, kind: str) -> bool:
    """Return whether Gazebo applies the tags of a link to this shape, which depends on the name of the shape."""
    if lumped:
        return f"{LUMP}{reference}_{kind}" in shape.name
    return LUMP not in shape.name


def _warn_of_name(shape: Element, reference: str, word: Element, diagnostics: Diagnostics) -> None:
    diagnostics.warn(
        shape.where,
        f"<{word.tag}> of <gazebo reference='{reference}'> does not reach this <{shape.tag}>: Gazebo finds it by its "
        f"name; leave its name out or let it begin with '{reference}'",
    )


def add_to_joint(joint: Element, tags: GazeboTags, reference: str) -> None:
    """Add the tags of a joint to the SDF `<joint>`: springs, stops, sensors and other SDF elements."""
    for tag in tags.of(reference):
        for child in tag.element.children:
            if child.tag in _JOINT:
                set_value(joint, _JOINT[child.tag], value_of(child), child)
            elif child.tag in _JOINT_FLAGS:
                set_value(joint, _JOINT_FLAGS[child.tag], "true" if _yes(child) else "false", child)
        joint.children.extend(tag.sdf_children)


def _copy(element: Element) -> Element:
    return make(element, element.tag, element.text, element.attributes, [_copy(child) for child in element.children])
