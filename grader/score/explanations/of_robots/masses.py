"""Masses of links that no small robot has."""

from __future__ import annotations

from gz_course.grader.score.robots import Robot

HEAVIEST = 300.0  # [kg] of a link: a robot of that size made of steel is lighter
LIGHTEST = 1e-3  # [kg] of a link that can collide


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
