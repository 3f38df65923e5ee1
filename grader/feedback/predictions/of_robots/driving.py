"""Why a robot with a DiffDrive moves in another way than it is commanded, as its wheels, joints and plugin tell."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gz_course.grader.feedback.predictions.of_robots.creating import odd_mass
from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.robots import Joint, Link, Plugin, Robot, Shape
from gz_course.grader.score.steps import told

OFF = 0.1  # [rad] between two directions, above which they are not the same
SAME = 0.03  # of a length: two that differ by less are the same one
HANGS = 0.003  # [m] above the ground from which a wheel hangs in the air
SLIPPERY = 0.2  # friction of a wheel
GRIPS = 0.1  # friction of what slides along the ground
DAMPS = 0.05  # [N m s/rad] of a joint: enough to be noticed with a small wheel
FAR = 60.0  # [rad] between the limits of a joint: a small wheel drives a few metres with it
SECONDS = 1.0  # [s] in which a robot should have the speed that it is commanded


@dataclass(frozen=True)
class Wheel:
    """A wheel that DiffDrive turns; `shape` is the collision that rolls, None if the link has none."""

    side: str
    joint: Joint
    link: Link
    shape: Shape | None

    @property
    def radius(self) -> float:
        """Of its cylinder or sphere [m]; 0 if it is another shape."""
        return float(self.shape.size[0]) / 2 if self.shape is not None and self.shape.kind in ROUND else 0.0


ROUND = ("cylinder", "sphere", "capsule")


def plugin_of(robot: Robot) -> Plugin | None:
    """Return the plugin DiffDrive; None if there is none, or more than one."""
    found = robot.systems("DiffDrive")
    return found[0] if len(found) == 1 else None


def wheels_of(robot: Robot) -> list[Wheel]:
    """Return the wheels of DiffDrive, those on its left side first."""
    plugin = plugin_of(robot)
    found = []
    for side in ("left", "right"):
        for name in plugin.all(f"{side}_joint") if plugin is not None else ():
            joint = robot.joint(name)
            link = robot.link(joint.child) if joint is not None else None
            if joint is not None and link is not None:
                shapes = sorted(link.shapes, key=lambda shape: float(shape.corners()[:, 2].min()))
                found.append(Wheel(side, joint, link, shapes[0] if shapes else None))
    return found


@guarded("")
def does_not_drive(robot: Robot) -> str:
    """Return why the robot cannot roll ahead at all."""
    looks = (
        no_plugin,
        one_joint_twice,
        limited_joint,
        wrong_axis,
        lies_flat,
        without_collision,
        hangs,
        of_one_side,
        odd_mass,
    )
    return next(filter(None, (look(robot) for look in looks)), "")


@guarded("")
def other_speed(robot: Robot, wanted: float, ratio: float) -> str:
    """Return why a robot is `ratio` times as fast as the `wanted` forward speed [m/s]."""
    looks = (
        one_joint_twice,
        limited_joint,
        wrong_axis,
        other_radius,
        lambda robot: limited(robot, "linear", abs(wanted)),
        lambda robot: too_slow_joint(robot, abs(wanted)),
    )
    slow = (slippery, damped, hangs, odd_mass, drags) if ratio < 1 else ()
    return next(filter(None, (look(robot) for look in (*looks, *slow))), "")


@guarded("")
def no_plugin(robot: Robot) -> str:
    if robot.systems("DiffDrive"):
        return ""
    there = ", ".join(plugin.name or plugin.filename for plugin in robot.plugins) or "no plugin at all"
    return f"no plugin drives them: the robot has no gz::sim::systems::DiffDrive, it has {there}"


@guarded("")
def one_joint_twice(robot: Robot) -> str:
    plugin = plugin_of(robot)
    both = set(plugin.all("left_joint")) & set(plugin.all("right_joint")) if plugin is not None else set()
    return f"<left_joint> and <right_joint> of the plugin are both {min(both)}" if both else ""


@guarded("")
def limited_joint(robot: Robot) -> str:
    for wheel in wheels_of(robot):
        joint = wheel.joint
        if joint.lower is not None and joint.upper is not None and joint.upper - joint.lower < FAR:
            limits = f"{told(joint.lower)} to {told(joint.upper)} rad"
            return f"{joint.name} has the limits {limits}, so the wheel stops there: a wheel's joint is continuous"
    return ""


def between(one: np.ndarray, other: np.ndarray) -> float:
    """Return the angle [rad] between two lines."""
    cosine = abs(float(one @ other)) / float(np.linalg.norm(one) * np.linalg.norm(other) or 1.0)
    return float(np.arccos(min(1.0, cosine)))


@guarded("")
def along(direction: np.ndarray) -> str:
    """Return a direction in words: an axis of the robot, if it is one."""
    for name, axis in zip("xyz", np.eye(3), strict=True):
        if between(direction, axis) < OFF:
            return f"along {name}"
    return f"along ({' '.join(told(float(value)) for value in direction)})"


@guarded("")
def wrong_axis(robot: Robot) -> str:
    """Compare the axis of each wheel's joint with that of its cylinder."""
    for wheel in wheels_of(robot):
        axis, shape = wheel.joint.axis, wheel.shape
        if axis is None or shape is None or shape.kind != "cylinder" or between(axis, shape.axle) < OFF:
            continue
        default = wheel.joint.stated is not None and between(wheel.joint.stated, np.array([1.0, 0.0, 0.0])) < OFF
        why = (
            "a joint without <axis> turns about x" if default else "<axis> is in the joint's own frame, which rpy turns"
        )
        return (
            f"{wheel.joint.name} turns about another axis than the axle of its wheel: seen from the robot it points "
            f"{along(axis)}, and the cylinder of {wheel.link.name} {along(shape.axle)} ({why})"
        )
    return ""


