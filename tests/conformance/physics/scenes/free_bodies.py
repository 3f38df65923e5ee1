"""Bodies that touch nothing or only land."""

from gz_course.tests.conformance.physics.bricks import box, ground, inertial, model, sphere
from gz_course.tests.conformance.physics.scene import Kick, Measure, Scene

SCENES = (
    Scene(
        "free fall",
        sphere("ball", "0 0 10 0 0 0"),
        1.0,
        (Measure("fallen [m]", lambda t: 10.0 - t.z()[-1], 0.006, closed=4.9),),
        links=("ball::link",),
    ),
    Scene(
        "thrown",
        sphere("ball", "0 0 1 0 0 0"),
        1.0,
        (
            Measure("distance [m]", lambda t: t.x()[-1], 0.001, closed=3.0),
            Measure("height [m]", lambda t: t.z()[-1], 0.006, closed=1.0 + 5.0 - 4.9),
        ),
        (Kick("ball", (3.0, 0.0, 5.0)),),
        links=("ball::link",),
    ),
    Scene(
        "a spinning body keeps its rate",
        box("box", "0 0 0 0 0 0"),
        2.0,
        (Measure("turned [rad]", lambda t: t.yaw()[-1], 0.001, closed=6.0),),
        (Kick("box", (0.0, 0.0, 0.0), (0.0, 0.0, 3.0)),),
        links=("box::link",),
        gravity=0.0,
    ),
    Scene(
        "a plate tumbles about its middle axis",
        model("plate", "0 0 0 0 0 0", f"<link name='link'>{inertial(1.0, 0.01, 0.02, 0.03)}</link>"),
        3.0,
        (Measure("tilt after 3 s [rad]", lambda t: t.tilt()[-1], 0.05),),
        (Kick("plate", (0.0, 0.0, 0.0), (0.05, 3.0, 0.0)),),
        links=("plate::link",),
        gravity=0.0,
    ),
    Scene(
        "a box lands flat",
        ground() + box("box", "0 0 0.6 0 0 0"),
        1.5,
        (
            Measure("height [m]", lambda t: t.z()[-1], 0.001, closed=0.1),
            Measure("rebound [m]", lambda t: t.after(t.z(), 0.5).max() - 0.1, 0.002, closed=0.0),
            Measure("drift [m]", lambda t: t.way()[-1], 0.001, closed=0.0),
        ),
        links=("box::link",),
    ),
)
