"""Converts a URDF `<robot>` to the SDF `<model>` that Gazebo makes of it.

The result is an `Element` tree for the SDF reader; every element has the file and line of its URDF. Names are those of
Gazebo: an unnamed collision of link `wheel` is `wheel_collision`, lumped into `base` it is
`base_fixed_joint_lump__wheel_collision_1`.

Source: sdformat 14, https://github.com/gazebosim/sdformat/blob/sdf14/src/parser_urdf.cc
"""

from __future__ import annotations

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.element import Element
from gz_course.sim.gz.sim.sdf.urdf.gazebo_tags import (
    LUMP,
    GazeboTags,
    add_to_collision,
    add_to_joint,
    add_to_link,
    add_to_model,
    add_to_visual,
    read_gazebo_tags,
)
from gz_course.sim.gz.sim.sdf.urdf.lumping import Body, lump
from gz_course.sim.gz.sim.sdf.urdf.making import make, place, set_value, write
from gz_course.sim.gz.sim.sdf.urdf.robot import (
    MEASURES,
    WORLD,
    Robot,
    UrdfJoint,
    UrdfShape,
    numbers,
    origin_of,
    read_robot,
)

SDF_VERSION = "1.11"
_BALL = 0.01  # [m]


def sdf_of_robot(element: Element, diagnostics: Diagnostics) -> Element:
    """Return `<sdf><model>` for a `<robot>`. Raises SdfError with file and line if it is no valid URDF."""
    robot = read_robot(element, diagnostics)
    tags = read_gazebo_tags(robot, diagnostics)
    bodies = lump(robot, tags.preserved())
    kept = _with_mass(robot, bodies, diagnostics)
    _warn_of_ros2_control(robot, diagnostics)
    model = make(element, "model", attributes={"name": robot.name})
    if element.find("origin") is not None:
        model.children.append(place(element, origin_of(element)))
    hinges = tags.references_with("disableFixedJointLumping") - tags.references_with("preserveFixedJoint")
    for body in kept:
        link = _link(body, tags, diagnostics)
        if body.joint is not None:
            _add_joint(model, body, body.joint, robot, tags, body.joint.name in hinges, diagnostics)
            link.children.insert(0, make(body.head.element, "pose", attributes={"relative_to": body.joint.name}))
        model.children.append(link)
        _add_frames(model, body, robot, tags, diagnostics)
    lumped = {link.name: body.name for body in kept for link, _ in body.members[1:]}
    add_to_model(model, tags, lumped)
    return make(element, "sdf", attributes={"version": SDF_VERSION}, children=[model])


def _with_mass(robot: Robot, bodies: list[Body], diagnostics: Diagnostics) -> list[Body]:
    """Return the bodies that Gazebo keeps, which are those with mass whose parents are kept."""
    gone: dict[str, str] = {}
    kept: list[Body] = []
    for body in bodies:
        if body.parent in gone:
            gone[body.name] = gone[body.parent]
        elif body.inertial is None or body.inertial.mass <= 0.0:
            gone[body.name] = body.name
        else:
            kept.append(body)
    for culprit in dict.fromkeys(gone.values()):
        members = next(body.members for body in bodies if body.name == culprit)
        massless = [each for each, _ in members if each.inertial is not None and each.inertial.mass <= 0.0]
        link = massless[0] if massless else robot.links[culprit]
        has = "no <inertial>" if link.inertial is None else f"no mass ({link.inertial.mass:g} kg)"
        others = [name for name, reason in gone.items() if reason == culprit and name != culprit]
        below = f", with everything it carries ({', '.join(others)})" if others else ""
        sentence = f"link '{link.name}' has {has}, so Gazebo leaves it out{below}; give it an <inertial> with a mass"
        if (
            link.name == culprit
            and link.joint is not None
            and link.joint.kind == "fixed"
            and link.joint.parent != WORLD
        ):
            sentence += f", or let joint '{link.joint.name}' be lumped"
        if not kept:
            raise SdfError(f"{link.element.where}: {sentence}: nothing is left of robot '{robot.name}'")
        diagnostics.warn(link.element.where, sentence)
    if not kept:
        raise robot.element.error(f"robot '{robot.name}' has no link but '{WORLD}'")
    return kept


