"""Boxes that slide to rest on level ground."""

from gz_course.tests.conformance.physics.bricks import box, friction, ground
from gz_course.tests.conformance.physics.scene import Kick, Measure, Scene


def slide(mu: float, other: float, name: str = "") -> Scene:
    way = 2.0**2 / (2.0 * min(mu, other) * 9.8)
    return Scene(
        name or f"a box slides, mu {mu:g} on {other:g}",
        ground(other) + box("box", "0 0 0.05 0 0 0", size=(0.4, 0.4, 0.1), surface=friction(mu)),
        0.2 + 2.0 / (min(mu, other) * 9.8),
        (Measure("way [m]", lambda t: t.way()[-1], 0.01, closed=way),),
        (Kick("box", (2.0, 0.0, 0.0), time=0.05),),
        links=("box::link",),
        short=min(mu, other) >= 0.3,
    )


def across(name: str, surface: str, velocity: tuple[float, float], closed: float | None) -> Scene:
    return Scene(
        name,
        ground(10.0) + box("box", "0 0 0.05 0 0 0", size=(0.4, 0.4, 0.1), surface=surface),
        2.0,
        (Measure("way [m]", lambda t: t.way()[-1], 0.02, closed=closed),),
        (Kick("box", (*velocity, 0.0), time=0.05),),
        links=("box::link",),
        engines=frozenset(("plugin",)),
    )


SCENES = (
    *(slide(mu, 10.0) for mu in (0.1, 0.3, 0.6, 1.0, 1.5)),
    slide(1.5, 0.2, "the smaller mu counts: ground"),
    slide(0.2, 1.5, "the smaller mu counts: box"),
    across("along mu 1, with mu2 0.1", friction(1.0, "<mu2>0.1</mu2><fdir1>1 0 0</fdir1>"), (1.0, 0.0), 0.051),
    across("along mu2 0.1, with mu 1", friction(1.0, "<mu2>0.1</mu2><fdir1>1 0 0</fdir1>"), (0.0, 1.0), 0.510),
    across("at 45 degrees to fdir1", friction(0.3, "<fdir1>1 0 0</fdir1>"), (1.4142, 1.4142), 0.680),
)
