"""Robots parked on a slope, driving up one, and pressing against a wall."""

import math

import numpy as np

from gz_course.tests.conformance.physics.bricks import (
    box_shape,
    built_in,
    collision,
    friction,
    ground,
    model,
    three_point_robot,
)
from gz_course.tests.conformance.physics.scene import Drive, Measure, Scene

SLOPE = math.radians(10.0)
WALL = model(
    "wall", "1 0 0.5 0 0 0", f"<link name='link'>{collision(box_shape(0.2, 4, 1), friction(1.0))}</link>", True
)
COURSE = ("two_wheel_robot", "cargo_robot")


def up(text: str) -> str:
    """The robot on a plane that descends towards +x."""
    return text.replace("<pose>0 0 0 0 0 0</pose>", f"<pose>0 0 0 0 {SLOPE} 0</pose>", 1)


def parked(name: str, text: str, link: str) -> Scene:
    return Scene(
        f"{name}: parked on 10 degrees",
        ground(1.0, SLOPE) + up(text),
        3.0,
        (Measure("creep [m/s]", lambda t: t.mean_rate(t.x(), 1.0), 2e-4, 0.0, 0.0),),
        (Drive(name, 0.0),),
        (f"{name}::{link}",),
        short=name != "cargo_robot",
    )


def climbing(name: str, text: str, link: str, speed: float) -> Scene:
    return Scene(
        f"{name}: {'up' if speed < 0 else 'down'} 10 degrees",
        ground(1.0, SLOPE) + up(text),
        3.0,
        (Measure("speed [m/s]", lambda t: t.mean_rate(t.x(), 1.5) / math.cos(SLOPE), 0.0, 0.01, speed),),
        (Drive(name, speed, time=0.3),),
        (f"{name}::{link}",),
        short=False,
    )


def pressing(name: str, text: str, link: str) -> Scene:
    return Scene(
        f"{name}: pressed against a wall",
        ground() + WALL + text,
        5.0,
        (
            Measure(
                "noise of the speed [m/s]",
                lambda t: float(np.std(t.after(t.rate(t.x()), 4.0))),
                0.005,
                0.0,
                0.0,
                "closed",
            ),
            Measure("largest tilt [rad]", lambda t: t.after(t.tilt(), 4.0).max(), 0.05),
        ),
        (Drive(name, 0.3, time=0.3),),
        (f"{name}::{link}",),
        every=0.002,
        short=False,
    )


SCENES = (
    *(parked(name, built_in(name), "base_link") for name in COURSE),
    parked("robot", three_point_robot(0.3), "base"),
    *(climbing(name, built_in(name), "base_link", speed) for name in COURSE for speed in (0.3, -0.3)),
    *(pressing(name, built_in(name), "base_link") for name in COURSE),
)
