"""Adds the lights of the world and of links as MuJoCo lights, which ray-casting cameras use.

A light of a link is called `model::link::light`, one of the world has its plain name.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.static_parts import StaticParts
from gz_course.sim.gz.sim.pose import Pose, matrix
from gz_course.sim.gz.sim.sdf.description import Light

_TYPES = {
    "directional": mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
    "point": mujoco.mjtLightType.mjLIGHT_POINT,
    "spot": mujoco.mjtLightType.mjLIGHT_SPOT,
}


def add_light(body: mujoco.MjsBody | StaticParts, name: str, base: Pose, light: Light) -> None:
    """Add a light to a body; `base` is the pose of its link in that body."""
    pose = base * light.pose
    made = body.add_light(name=name, pos=pose.position)
    made.type = _TYPES[light.kind]
    made.dir = matrix(pose.quaternion) @ np.asarray(light.direction)
    made.diffuse = np.asarray(light.diffuse) * light.intensity
    made.specular = np.asarray(light.specular) * light.intensity
    made.castshadow = light.cast_shadows
    made.active = light.on
    made.range = light.range
    made.attenuation = (light.constant, light.linear, light.quadratic)
    if light.kind == "spot" and light.outer_angle > 0.0:
        made.cutoff = min(90.0, math.degrees(light.outer_angle / 2.0))
        made.exponent = min(light.falloff, 128.0)
        made.softness = min(1.0, max(0.0, 1.0 - light.inner_angle / light.outer_angle))
