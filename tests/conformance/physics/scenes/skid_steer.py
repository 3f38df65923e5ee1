"""Robots with four driven wheels, which must skid to turn."""

from gz_course.tests.conformance.physics.bricks import four_wheel_robot, friction, ground
from gz_course.tests.conformance.physics.scene import Drive, Measure, Scene


def arc(name: str, robot: str, linear: float, angular: float, *, seconds: float = 8.0) -> Scene:
    return Scene(
        name,
        ground() + robot,
        seconds,
        (
            Measure("x [m]", lambda t: t.x()[-1], 0.05, 0.0),
            Measure("y [m]", lambda t: t.y()[-1], 0.05, 0.0),
            Measure("yaw [rad]", lambda t: t.yaw()[-1], 0.035, 0.0),
        ),
        (Drive("robot", linear, angular),),
        ("robot::base",),
        short=False,
        engines=frozenset(("plugin",)),
    )


SLIPPING = friction(1.0, "<slip1>0.035</slip1><slip2>0</slip2><fdir1>0 0 1</fdir1>")
SCENES = (
    arc("slip1 0.035: an arc of v = w = 0.5", four_wheel_robot(SLIPPING), 0.5, 0.5),
    arc("slip1 0.035: on the spot", four_wheel_robot(SLIPPING), 0.0, 0.5),
    arc("slip1 0.035, cylinders: on the spot", four_wheel_robot(SLIPPING, tyre="cylinder"), 0.0, 0.5),
    arc("slip1 0.1: an arc of v = w = 0.5", four_wheel_robot(SLIPPING.replace("0.035", "0.1")), 0.5, 0.5),
    arc("slip1 0.035: straight", four_wheel_robot(SLIPPING), 0.5, 0.0, seconds=4.0),
    arc(
        "slippery front wheels",
        four_wheel_robot(friction(5.0), front=friction(0.01)),
        0.5,
        0.5,
    ),
    arc(
        "mu2 0.1 across the wheels",
        four_wheel_robot(friction(0.1, "<mu2>1</mu2><fdir1>0 0 1</fdir1>")),
        0.5,
        0.5,
    ),
    arc("no slip, mu2 = mu: on the spot", four_wheel_robot(friction(1.0)), 0.0, 1.0, seconds=4.0),
)