def _warn_of_ros2_control(robot: Robot, diagnostics: Diagnostics) -> None:
    found = list(robot.element.all("ros2_control", "transmission"))
    if found:
        kinds = " and ".join(f"<{tag}>" for tag in dict.fromkeys(each.tag for each in found))
        diagnostics.warn(
            found[0].where,
            f"{kinds} of robot '{robot.name}' describes hardware for ros2_control, which is not run here; joints are "
            "driven by plugins such as gz::sim::systems::JointPositionController or DiffDrive",
        )


def _link(body: Body, tags: GazeboTags, diagnostics: Diagnostics) -> Element:
    inertial = body.inertial
    assert inertial is not None
    element = make(body.head.element, "link", attributes={"name": body.name})
    source = inertial.element
    if not any(inertial.moments):
        diagnostics.warn(
            source.where,
            f"link '{body.name}' has a mass but no moment of inertia; that of a ball of 1 cm radius is used",
        )
        ball = 0.4 * inertial.mass * _BALL**2
        inertial.moments = (ball, ball, ball, 0.0, 0.0, 0.0)
    ixx, iyy, izz, ixy, ixz, iyz = inertial.moments
    tensor = {"ixx": ixx, "ixy": ixy, "ixz": ixz, "iyy": iyy, "iyz": iyz, "izz": izz}
    moments = [make(source, word, write([value])) for word, value in tensor.items()]
    parts = [
        place(source, inertial.pose),
        make(source, "mass", write([inertial.mass])),
        make(source.find("inertia") or source, "inertia", children=moments),
    ]
    element.children.append(make(source, "inertial", children=parts))
    number = 0
    for link, pose in body.members:
        for shape in link.collisions:
            name = _shape_name(body.name, shape.name or link.name, "collision", number)
            made = _shape(shape, name, pose)
            add_to_collision(made, tags, link.name, link is not body.head, diagnostics)
            element.children.append(made)
            number += 1
    number = 0
    for link, pose in body.members:
        for shape in link.visuals:
            name = _shape_name(body.name, shape.name or link.name, "visual", number)
            made = _shape(shape, name, pose)
            add_to_visual(made, tags, link.name, link is not body.head, diagnostics)
            _colour(made, shape)
            element.children.append(made)
            number += 1
    for link, pose in body.members:
        add_to_link(element, tags, link.name, None if link is body.head else pose)
    return element


def _shape_name(body: str, own: str, kind: str, number: int) -> str:
    name = f"{own}_{kind}" + (f"_{number}" if number else "")
    return name if name.startswith(body) else f"{body}{LUMP}{name}"


def _shape(shape: UrdfShape, name: str, pose: Pose) -> Element:
    geometry = shape.geometry
    kind = geometry.tag
    parts: list[Element]
    if kind == "box":
        parts = [make(geometry, "size", write(numbers(geometry, "size", 3)))]
    elif kind == "mesh":
        filename = geometry.attributes.get("filename", "")
        if not filename:
            raise geometry.error("<mesh> needs a filename")
        scale = numbers(geometry, "scale", 3, (1.0, 1.0, 1.0))
        parts = [make(geometry, "uri", filename), make(geometry, "scale", write(scale))]
    else:
        parts = [make(geometry, word, write(numbers(geometry, word, 1))) for word in MEASURES[kind]]
    children = [
        place(shape.element, pose * shape.pose),
        make(geometry, "geometry", children=[make(geometry, kind, children=parts)]),
    ]
    return make(shape.element, shape.element.tag, attributes={"name": name}, children=children)


def _colour(visual: Element, shape: UrdfShape) -> None:
    """Give a visual the colour of its URDF material, unless a `<gazebo>` tag gave it one.

    As in Gazebo the colour is brightened: the value 0.8 of a URDF is full intensity.
    """
    if shape.colour is None:
        return
    material = visual.find("material")
    if material is not None and (material.find("diffuse") or material.find("ambient")):
        return
    *rgb, alpha = shape.colour
    source = shape.element.find("material") or shape.element
    text = write([*(min(1.0, value / 0.8) for value in rgb), alpha])
    set_value(visual, "material/diffuse", text, source)
    set_value(visual, "material/ambient", text, source)


