"""Worlds' parts as SDF text: grounds, single bodies, robots. Lengths in [m], masses in [kg], angles in [rad]."""

from __future__ import annotations

import math
from pathlib import Path

from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS

QUARTER = math.pi / 2.0


def friction(mu: float, more: str = "", restitution: float = 0.0) -> str:
    """A `<surface>`; `more` is the rest of `<ode>`."""
    bounce = f"<bounce><restitution_coefficient>{restitution}</restitution_coefficient></bounce>" if restitution else ""
    mu2 = "" if "<mu2>" in more else f"<mu2>{mu}</mu2>"
    return f"<surface>{bounce}<friction><ode><mu>{mu}</mu>{mu2}{more}</ode></friction></surface>"


def ground(mu: float = 1.0, slope: float = 0.0, restitution: float = 0.0) -> str:
    """A plane that descends towards +x."""
    return (
        f"<model name='ground'><static>true</static><pose>0 0 0 0 {slope} 0</pose><link name='link'><collision "
        "name='plane'><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>"
        f"{friction(mu, restitution=restitution)}</collision></link></model>"
    )


def inertial(mass: float, x: float, y: float, z: float, pose: str = "0 0 0 0 0 0") -> str:
    return (
        f"<inertial><pose>{pose}</pose><mass>{mass}</mass><inertia><ixx>{x}</ixx><iyy>{y}</iyy><izz>{z}</izz></inertia>"
        "</inertial>"
    )


def box_inertial(mass: float, x: float, y: float, z: float, pose: str = "0 0 0 0 0 0") -> str:
    k = mass / 12.0
    return inertial(mass, k * (y * y + z * z), k * (x * x + z * z), k * (x * x + y * y), pose)


def collision(shape: str, surface: str, name: str = "shape", pose: str = "0 0 0 0 0 0") -> str:
    return f"<collision name='{name}'><pose>{pose}</pose><geometry>{shape}</geometry>{surface}</collision>"


def box_shape(x: float, y: float, z: float) -> str:
    return f"<box><size>{x} {y} {z}</size></box>"


def sphere_shape(radius: float) -> str:
    return f"<sphere><radius>{radius}</radius></sphere>"


def cylinder_shape(radius: float, length: float) -> str:
    return f"<cylinder><radius>{radius}</radius><length>{length}</length></cylinder>"


def model(name: str, pose: str, inside: str, static: bool = False) -> str:
    held = "<static>true</static>" if static else ""
    return f"<model name='{name}'>{held}<pose>{pose}</pose>{inside}</model>"


def box(
    name: str, pose: str, mass: float = 1.0, size: tuple[float, float, float] = (0.2, 0.2, 0.2), surface: str = ""
) -> str:
    shape = collision(box_shape(*size), surface or friction(1.0))
    return model(name, pose, f"<link name='link'>{box_inertial(mass, *size)}{shape}</link>")


def sphere(name: str, pose: str, mass: float = 1.0, radius: float = 0.1, surface: str = "") -> str:
    k = 0.4 * mass * radius * radius
    shape = collision(sphere_shape(radius), surface or friction(1.0))
    return model(name, pose, f"<link name='link'>{inertial(mass, k, k, k)}{shape}</link>")


def on_slope(height: float, slope: float) -> str:
    """The pose of a body whose centre is `height` above a plane that descends towards +x."""
    return f"{height * math.sin(slope)} 0 {height * math.cos(slope)} 0 {slope} 0"


def drive(left: str, right: str, separation: float, radius: float) -> str:
    joints = "".join(f"<left_joint>{each}</left_joint>" for each in left.split())
    joints += "".join(f"<right_joint>{each}</right_joint>" for each in right.split())
    return (
        "<plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'>"
        f"{joints}<wheel_separation>{separation}</wheel_separation><wheel_radius>{radius}</wheel_radius></plugin>"
    )


def joint_controller(joint: str) -> str:
    return (
        "<plugin filename='gz-sim-joint-controller-system' name='gz::sim::systems::JointController'>"
        f"<joint_name>{joint}</joint_name></plugin>"
    )


def apply_force(joint: str) -> str:
    return (
        "<plugin filename='gz-sim-apply-joint-force-system' name='gz::sim::systems::ApplyJointForce'>"
        f"<joint_name>{joint}</joint_name></plugin>"
    )


