"""Round bodies that roll."""

import math

from gz_course.tests.conformance.physics.bricks import (
    collision,
    cylinder_shape,
    friction,
    ground,
    inertial,
    model,
    on_slope,
    sphere,
)
from gz_course.tests.conformance.physics.scene import Kick, Measure, Scene

SLOPE = math.radians(10.0)
PULL = 9.8 * math.sin(SLOPE) / 2.0


def roller(share: float) -> str:
    """A cylinder on its side whose inertia is `share` times that of a thin ring."""
    x, y, z, *_ = on_slope(0.1, SLOPE).split()
    k = share * 0.01
    body = inertial(1.0, k, k, k) + collision(cylinder_shape(0.1, 0.1), friction(1.0))
    return model("roller", f"{x} {y} {z} {math.pi / 2.0} 0 0", f"<link name='link'>{body}</link>")


SCENES = (
    Scene(
        "a sphere rolls down 10 degrees",
        ground(1.0, SLOPE) + sphere("ball", on_slope(0.1, SLOPE)),
        1.0,
        (Measure("way [m]", lambda t: t.way()[-1] / math.cos(SLOPE), 0.01, closed=PULL / 1.4),),
        links=("ball::link",),
    ),
    *(
        Scene(
            f"a {name} rolls down 10 degrees",
            ground(1.0, SLOPE) + roller(share),
            1.0,
            (Measure("way [m]", lambda t: t.way()[-1] / math.cos(SLOPE), 0.01, closed=PULL / (1.0 + share)),),
            links=("roller::link",),
        )
        for name, share in (("full cylinder", 0.5), ("ring", 1.0))
    ),
    Scene(
        "a sliding sphere begins to roll",
        ground(0.3) + sphere("ball", "0 0 0.1 0 0 0"),
        1.5,
        (
            Measure("speed [m/s]", lambda t: t.mean_rate(t.x(), 1.0), 0.02, closed=2.0 * 5.0 / 7.0),
            Measure("way [m]", lambda t: t.x()[-1], 0.03),
        ),
        (Kick("ball", (2.0, 0.0, 0.0)),),
        links=("ball::link",),
    ),
    Scene(
        "a spinning sphere starts to move",
        ground(0.3) + sphere("ball", "0 0 0.1 0 0 0"),
        1.5,
        (Measure("speed [m/s]", lambda t: t.mean_rate(t.x(), 1.0), 0.02, closed=20.0 * 0.1 * 2.0 / 7.0),),
        (Kick("ball", (0.0, 0.0, 0.0), (0.0, 20.0, 0.0)),),
        links=("ball::link",),
    ),
)
