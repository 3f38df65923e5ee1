"""Robots with two driven wheels: commanded against true speed."""

from gz_course.tests.conformance.physics.bricks import built_in, ground, three_point_robot
from gz_course.tests.conformance.physics.scene import Drive, Measure, Scene


def moves(
    name: str,
    robot: str,
    link: str,
    linear: float,
    angular: float,
    *,
    short: bool = True,
    seconds: float = 3.0,
) -> Scene:
    """Commanded from 0.3 s on, measured from 1.5 s on."""
    measures = []
    if linear:
        speed = Measure("speed [m/s]", lambda t: t.mean_rate(t.x(), 1.5), 0.0, 0.01, linear, "closed")
        measures += [speed, Measure("aside [m]", lambda t: t.y()[-1], 0.01, closed=0.0)]
    if angular:
        turning = Measure("turning [rad/s]", lambda t: t.mean_rate(t.yaw(), 1.5), 0.0, 0.01, angular, "closed")
        measures += [turning, Measure("way [m]", lambda t: t.way()[-1], 0.02, closed=0.0)]
    command = Drive(link.split("::")[0], linear, angular, 0.3)
    return Scene(name, ground() + robot, seconds, tuple(measures), (command,), (link,), short=short)


def casters(mu: float, tyre: str) -> list[Scene]:
    robot = three_point_robot(mu, tyre=tyre)
    return [
        moves(f"caster of mu {mu:g}, {tyre} tyres: {what}", robot, "robot::base", *motion, short=mu == 1.0)
        for what, motion in (
            ("ahead", (0.5, 0.0)),
            ("back", (-0.5, 0.0)),
            ("left", (0.0, 1.0)),
            ("right", (0.0, -1.0)),
        )
    ]


SCENES = (
    *(scene for mu in (0.0, 0.1, 0.3, 1.0) for scene in casters(mu, "sphere")),
    *(scene for mu in (0.0, 1.0) for scene in casters(mu, "cylinder")),
    *(
        Scene(
            f"motors of {effort:g} N m drag a caster of mu 1",
            ground() + three_point_robot(1.0, limit=f"<limit><effort>{effort}</effort></limit>"),
            3.0,
            (Measure("way [m]", lambda t: t.way()[-1], 0.02),),
            (Drive("robot", 0.5, time=0.3),),
            ("robot::base",),
        )
        for effort in (0.05, 0.15, 0.25)
    ),
    *(
        moves(
            f"rigid casters of mu {mu:g} before and behind: {what}",
            three_point_robot(mu, casters=2),
            "robot::base",
            *motion,
        )
        for mu in (0.3, 1.0)
        for what, motion in (("ahead", (0.5, 0.0)), ("left", (0.0, 1.0)))
    ),
    *(
        moves(
            f"{name}: {what}",
            built_in(name),
            f"{name}::base_link",
            *motion,
            short=name == "two_wheel_robot",
        )
        for name in ("two_wheel_robot", "cargo_robot")
        for what, motion in (("ahead", (0.3, 0.0)), ("left", (0.0, 1.0)))
    ),
)