@guarded("")
def lies_flat(robot: Robot) -> str:
    """Compare the axle of each wheel with the direction to its side."""
    for wheel in wheels_of(robot):
        if (
            wheel.shape is None
            or wheel.shape.kind != "cylinder"
            or between(wheel.shape.axle, np.array([0.0, 1.0, 0.0])) < OFF
        ):
            continue
        where = along(wheel.shape.axle)
        return (
            f"the axle of {wheel.link.name} points {where} of the robot, not along y: a cylinder lies along its own z, "
            "and an rpy of pi/2 about x tilts it into a wheel"
        )
    return ""


@guarded("")
def leans(robot: Robot) -> str:
    """Return that a wheel is tilted a little, so that it rolls on its edge; a large tilt is another fault."""
    for wheel in wheels_of(robot):
        axis = wheel.joint.axis
        tilt = between(axis, np.array([axis[0], axis[1], 0.0])) if axis is not None and np.any(axis[:2]) else 0.0
        if OFF < tilt < np.pi / 4:
            return (
                f"the axle of {wheel.link.name} is tilted by {np.degrees(tilt):.0f} degrees, so the wheel rolls on its "
                "edge: look at the rpy of its joint, which is in radians (pi/2, not 90 or 1.5)"
            )
    return ""


@guarded("")
def without_collision(robot: Robot) -> str:
    for wheel in wheels_of(robot):
        if not wheel.link.shapes:
            return f"link {wheel.link.name} has no <collision>, so nothing of the wheel touches the ground"
    return ""


@guarded("")
def hangs(robot: Robot, least: float = HANGS) -> str:
    """Compare the height of the wheels with that of the lowest part, which may be lower by less than `least` [m]."""
    wheels, low = wheels_of(robot), robot.lowest_link()
    if not wheels or low is None:
        return ""
    above = [wheel.link.lowest - low.lowest for wheel in wheels]
    if not np.isfinite(above).all() or min(above) < least or low.name in {wheel.link.name for wheel in wheels}:
        return ""
    return (
        f"its wheels hang in the air: {low.lowest_part} reaches {min(above):.3f} m lower than the wheels, "
        f"which have their lowest point at z {wheels[0].link.lowest:.3f} m of the robot"
    )


