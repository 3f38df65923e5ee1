"""Plain data of a URDF `<robot>`: links and joints as a tree; every number is checked.

Everything that the URDF parser of ROS rejects (a joint without limits, two roots, a cycle) raises an error with file
and line.

Source: http://wiki.ros.org/urdf/XML
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element

JOINT_KINDS = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
WORLD = "world"
_LARGEST = 1e20  # squares and products of larger numbers could overflow

_WORDS: dict[str, frozenset[str]] = {
    parent: frozenset(words.split())
    for parent, words in {
        "robot": "link joint material gazebo transmission ros2_control origin sensor loop_joint",
        "link": "inertial visual collision",
        "inertial": "origin mass inertia",
        "visual": "origin geometry material",
        "collision": "origin geometry verbose",
        "geometry": "box cylinder sphere capsule mesh",
        "joint": "origin parent child axis limit dynamics mimic safety_controller calibration",
        "material": "color texture",
    }.items()
}

MEASURES = {
    "box": ("size",),
    "cylinder": ("radius", "length"),
    "sphere": ("radius",),
    "capsule": ("radius", "length"),
    "mesh": ("filename",),
}
"""The attributes that each shape needs."""


@dataclass(eq=False)
class UrdfInertial:
    """Mass [kg], pose in the frame of the link, and inertia [kg m^2] in that pose (ixx iyy izz ixy ixz iyz)."""

    mass: float
    moments: tuple[float, float, float, float, float, float]
    pose: Pose
    element: Element


@dataclass(eq=False)
class UrdfShape:
    """A `<visual>` or `<collision>`: its `name` (often empty), pose in the frame of the link, and the shape in
    `<geometry>`.

    `colour` (r, g, b, a; each 0..1) is that of the material of a visual, or None.
    """

    name: str
    pose: Pose
    geometry: Element
    element: Element
    colour: tuple[float, float, float, float] | None = None


@dataclass(eq=False)
class UrdfJoint:
    """A joint; `origin` is the pose of joint and child link in the frame of the parent link."""

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    element: Element


@dataclass(eq=False)
class UrdfLink:
    """A link; `joint` connects it to its parent (None for the root), `children` are joints in the order of their
    names.
    """

    name: str
    element: Element
    inertial: UrdfInertial | None = None
    visuals: list[UrdfShape] = field(default_factory=list)
    collisions: list[UrdfShape] = field(default_factory=list)
    joint: UrdfJoint | None = None
    children: list[UrdfJoint] = field(default_factory=list)


@dataclass(eq=False)
class Robot:
    """A robot: `links` and `joints` by name in file order; `root` is the link without a parent."""

    name: str
    element: Element
    root: str = ""
    links: dict[str, UrdfLink] = field(default_factory=dict)
    joints: dict[str, UrdfJoint] = field(default_factory=dict)

    def below(self, name: str) -> Iterator[UrdfLink]:
        """Yield a link and all links below it, parents before children, siblings by the names of their joints."""
        waiting = [name]
        while waiting:
            link = self.links[waiting.pop()]
            yield link
            waiting.extend(joint.child for joint in reversed(link.children))


def read_robot(element: Element, diagnostics: Diagnostics) -> Robot:
    """Read a `<robot>`. Raises SdfError with the line of the fault."""
    if not element.name:
        raise element.error("<robot> needs a name attribute")
    leftover = next((child for child in element.children if child.tag.startswith("xacro:")), None)
    if leftover is not None:
        raise leftover.error(
            f"<{leftover.tag}> is for xacro, which was not run; let the file's name end in .xacro, or run xacro on it"
        )
    _warn_of_unknown(element, diagnostics)
    robot = Robot(element.name, element)
    colours = _colours(element, diagnostics)
    for child in element.all("link"):
        link = _link(child, colours, diagnostics)
        if link.name in robot.links:
            first = robot.links[link.name].element
            raise child.error(f"link '{link.name}' is already there ({first.where}); names of links must differ")
        robot.links[link.name] = link
    if not robot.links:
        raise element.error(f"robot '{robot.name}' has no <link>")
    for child in element.all("joint"):
        joint = _joint(child, robot)
        if joint.name in robot.joints:
            first = robot.joints[joint.name].element
            raise child.error(f"joint '{joint.name}' is already there ({first.where}); names of joints must differ")
        robot.joints[joint.name] = joint
    _make_tree(robot)
    return robot


def numbers(element: Element, attribute: str, count: int, default: tuple[float, ...] | None = None) -> list[float]:
    """Return an attribute as `count` finite floats. Raises SdfError if it is missing and has no `default`."""
    text = element.attributes.get(attribute)
    if text is None:
        if default is not None:
            return list(default)
        raise element.error(f"<{element.tag}> needs the attribute {attribute}")
    try:
        values = [float(word) for word in text.split()]
    except ValueError:
        values = []
    if len(values) != count or not all(map(math.isfinite, values)):
        wanted = "a finite number" if count == 1 else f"{count} finite numbers"
        hint = "; run xacro on the file first" if "${" in text or "$(" in text else ""
        raise element.error(f"{attribute} of <{element.tag}> must be {wanted}, got '{text[:80]}'{hint}")
    if element.tag == "limit":  # the largest number of a double means that there is none
        return [min(max(value, -_LARGEST), _LARGEST) for value in values]
    if any(abs(value) > _LARGEST for value in values):
        raise element.error(
            f"{attribute} of <{element.tag}> must be between {-_LARGEST:g} and {_LARGEST:g}, got '{text[:80]}'"
        )
    return values


def origin_of(element: Element) -> Pose:
    """Return the `<origin xyz rpy>` of an element (xyz [m], rpy [rad] about fixed axes), or the identity."""
    origin = element.find("origin")
    if origin is None:
        return Pose()
    return Pose.from_rpy(numbers(origin, "xyz", 3, (0.0, 0.0, 0.0)), numbers(origin, "rpy", 3, (0.0, 0.0, 0.0)))


def _warn_of_unknown(root: Element, diagnostics: Diagnostics) -> None:
    waiting = [root]
    while waiting:
        element = waiting.pop()
        known = _WORDS.get(element.tag)
        if known is None:
            continue
        for child in element.children:
            if child.tag in known:
                if child.tag != "gazebo":
                    waiting.append(child)
            elif ":" not in child.tag:
                hint = did_you_mean(child.tag, known, listing="elements that can stand there are")
                diagnostics.warn(child.where, f"URDF's <{element.tag}> has no <{child.tag}>, it is ignored{hint}")


Colour = tuple[float, float, float, float]


def _colours(element: Element, diagnostics: Diagnostics) -> dict[str, Colour | None]:
    """Return the colours of the robot's materials by name; None for a material with only a texture."""
    colours: dict[str, Colour | None] = {}
    for material in element.all("material"):
        if not material.name:
            raise material.error("<material> needs a name attribute")
        if material.name in colours:
            diagnostics.warn(material.where, f"material '{material.name}' is already there, the first one is used")
            continue
        colours[material.name] = _colour(material)
    return colours


