"""What is wrong with a robot as it was created: its description, its masses, its place, parts in each other."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.record.reading import Recording
from gz_course.grader.score.robots import LUMPED, Robot
from gz_course.grader.score.steps import told

REQUESTED = re.compile(r"^\[create-\d+\] .*Requesting creation of an entity")
PARTS = re.compile(r"Robot initialized: '.*', (\d+) joints move, (\d+) are fixed")
MANY = 1000  # joints: more than Gazebo simulates in any useful time
MEANINGS = (
    (
        re.compile(r"robot_description must be a text, not (-?\d+)"),
        "robot_description is the number {0}, such as os.system and subprocess.call return: the exit code of xacro, "
        "not what it prints; Command(['xacro ', path]) gives the text",
    ),
    (
        re.compile(r"<xacro:\w+> is for xacro, which was not run"),
        "robot_description is the text of the xacro file itself: xacro was not run over it; Command(['xacro ', path]) "
        "gives what xacro makes of it",
    ),
    (
        re.compile(r"syntax error: line 1, column 0"),
        "robot_description is no XML: perhaps the path of the file instead of its text; Command(['xacro ', path]) "
        "gives the text",
    ),
)
HEAVIEST = 300.0  # [kg] of a link: a robot of that size made of steel is lighter
THIN = 80.0  # [kg/m^3] of a body as its largest box has it: a robot full of air, as of cardboard, has more
LIGHTEST = 1e-3  # [kg] of a link that can collide
PAIR = re.compile(r"'([^']+)' and '([^']+)' are ([\d.]+) m inside each other")
NEAR = 0.02  # [m] and [rad] between equal values: a robot settles a little where it comes
EXACT = 0.001  # [rad]: a heading in degrees that is taken for radians is small
ALIKE = 0.05  # wanted values that are closer to each other cannot be told apart


@guarded("")
def at_work_on(recording: Recording) -> str:
    """Return how large the robot is that create was asked for; empty if it was not asked, or it is not large."""
    lines = [line.text for line in recording.lines("log/student")]
    if not any(REQUESTED.match(line) for line in lines):
        return ""
    joints = next((sum(map(int, found.groups())) for line in lines if (found := PARTS.search(line))), 0)
    return f"the robot has {joints} joints, far too many to be simulated" if joints > MANY else ""


@guarded("")
def description_meaning(said: str) -> str:
    """Return what to change, given what robot_state_publisher said; empty if that is unknown."""
    for pattern, words in MEANINGS:
        if match := pattern.search(said):
            return words.format(*match.groups())
    return ""


@guarded("")
def odd_mass(robot: Robot) -> str:
    """Return the link whose mass is implausible; empty if there is none."""
    heavy = max(robot.links, key=lambda link: link.mass)
    if heavy.mass > HEAVIEST:
        grams = " (masses are in kg, not in g)" if heavy.mass < 1e6 else ""
        return f"link {heavy.name} has a mass of {heavy.mass:g} kg{grams}"
    light = min((link for link in robot.links if link.shapes), key=lambda link: link.mass, default=None)
    if light is not None and light.mass < LIGHTEST:
        return f"link {light.name} has a mass of {light.mass:g} kg"
    return ""


@guarded("")
def too_light(robot: Robot) -> str:
    """Return the link whose mass is too small for the size of its largest box; empty if there is none."""
    for link in robot.links:
        boxes = [shape for shape in link.shapes if shape.kind == "box"]
        size = max((tuple(map(float, box.size)) for box in boxes), key=math.prod, default=None)
        if size is not None and link.mass < THIN * math.prod(size):
            return (
                f"link {link.name} has a mass of {link.mass:g} kg, too little for a body of "
                f"{' x '.join(f'{each:g}' for each in size)} m: a link that is part of it has no <inertial>, or "
                "too small a mass"
            )
    return ""


@guarded("")
def overlap(warnings: Iterable[str], robot: str) -> str:
    """Return which two parts of the robot overlap, and by how much; empty if none do."""
    for found in filter(None, map(PAIR.search, warnings)):
        one, other = (name.split("::") for name in found.groups()[:2])
        if one[0] == other[0] == robot:
            parts = f"{_part(one)} and {_part(other)}"
            return f"{parts} are {found[3]} m inside each other, and push each other away"
    return ""


def _part(scoped: list[str]) -> str:
    lumped = LUMPED.search(scoped[-1])
    return lumped[1] if lumped else scoped[1]


@guarded("")
def misplaced(
    wanted: Mapping[str, float], place: Mapping[str, float], wrong: list[str], names: Mapping[str, str]
) -> str:
    """Return which misconception puts a robot at `place`; empty if none does.

    The keys are x, y and yaw ([m], [rad]), `wrong` are those at fault, `names` those of the launch arguments.
    """
    if {"x", "y"} <= set(wrong) and all(abs(place[a] - wanted[b]) < NEAR for a, b in (("x", "y"), ("y", "x"))):
        return f"the arguments {names['x']} and {names['y']} are exchanged"
    found = [_one(axis, wanted, place[axis], names) for axis in wrong]
    return "; ".join(found) if all(found) else ""


def _one(axis: str, wanted: Mapping[str, float], value: float, names: Mapping[str, str]) -> str:
    right = wanted[axis]
    if abs(right) < ALIKE:
        other = next((each for each in wanted if each != axis and _same(axis, value, wanted[each])), "")
        return f"the value of {names[other]} was taken for {names[axis]}" if other else ""
    if axis == "yaw" and abs(value - math.radians(right)) < EXACT < abs(value):
        return f"{names[axis]} was converted from degrees to radians, but it is in radians ({told(right)})"
    if abs(value) < NEAR:
        return f"the argument {names[axis]} had no effect"
    if _same(axis, value, -right):
        return f"{names[axis]} has the wrong sign"
    if axis == "yaw" and _same(axis, value, math.degrees(right)):
        return f"{names[axis]} was converted from radians to degrees, but -Y of create is in radians"
    for each in wanted:
        if each != axis and abs(wanted[each]) > ALIKE and _same(axis, value, wanted[each]):
            return f"the value of {names[each]} was taken for {names[axis]}"
    return ""


def _same(axis: str, one: float, other: float) -> bool:
    off = one - other
    return abs(math.remainder(off, math.tau) if axis == "yaw" else off) < NEAR
