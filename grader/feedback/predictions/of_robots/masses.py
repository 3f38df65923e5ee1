"""Masses of links that no small robot has."""

from __future__ import annotations

import math

from gz_course.grader.feedback.rules import guarded
from gz_course.grader.score.robots import Robot

HEAVIEST = 300.0  # [kg] of a link: a robot of that size made of steel is lighter
THIN = 80.0  # [kg/m^3] of a body as its largest box has it: a robot full of air, as of cardboard, has more
LIGHTEST = 1e-3  # [kg] of a link that can collide


@guarded("")
def odd_mass(robot: Robot) -> str:
    """Return the link whose mass is implausible; empty if there is none."""
    heavy = max(robot.links, key=lambda link: link.mass)
    if heavy.mass > HEAVIEST:
        grams = " (masses are in kg, not in g)" if heavy.mass < 1e6 else ""
        return f"link {heavy.name} has a mass of {heavy.mass:g} kg{grams}"
    light = min((link for link in robot.links if link.shapes), key=lambda link: link.mass, default=None)
    if light is not None and light.mass < LIGHTEST:
        return f"link {light.name} has a mass of {light.mass:g} kg"
    return ""


@guarded("")
def too_light(robot: Robot) -> str:
    """Return the link whose mass is too small for the size of its largest box; empty if there is none."""
    for link in robot.links:
        boxes = [shape for shape in link.shapes if shape.kind == "box"]
        size = max((tuple(map(float, box.size)) for box in boxes), key=math.prod, default=None)
        if size is not None and link.mass < THIN * math.prod(size):
            return (
                f"link {link.name} has a mass of {link.mass:g} kg, too little for a body of "
                f"{' x '.join(f'{each:g}' for each in size)} m: a link that is part of it has no <inertial>, or "
                "too small a mass"
            )
    return ""