def _colour(material: Element) -> Colour | None:
    colour = material.find("color")
    if colour is None:
        return None
    red, green, blue, alpha = (min(1.0, max(0.0, value)) for value in numbers(colour, "rgba", 4))
    return red, green, blue, alpha


def _link(element: Element, colours: dict[str, Colour | None], diagnostics: Diagnostics) -> UrdfLink:
    if not element.name:
        raise element.error("<link> needs a name attribute")
    link = UrdfLink(element.name, element)
    inertial = element.find("inertial")
    if inertial is not None:
        link.inertial = _inertial(inertial)
    for child in element.all("visual", "collision"):
        shape = _shape(child, diagnostics)
        if shape is None:
            continue
        if child.tag == "collision":
            link.collisions.append(shape)
        else:
            shape.colour = _visual_colour(child, colours, diagnostics)
            link.visuals.append(shape)
    return link


def _inertial(element: Element) -> UrdfInertial:
    mass, inertia = element.find("mass"), element.find("inertia")
    if mass is None or inertia is None:
        raise element.error(f"<inertial> needs <{'mass' if mass is None else 'inertia'}>")
    ixx, iyy, izz, ixy, ixz, iyz = (numbers(inertia, key, 1)[0] for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    return UrdfInertial(numbers(mass, "value", 1)[0], (ixx, iyy, izz, ixy, ixz, iyz), origin_of(element), element)


def _shape(element: Element, diagnostics: Diagnostics) -> UrdfShape | None:
    holder = element.find("geometry")
    shape = next((child for child in holder.children if child.tag in _WORDS["geometry"]), None) if holder else None
    if shape is None:
        kinds = ", ".join(f"<{kind}>" for kind in sorted(_WORDS["geometry"]))
        diagnostics.warn(element.where, f"<{element.tag}> has no <geometry> with one of {kinds}; it is left out")
        return None
    missing = [word for word in MEASURES[shape.tag] if word not in shape.attributes]
    if missing:
        example = f"<{shape.tag} {missing[0]}='{shape.text[:80] or '...'}'/>"
        diagnostics.warn(
            shape.where,
            f"<{shape.tag}> needs the attribute {missing[0]}, as in {example}; this <{element.tag}> is left out",
        )
        return None
    return UrdfShape(element.name, origin_of(element), shape, element)


def _visual_colour(visual: Element, colours: dict[str, Colour | None], diagnostics: Diagnostics) -> Colour | None:
    """Return the colour of a visual; as in ROS the first definition of a material name applies everywhere."""
    material = visual.find("material")
    if material is None:
        return None
    own = _colour(material)
    if not material.name:
        return own
    if material.name in colours:
        return colours[material.name]
    if own is None and material.find("texture") is None:
        hint = did_you_mean(material.name, colours, listing="materials that are defined before it are")
        diagnostics.warn(material.where, f"material '{material.name}' is not defined, grey is used{hint}")
        return None
    colours[material.name] = own
    return own


def _joint(element: Element, robot: Robot) -> UrdfJoint:
    if not element.name:
        raise element.error("<joint> needs a name attribute")
    kind = element.attributes.get("type", "")
    if kind not in JOINT_KINDS:
        hint = did_you_mean(kind, JOINT_KINDS, listing="types are")
        raise element.error(f"joint '{element.name}' has type '{kind}'{hint}")
    ends = [_end(element, role, robot) for role in ("parent", "child")]
    if ends[0] == ends[1]:
        raise element.error(f"joint '{element.name}' connects link '{ends[0]}' with itself")
    return UrdfJoint(element.name, kind, ends[0], ends[1], origin_of(element), element)


def _end(joint: Element, role: str, robot: Robot) -> str:
    end = joint.find(role)
    name = end.attributes.get("link", "") if end is not None else ""
    if end is None or not name:
        raise (end or joint).error(f"joint '{joint.name}' needs <{role} link='...'/>")
    if name not in robot.links:
        hint = did_you_mean(name, robot.links, listing="its links are")
        raise end.error(f"<{role}> of joint '{joint.name}' names link '{name}', which the robot does not have{hint}")
    return name


def _make_tree(robot: Robot) -> None:
    """Set the parent joint and the child joints of every link. Raises SdfError if the links form no tree."""
    # The parser of ROS sorts joints by name; lumped parts are numbered in this order.
    for joint in sorted(robot.joints.values(), key=lambda each: each.name.encode()):
        child = robot.links[joint.child]
        if child.joint is not None:
            first, second = sorted((child.joint, joint), key=lambda each: each.element.line)
            raise second.element.error(
                f"link '{child.name}' is the child of joint '{second.name}' and of joint '{first.name}' "
                f"({first.element.where}); a link of a URDF has one parent"
            )
        child.joint = joint
        robot.links[joint.parent].children.append(joint)
    roots = [link for link in robot.links.values() if link.joint is None]
    if len(roots) > 1:
        raise roots[1].element.error(
            f"links '{roots[0].name}' and '{roots[1].name}' both have no parent; a URDF has one root, "
            "so one of them needs a joint"
        )
    reached = {link.name for link in robot.below(roots[0].name)} if roots else set()
    for link in robot.links.values():
        if link.name not in reached:
            raise link.element.error(f"these links carry each other in a circle: {_circle(robot, link)}")
    robot.root = roots[0].name


def _circle(robot: Robot, link: UrdfLink) -> str:
    chain: list[str] = []
    name = link.name
    while name not in chain:
        chain.append(name)
        joint = robot.links[name].joint
        assert joint is not None
        name = joint.parent
    return " -> ".join([*chain[chain.index(name) :], name][::-1])