def _add_joint(
    model: Element,
    body: Body,
    joint: UrdfJoint,
    robot: Robot,
    tags: GazeboTags,
    hinge: bool,
    diagnostics: Diagnostics,
) -> None:
    source = joint.element
    base = "__model__" if body.parent == WORLD else body.parent
    if joint.kind in ("floating", "planar"):
        loose = "moves freely" if joint.kind == "floating" else "is not held in a plane here, it moves freely"
        diagnostics.warn(source.where, f"joint '{joint.name}' is {joint.kind}: link '{body.name}' {loose}")
        model.children.append(
            make(source, "frame", attributes={"name": joint.name}, children=[place(source, body.origin, base)])
        )
        return
    hinge = hinge and joint.kind == "fixed"
    kind = "revolute" if hinge or joint.kind == "continuous" else joint.kind
    made = make(source, "joint", attributes={"name": joint.name, "type": kind})
    made.children.append(place(source.find("origin") or source, body.origin, base))
    made.children.append(make(source.find("parent") or source, "parent", body.parent))
    made.children.append(make(source.find("child") or source, "child", body.name))
    if hinge:
        set_value(made, "axis/limit/lower", "0", source)
        set_value(made, "axis/limit/upper", "0", source)
    elif kind != "fixed":
        made.children.append(_axis(joint, robot, diagnostics))
    add_to_joint(made, tags, joint.name)
    model.children.append(made)


def _axis(joint: UrdfJoint, robot: Robot, diagnostics: Diagnostics) -> Element:
    source = joint.element
    stated = source.find("axis")
    xyz = numbers(stated, "xyz", 3) if stated is not None else [1.0, 0.0, 0.0]
    axis = make(stated or source, "axis", children=[make(stated or source, "xyz", write(xyz))])
    limit = source.find("limit")
    if limit is not None:
        effort, velocity = numbers(limit, "effort", 1)[0], numbers(limit, "velocity", 1)[0]
        if joint.kind != "continuous":
            lower, upper = numbers(limit, "lower", 1, (0.0,))[0], numbers(limit, "upper", 1, (0.0,))[0]
            if "lower" not in limit.attributes and "upper" not in limit.attributes:
                diagnostics.warn(
                    limit.where,
                    f"<limit> of joint '{joint.name}' has no lower and upper, which means 0 and 0: it cannot move; a "
                    "wheel is a joint of type continuous",
                )
            if lower > upper:
                diagnostics.warn(
                    limit.where, f"joint '{joint.name}' has lower {lower:g} above upper {upper:g}; they are swapped"
                )
                lower, upper = upper, lower
            set_value(axis, "limit/lower", write([lower]), limit)
            set_value(axis, "limit/upper", write([upper]), limit)
        set_value(axis, "limit/effort", write([effort]), limit)
        set_value(axis, "limit/velocity", write([velocity]), limit)
    elif joint.kind in ("revolute", "prismatic"):
        raise source.error(
            f"joint '{joint.name}' is {joint.kind} and needs <limit lower upper effort velocity>; without limits it is "
            "of type continuous"
        )
    dynamics = source.find("dynamics")
    if dynamics is not None:
        for word in ("damping", "friction"):
            set_value(axis, f"dynamics/{word}", write(numbers(dynamics, word, 1, (0.0,))), dynamics)
    mimic = source.find("mimic")
    if mimic is not None:
        leader = mimic.attributes.get("joint", "")
        if leader not in robot.joints:
            raise mimic.error(f"<mimic> of joint '{joint.name}' names joint '{leader}', which the robot does not have")
        parts = [
            make(mimic, word, write(numbers(mimic, word, 1, (default,))))
            for word, default in (("multiplier", 1.0), ("offset", 0.0))
        ]
        axis.children.append(make(mimic, "mimic", attributes={"joint": leader}, children=parts))
    return axis


def _add_frames(model: Element, body: Body, robot: Robot, tags: GazeboTags, diagnostics: Diagnostics) -> None:
    """Keep the names of lumped links and their joints as frames; warn if a tag of such a joint is lost."""
    for link, pose in body.members[1:]:
        joint = link.joint
        assert joint is not None
        frame = {"name": joint.name, "attached_to": body.name}
        model.children.append(make(joint.element, "frame", attributes=frame, children=[place(joint.element, pose)]))
        if link.name != joint.name:
            model.children.append(
                make(link.element, "frame", attributes={"name": link.name, "attached_to": joint.name})
            )
        for tag in tags.of(joint.name) if joint.name not in robot.links else ():
            if tag.sdf_children:
                diagnostics.warn(
                    tag.element.where,
                    f"joint '{joint.name}' is fixed and lumped, so <{tag.sdf_children[0].tag}> of "
                    f"<gazebo reference='{joint.name}'> is lost; add <preserveFixedJoint>true</preserveFixedJoint>",
                )
