"""Restitution, and fast bodies at walls."""

from gz_course.tests.conformance.physics.bricks import (
    box,
    box_shape,
    collision,
    friction,
    ground,
    inertial,
    joint_controller,
    model,
    sphere,
)
from gz_course.tests.conformance.physics.scene import Kick, Measure, Scene, Servo, Track


def rebound(track: Track) -> float:
    """The height [m] above the rest to which a sphere of 0.1 m comes back after its first contact."""
    return float(track.after(track.z(), 0.5).max()) - 0.1


def bounce(one: float, other: float) -> Scene:
    product = one * other
    return Scene(
        f"from 1 m, restitution {one:g} on {other:g}",
        ground(restitution=other) + sphere("ball", "0 0 1.1 0 0 0", surface=friction(1.0, restitution=one)),
        1.3,
        (Measure("rebound [m]", rebound, 0.01, 0.06, product * product),),
        links=("ball::link",),
        every=0.002,
    )


def thrown_at_a_wall(speed: float, thickness: float) -> Scene:
    wall = model(
        "wall",
        "2 0 1 0 0 0",
        f"<link name='link'>{collision(box_shape(thickness, 2.0, 2.0), friction(1.0))}</link>",
        static=True,
    )
    return Scene(
        f"a sphere of 5 cm at {speed:g} m/s at a wall of {thickness * 100:g} cm",
        wall + sphere("ball", "0 0 1 0 0 0", 0.5, 0.025),
        2.2 / speed + 0.3,
        (Measure("behind the wall [0 or 1]", lambda t: float(t.x()[-1] > 2.0), 0.1),),
        (Kick("ball", (speed, 0.0, 0.0)),),
        links=("ball::link",),
        every=0.005,
        gravity=0.0,
    )


PUSHER = model(
    "pusher",
    "-0.5 0 0.15 0 0 0",
    f"<link name='link'>{inertial(5.0, 0.1, 0.1, 0.1)}{collision(box_shape(0.1, 0.4, 0.1), friction(0.5))}</link>"
    "<joint name='joint' type='prismatic'><parent>world</parent><child>link</child><axis><xyz>1 0 0</xyz></axis>"
    "</joint>" + joint_controller("joint"),
)
SCENES = (
    *(
        bounce(one, other)
        for one, other in ((0.0, 0.0), (0.05, 0.05), (0.3, 0.3), (0.4, 0.4), (0.5, 0.5), (0.9, 0.9), (1.0, 0.2))
    ),
    thrown_at_a_wall(10.0, 0.1),
    thrown_at_a_wall(60.0, 0.1),
    thrown_at_a_wall(40.0, 0.01),
    Scene(
        "a box of 10 kg is pushed at 1 m/s",
        ground() + box("box", "0 0 0.15 0 0 0", 10.0, (0.3, 0.3, 0.3)) + PUSHER,
        1.5,
        (
            Measure("hop [m]", lambda t: t.z("box::link").max() - 0.15, 0.005, closed=0.0),
            Measure("speed [m/s]", lambda t: t.mean_rate(t.x("box::link"), 1.0), 0.02, closed=1.0),
        ),
        (Servo("pusher::joint", 1.0, 0.2),),
        ("box::link",),
    ),
)
