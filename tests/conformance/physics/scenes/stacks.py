"""Boxes on boxes."""

from gz_course.tests.conformance.physics.bricks import box, ground
from gz_course.tests.conformance.physics.scene import Kick, Measure, Scene


def stack(masses: tuple[float, ...]) -> str:
    return ground() + "".join(box(f"box{n}", f"0 0 {0.1 + 0.2 * n} 0 0 0", mass) for n, mass in enumerate(masses))


def stands(name: str, masses: tuple[float, ...]) -> Scene:
    top = f"box{len(masses) - 1}::link"
    return Scene(
        name,
        stack(masses),
        2.0,
        (
            Measure("height of the top [m]", lambda t: t.z()[-1], 0.005, closed=0.2 * len(masses) - 0.1),
            Measure("drift of the top [m]", lambda t: t.way()[-1], 0.002, closed=0.0),
        ),
        links=(top,),
        short=len(masses) < 4,
    )


SCENES = (
    stands("five equal boxes stand", (1.0,) * 5),
    stands("a box of 10 kg on one of 1 kg stands", (1.0, 10.0)),
    stands("light on heavy on light", (1.0, 5.0, 0.2)),
    Scene(
        "the lower box is pushed from under the upper one",
        stack((1.0, 1.0)),
        1.0,
        (Measure("way of the lower box [m]", lambda t: t.x()[-1], 0.02),),
        (Kick("box0", (1.5, 0.0, 0.0)),),
        links=("box0::link",),
    ),
)