@guarded("")
def of_one_side(robot: Robot) -> str:
    """Compare the sides of the wheels."""
    wheels = wheels_of(robot)
    y = [float(wheel.joint.position[1]) for wheel in wheels]
    if len(wheels) == 2 and y[0] * y[1] > 0:
        return f"both wheels are on the same side of the robot: y is {told(y[0])} m and {told(y[1])} m"
    return ""


@guarded("")
def other_radius(robot: Robot) -> str:
    plugin, wheels = plugin_of(robot), wheels_of(robot)
    if plugin is None:
        return ""
    stated = plugin.number("wheel_radius", 0.2)
    for wheel in wheels:
        if wheel.radius and abs(stated / wheel.radius - 1) > SAME:
            default = "" if plugin.text("wheel_radius") else " (its default)"
            return (
                f"the plugin's <wheel_radius> is {told(stated / wheel.radius)} times the radius of its wheels: "
                f"{stated:g} m{default}, and the cylinder of {wheel.link.name} has {wheel.radius:g} m"
                f"{_double(stated / wheel.radius)}"
            )
    return ""


def has_the_radius(robot: Robot) -> bool:
    """Return whether the plugin has the radius of all wheels."""
    wheels = wheels_of(robot)
    return bool(wheels) and all(wheel.radius for wheel in wheels) and not other_radius(robot)


def _double(ratio: float) -> str:
    if abs(ratio - 2) < 2 * SAME:
        return ", half of its diameter"
    return ", so <wheel_radius> is half of that" if abs(ratio - 0.5) < SAME else ""


@guarded("")
def unequal_wheels(robot: Robot) -> str:
    """Return in what the wheels of the two sides differ."""
    wheels = [wheel for wheel in wheels_of(robot) if wheel.radius]
    for one, other in itertools.pairwise(wheels):
        if abs(one.radius / other.radius - 1) > SAME:
            return f"{one.link.name} has a radius of {one.radius:g} m, and {other.link.name} one of {other.radius:g} m"
        mu = [wheel.shape.mu for wheel in (one, other) if wheel.shape is not None and wheel.shape.mu is not None]
        if len(mu) == 2 and min(mu) < 0.5 * max(mu):
            return f"the friction of {one.link.name} is {mu[0]:g}, that of {other.link.name} {mu[1]:g}"
    y = [float(wheel.joint.position[1]) for wheel in wheels]
    if len(y) == 2 and abs(y[0] + y[1]) > SAME * abs(y[0] - y[1]):
        return f"the wheels are not equally far from the middle: y is {told(y[0])} m and {told(y[1])} m"
    return ""


@guarded("")
def limited(robot: Robot, axis: str, wanted: float) -> str:
    """Return which limit of the plugin keeps it from the `wanted` speed [m/s or rad/s]; `axis` is linear or angular."""
    plugin, unit = plugin_of(robot), "m/s" if axis == "linear" else "rad/s"
    for tag in (f"max_{axis}_velocity", "max_velocity") if plugin is not None else ():
        most = plugin.number(tag, np.inf) if plugin is not None else np.inf
        if most < wanted * (1 - SAME):
            return f"<{tag}> of the plugin is {most:g} {unit}, less than the {told(wanted)} {unit} it was commanded"
    for tag in (f"max_{axis}_acceleration", "max_acceleration") if plugin is not None else ():
        most = plugin.number(tag, np.inf) if plugin is not None else np.inf
        if 0 < most < wanted / SECONDS:
            return f"<{tag}> of the plugin is {most:g} {unit}^2, so it takes {told(wanted / most)} s to get up to speed"
    return ""


@guarded("")
def too_slow_joint(robot: Robot, wanted: float) -> str:
    for wheel in wheels_of(robot):
        most = wheel.joint.velocity
        if most is not None and wheel.radius and most * wheel.radius < wanted * (1 - SAME):
            return (
                f"<limit velocity> of {wheel.joint.name} is {most:g} rad/s, with which a wheel of {wheel.radius:g} m "
                f"rolls at {told(most * wheel.radius)} m/s"
            )
    return ""