def wheel(
    name: str, x: float, y: float, z: float, radius: float, mass: float, shape: str, surface: str, limit: str = ""
) -> str:
    """A wheel of the link `base` that turns about the y axis, and its joint `NAME_joint`."""
    flat, side = mass * radius * radius / 2.0, mass * radius * radius / 3.5
    return (
        f"<link name='{name}'><pose>{x} {y} {z} {-QUARTER} 0 0</pose>{inertial(mass, side, side, flat)}"
        f"{collision(shape, surface)}</link><joint name='{name}_joint' type='revolute'><parent>base</parent>"
        f"<child>{name}</child><axis><xyz>0 0 1</xyz>{limit}</axis></joint>"
    )


def three_point_robot(caster_mu: float, *, tyre: str = "sphere", casters: int = 1, limit: str = "") -> str:
    """A robot of 4.3 kg on two driven wheels (radius 0.05, 0.25 apart) and on rigid casters with friction."""
    shape = sphere_shape(0.05) if tyre == "sphere" else cylinder_shape(0.05, 0.03)
    places = [-0.13] if casters == 1 else [-0.13, 0.13]
    balls = "".join(
        collision(sphere_shape(0.02), friction(caster_mu), f"caster{number}", f"{x} 0 -0.03 0 0 0")
        for number, x in enumerate(places)
    )
    base = box_inertial(3.5, 0.3, 0.2, 0.08, f"{-0.02 if casters == 1 else 0} 0 0.02 0 0 0")
    wheels = "".join(
        wheel(name, 0.0, y, 0.05, 0.05, 0.4, shape, friction(1.0), limit)
        for name, y in (("left", 0.125), ("right", -0.125))
    )
    inside = f"<link name='base'><pose>0 0 0.05 0 0 0</pose>{base}{balls}</link>{wheels}"
    return model("robot", "0 0 0 0 0 0", inside + drive("left_joint", "right_joint", 0.25, 0.05))


def four_wheel_robot(surface: str, *, front: str = "", tyre: str = "sphere", pose: str = "0 0 0.325 0 0 0") -> str:
    """A robot with four driven wheels (radius 0.3, 1.25 apart, 1.51 from axle to axle); `front` is another surface of
    the front wheels.
    """
    shape = sphere_shape(0.3) if tyre == "sphere" else cylinder_shape(0.3, 0.25)
    wheels = "".join(
        wheel(f"{end}_{side}", x, y, -0.025, 0.3, 2.0, shape, (front or surface) if end == "front" else surface)
        for end, x in (("front", 0.554283), ("rear", -0.957138))
        for side, y in (("left", 0.625029), ("right", -0.625029))
    )
    base = inertial(1.14395, 0.126164, 0.416519, 0.481014)
    inside = f"<link name='base'><pose>-0.151427 0 0.175 0 0 0</pose>{base}</link>{wheels}"
    sides = ("front_left_joint rear_left_joint", "front_right_joint rear_right_joint")
    return model("robot", pose, inside + drive(*sides, 1.25, 0.3))


def arm(
    dynamics: str = "", limit: str = "", plugin: str = "", *, kind: str = "revolute", axis: str = "0 1 0", reach=0.5
) -> str:
    """A thin body of 1 kg on a joint `joint` to the world, its centre `reach` beyond the joint along x."""
    return model(
        "arm",
        "0 0 2 0 0 0",
        f"<link name='link'>{inertial(1.0, 0.001, 0.01, 0.01, f'{reach} 0 0 0 0 0')}</link>"
        f"<joint name='joint' type='{kind}'><parent>world</parent><child>link</child><axis><xyz>{axis}</xyz>"
        f"<dynamics>{dynamics}</dynamics><limit>{limit}</limit></axis></joint>{plugin}",
    )


def built_in(name: str, pose: str = "0 0 0 0 0 0") -> str:
    """One of the course's models, without its sensors."""
    text = (Path(BUILT_IN_MODELS) / name / "model.sdf").read_text()
    start = text.index(">", text.index("<model ")) + 1
    head = text[text.index("<model ") : start]
    return f"{head}<pose>{pose}</pose>{text[start : text.index('</model>')]}</model>"
