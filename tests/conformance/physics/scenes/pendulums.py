"""Links that swing on joints."""

import math

import numpy as np

from gz_course.tests.conformance.physics.bricks import arm, inertial, model
from gz_course.tests.conformance.physics.scene import Measure, Scene, Track


def period(track: Track) -> float:
    """The time [s] between two passages of the rest position in one direction."""
    angle = track.angle() - math.pi / 2.0
    rising = np.flatnonzero((angle[:-1] < 0.0) & (angle[1:] >= 0.0))
    times = [track.time[i] - angle[i] / (angle[i + 1] - angle[i]) * (track.time[i + 1] - track.time[i]) for i in rising]
    return float(np.mean(np.diff(times)))


DOUBLE = model(
    "arm",
    "0 0 2 0 0 0",
    f"<link name='one'>{inertial(1.0, 0.01, 0.01, 0.01, '0.3 0 0 0 0 0')}</link>"
    f"<link name='two'><pose>0.6 0 0 0 0 0</pose>{inertial(0.5, 0.01, 0.01, 0.01, '0.2 0 0 0 0 0')}</link>"
    "<joint name='first' type='revolute'><parent>world</parent><child>one</child><axis><xyz>0 1 0</xyz></axis></joint>"
    "<joint name='second' type='revolute'><parent>one</parent><child>two</child><axis><xyz>0 1 0</xyz></axis></joint>",
)
FULL = 2.0 * math.pi * math.sqrt((0.01 + 0.25) / (9.8 * 0.5))  # [s] of small swings
SCENES = (
    Scene(
        "a pendulum from the horizontal",
        arm(),
        6.0,
        (
            Measure("period [s]", period, 0.01, closed=1.18034 * FULL),
            Measure("highest in the last swing [rad]", lambda t: t.after(t.angle(), 4.0).max(), 0.03, closed=math.pi),
        ),
        joints=("arm::joint",),
    ),
    Scene(
        "a double pendulum",
        DOUBLE,
        1.5,
        (
            Measure("first angle [rad]", lambda t: t.angle("arm::first")[-1], 0.05),
            Measure("second angle [rad]", lambda t: t.angle("arm::second")[-1], 0.05),
        ),
        joints=("arm::first", "arm::second"),
    ),
    Scene(
        "damping",
        arm("<damping>0.5</damping>"),
        3.0,
        (
            Measure("angle [rad]", lambda t: t.angle()[-1], 0.02),
            Measure("first overshoot [rad]", lambda t: t.angle().max(), 0.02),
        ),
        joints=("arm::joint",),
    ),
    Scene(
        "a spring without gravity",
        arm("<spring_stiffness>5</spring_stiffness><spring_reference>0.4</spring_reference>"),
        2.0,
        (
            Measure("largest angle [rad]", lambda t: t.angle().max(), 0.02, closed=0.8),
            Measure("angle [rad]", lambda t: t.angle()[-1], 0.04),
        ),
        joints=("arm::joint",),
        gravity=0.0,
    ),
)
