"""Random URDF robots: trees of links with joints of all types, fixed ones among them, shapes and `<gazebo>` tags."""

from __future__ import annotations

import math

from hypothesis import strategies as st

JOINTS = ("fixed", "fixed", "fixed", "fixed", "continuous", "revolute", "prismatic")

lengths = st.floats(-2.0, 2.0).map(lambda value: round(value, 4))
sizes = st.floats(0.01, 2.0).map(lambda value: round(value, 4))
# Exactly a right angle: a little beside it ROS's own roll, pitch and yaw lose four digits.
angles = st.one_of(
    st.sampled_from([0.0, math.pi / 2, -math.pi / 2, math.pi]),
    st.floats(-4.0, 4.0).map(lambda value: round(value, 4)).filter(lambda value: abs(abs(value) - math.pi / 2) > 0.01),
)
numbers = st.floats(0.0, 5.0).map(lambda value: round(value, 3))
directions = st.tuples(lengths, lengths, lengths).filter(lambda v: math.hypot(*v) > 0.1)


def words(values) -> str:
    return " ".join(repr(value) for value in values)


@st.composite
def origins(draw, tag: str = "origin") -> str:
    if draw(st.integers(0, 3)) == 0:
        return ""
    xyz, rpy = draw(st.tuples(lengths, lengths, lengths)), draw(st.tuples(angles, angles, angles))
    return f'<{tag} xyz="{words(xyz)}" rpy="{words(rpy)}"/>'


@st.composite
def inertials(draw) -> str:
    mass, (x, y, z) = draw(sizes), draw(st.tuples(sizes, sizes, sizes))
    ixx, iyy, izz = (mass / 12.0 * (a * a + b * b) for a, b in ((y, z), (x, z), (x, y)))
    tensor = f'ixx="{ixx!r}" iyy="{iyy!r}" izz="{izz!r}" ixy="0" ixz="0" iyz="0"'
    return f'<inertial>{draw(origins())}<mass value="{mass!r}"/><inertia {tensor}/></inertial>'


@st.composite
def shapes(draw, tag: str, link: str) -> str:
    kind = draw(st.sampled_from(["box", "cylinder", "sphere"]))
    size = {
        "box": f'size="{words(draw(st.tuples(sizes, sizes, sizes)))}"',
        "cylinder": f'radius="{draw(sizes)!r}" length="{draw(sizes)!r}"',
        "sphere": f'radius="{draw(sizes)!r}"',
    }[kind]
    name = draw(st.sampled_from(["", "", f' name="{link}_part"', ' name="odd"']))
    colour = ""
    if tag == "visual" and draw(st.booleans()):
        rgba = draw(st.tuples(*[st.sampled_from([0.0, 0.3, 0.8, 1.0])] * 4))
        colour = f'<material name="m{link}"><color rgba="{words(rgba)}"/></material>'
    return f"<{tag}{name}>{draw(origins())}<geometry><{kind} {size}/></geometry>{colour}</{tag}>"


@st.composite
def joints(draw, name: str, parent: str, child: str) -> str:
    kind = draw(st.sampled_from(JOINTS))
    parts = [f'<parent link="{parent}"/><child link="{child}"/>', draw(origins())]
    if kind != "fixed" and draw(st.booleans()):
        parts.append(f'<axis xyz="{words(draw(directions))}"/>')
    if kind in ("revolute", "prismatic"):
        lower, upper = draw(lengths), draw(lengths)
        limits = f'lower="{lower!r}" upper="{upper!r}" effort="{draw(numbers)!r}" velocity="{draw(numbers)!r}"'
        parts.append(f"<limit {limits}/>")
    if kind != "fixed" and draw(st.booleans()):
        parts.append(f'<dynamics damping="{draw(numbers)!r}" friction="{draw(numbers)!r}"/>')
    return f'<joint name="{name}" type="{kind}">{"".join(parts)}</joint>'


@st.composite
def gazebo_tags(draw, link: str, joint: str) -> str:
    text = ""
    if draw(st.booleans()):
        inside = draw(
            st.sampled_from(
                [
                    "<mu1>0.25</mu1><mu2>0.5</mu2>",
                    "<mu1 value='0.75'/><kp>100000.0</kp><minDepth>0.001</minDepth>",
                    "<material>Gazebo/Blue</material>",
                    "<turnGravityOff>true</turnGravityOff>",
                    "<selfCollide>true</selfCollide>",
                ]
            )
        )
        text += f'<gazebo reference="{link}">{inside}</gazebo>'
    if draw(st.booleans()):
        pose = f"<pose>{words(draw(st.tuples(lengths, lengths, lengths, angles, angles, angles)))}</pose>"
        pose = draw(st.sampled_from(["", pose]))
        text += f'<gazebo reference="{link}"><sensor name="s_{link}" type="imu">{pose}</sensor></gazebo>'
    word = draw(st.sampled_from(["", "", "preserveFixedJoint", "disableFixedJointLumping", "springStiffness"]))
    if joint and word:
        value = "7.5" if word == "springStiffness" else "true"
        text += f'<gazebo reference="{joint}"><{word}>{value}</{word}></gazebo>'
    return text


@st.composite
def robots(draw) -> str:
    """A whole `<robot>` of 1 to 7 links; names of joints are not in the order of the links."""
    count = draw(st.sampled_from([1, 2, 3, 4, 5, 6, 7, 5, 6, 7]))
    first = draw(st.sampled_from(["base", "base", "world"])) if count > 1 else "base"
    names = [first, *(f"link_{i}" for i in range(1, count))]
    order = draw(st.permutations(range(count)))
    parts = []
    for i, name in enumerate(names):
        if name == "world":
            parts.append('<link name="world"/>')
        else:
            inside = [draw(inertials())]
            inside += [draw(shapes("visual", name)) for _ in range(draw(st.integers(0, 2)))]
            inside += [draw(shapes("collision", name)) for _ in range(draw(st.integers(0, 2)))]
            parts.append(f'<link name="{name}">{"".join(inside)}</link>')
        joint = ""
        if i:
            joint = f"joint_{order[i]}"
            parts.append(draw(joints(joint, names[draw(st.one_of(st.just(i - 1), st.integers(0, i - 1)))], name)))
        if name != "world":
            parts.append(draw(gazebo_tags(name, joint)))
    return f'<robot name="robot">{draw(origins())}{"".join(draw(st.permutations(parts)))}</robot>'
