"""Friction and limits of joints."""

import math

from gz_course.tests.conformance.physics.bricks import apply_force, arm, joint_controller
from gz_course.tests.conformance.physics.scene import Force, Measure, Scene, Servo

LOAD = 4.9  # [N m] of the arm at the horizontal
INERTIA = 0.26  # [kg m^2] of the arm about its joint


def held(name: str, friction: float, **more: object) -> Scene:
    return Scene(
        name,
        arm(f"<friction>{friction}</friction>", **more),
        2.0,
        (Measure("creep [rad/s or m/s]", lambda t: t.mean_rate(t.angle(), 1.0), 5e-4, closed=0.0),),
        joints=("arm::joint",),
    )


def stopped(name: str, speed: float, upper: float, **more: object) -> Scene:
    """An arm without load flies against its limit."""
    plugin = joint_controller("joint") if more.pop("servo", False) else apply_force("joint")
    return Scene(
        name,
        arm("", f"<lower>-1</lower><upper>{upper}</upper>", plugin, **more),
        1.5,
        (
            Measure("beyond the limit [rad or m]", lambda t: max(0.0, t.angle().max() - upper), 0.005, closed=0.0),
            Measure(
                "rebound [rad or m]",
                lambda t: t.angle().max() - t.after(t.angle(), t.time[t.angle().argmax()]).min(),
                0.01,
                closed=0.0,
            ),
        ),
        (Servo("arm::joint", speed),)
        if "JointController" in plugin
        else (Force("arm::joint", speed * INERTIA / 0.1), Force("arm::joint", 0.0, 0.1)),
        joints=("arm::joint",),
        every=0.001,
        gravity=0.0,
    )


SCENES = (
    held("friction 5 N m holds 4.9 N m", 5.0),
    held("friction 56 N m holds 4.9 N m", 56.0),
    held("a slide with friction 10 N holds 9.8 N", 10.0, kind="prismatic", axis="0 0 1"),
    held("a slide with friction 100 N holds 9.8 N", 100.0, kind="prismatic", axis="0 0 1"),
    Scene(
        "friction 2 N m slows the fall of an arm",
        arm("<friction>2</friction>"),
        0.4,
        (Measure("angle [rad]", lambda t: t.angle()[-1], 0.01),),
        joints=("arm::joint",),
    ),
    Scene(
        "a force above the friction accelerates",
        arm("<friction>2</friction>", plugin=apply_force("joint")),
        1.0,
        (Measure("angle [rad]", lambda t: t.angle()[-1], 0.02, closed=0.5 * 1.0 / INERTIA),),
        (Force("arm::joint", 3.0),),
        joints=("arm::joint",),
        gravity=0.0,
    ),
    Scene(
        "a force below the friction does not move",
        arm("<friction>2</friction>", plugin=apply_force("joint")),
        1.0,
        (Measure("angle [rad]", lambda t: t.angle()[-1], 0.0005, closed=0.0),),
        (Force("arm::joint", 1.9),),
        joints=("arm::joint",),
        gravity=0.0,
    ),
    stopped("a limit is hit at 6 rad/s", 6.0, 0.9),
    stopped("a limit is hit at 1 rad/s", 1.0, 0.6),
    stopped("a limit is hit at 6 rad/s by a servo", 6.0, 0.9, servo=True),
    stopped("a limit of a slide is hit at 1.5 m/s", 6.0 * 0.25, 0.3, kind="prismatic", axis="1 0 0"),
    Scene(
        "an arm falls on its limit",
        arm("", f"<lower>-1</lower><upper>{math.radians(60)}</upper>"),
        2.0,
        (
            Measure(
                "beyond the limit [rad]", lambda t: max(0.0, t.angle().max() - math.radians(60)), 0.005, closed=0.0
            ),
            Measure("angle at rest [rad]", lambda t: t.angle()[-1], 0.003, closed=math.radians(60)),
        ),
        joints=("arm::joint",),
        every=0.001,
    ),
)