@guarded("")
def slippery(robot: Robot) -> str:
    for wheel in wheels_of(robot):
        if wheel.shape is not None and wheel.shape.mu is not None and wheel.shape.mu < SLIPPERY:
            return f"{wheel.link.name} has a friction of {wheel.shape.mu:g} (<mu1>), so it slips: a tyre has about 1"
    return ""


@guarded("")
def damped(robot: Robot) -> str:
    for wheel in wheels_of(robot):
        effort, damping = wheel.joint.effort, wheel.joint.damping
        if effort is not None and effort < 0.2:
            return f"<limit effort> of {wheel.joint.name} is {effort:g} N m, too little to turn the wheel"
        if damping > DAMPS:
            return f"<dynamics damping> of {wheel.joint.name} is {damping:g} N m s/rad, which brakes the wheel"
    return ""


@guarded("")
def drags(robot: Robot) -> str:
    """Return what slides along the ground with friction, besides the wheels."""
    low, rolling = robot.lowest_link(), {wheel.link.name for wheel in wheels_of(robot)}
    for link, shape in robot.shapes():
        touches = low is not None and float(shape.corners()[:, 2].min()) < low.lowest + HANGS
        if touches and link.name not in rolling and shape.mu is not None and shape.mu > GRIPS:
            return (
                f"{shape.part or link.name} (a {shape.kind}) slides along the ground with a friction of {shape.mu:g}, "
                "which holds it back: a caster has <mu1>0</mu1> and <mu2>0</mu2>"
            )
    return ""


@guarded("")
def other_separation(robot: Robot) -> str:
    plugin, wheels = plugin_of(robot), wheels_of(robot)
    if plugin is None or len(wheels) != 2:
        return ""
    apart = abs(float(_middle(wheels[0])[1] - _middle(wheels[1])[1]))
    stated = plugin.number("wheel_separation", 1.0)
    if apart < 0.01 or abs(stated / apart - 1) < SAME:
        return ""
    default = "" if plugin.text("wheel_separation") else " (its default)"
    return (
        f"the plugin's <wheel_separation> is {told(stated / apart)} times the distance of its wheels: {stated:g} m"
        f"{default}, and their middles are {apart:g} m apart"
    )


def _middle(wheel: Wheel) -> np.ndarray:
    return wheel.shape.position if wheel.shape is not None else wheel.joint.position


@guarded("")
def sides_exchanged(robot: Robot) -> str:
    """Return which joint is on the other side than its element of the plugin says."""
    for wheel in wheels_of(robot):
        y = float(wheel.joint.position[1])
        if (y < -0.01) if wheel.side == "left" else (y > 0.01):
            other = "right" if wheel.side == "left" else "left"
            name = wheel.joint.name
            return f"<{wheel.side}_joint> of the plugin is {name}, which is on the {other}: its y is {told(y)} m"
    return ""


@guarded("")
def beside_the_middle(robot: Robot) -> str:
    """Return where the middle between the wheels is, if that is not the origin of the robot."""
    wheels = wheels_of(robot)
    if len(wheels) != 2:
        return ""
    middle = (_middle(wheels[0]) + _middle(wheels[1])) / 2
    if np.hypot(*middle[:2]) < 0.02:
        return ""
    return (
        f"the middle between its wheels is at x {told(float(middle[0]))} m, y {told(float(middle[1]))} m of its root "
        "link, and it turns about that middle: put the origin of the root link there"
    )


@guarded("")
def turns_slowly(robot: Robot, wanted: float) -> str:
    """Return the first of why a robot turns more slowly than the `wanted` rate [rad/s]."""
    return next(filter(None, _slow_turns(robot, wanted)), "")


def _slow_turns(robot: Robot, wanted: float) -> Iterator[str]:
    yield other_separation(robot)
    yield limited(robot, "angular", abs(wanted))
    yield slippery(robot)
    yield drags(robot)
    yield damped(robot)
    yield odd_mass(robot)
