"""Boxes at rest on a slope, around the friction at which they begin to slide."""

import math

from gz_course.tests.conformance.physics.bricks import box, friction, ground, on_slope
from gz_course.tests.conformance.physics.scene import Measure, Scene


def incline(degrees: float, mu: float) -> Scene:
    slope = math.radians(degrees)
    pull = 9.8 * (math.sin(slope) - mu * math.cos(slope))
    return Scene(
        f"{degrees:g} degrees, mu {mu:g}: the box {'slides' if pull > 0.0 else 'stays'}",
        ground(10.0, slope)
        + box("box", on_slope(0.05, slope), size=(0.4, 0.4, 0.1), surface=friction(mu, "<fdir1>1 0 0</fdir1>")),
        1.0,
        (Measure("way [m]", lambda t: t.way()[-1] / math.cos(slope), 0.005, closed=max(0.0, pull / 2.0)),),
        links=("box::link",),
    )


SCENES = (
    *(incline(15.0, mu) for mu in (0.1, 0.2, 0.25, 0.29, 0.4)),
    *(incline(30.0, mu) for mu in (0.3, 0.5, 0.55, 0.6, 0.8)),
)
