"""Worlds in which joints and models are driven: a fixed arm, a floating box, plugins in short form."""

from __future__ import annotations

from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.world import World


def plugin(name: str, inside: str = "") -> str:
    """Return a <plugin> of one of our systems."""
    filename = "gz-sim-physics-system" if name == "Physics" else systems()[name].filename
    return f"<plugin filename='{filename}' name='gz::sim::systems::{name}'>{inside}</plugin>"


def link(name: str, pose: str, centre: str = "0 0 0", mass: float = 1.0) -> str:
    return f"""<link name='{name}'><pose>{pose}</pose><inertial><pose>{centre} 0 0 0</pose><mass>{mass}</mass>
      <inertia><ixx>0.01</ixx><iyy>0.08</iyy><izz>0.08</izz></inertia></inertial></link>"""


def joint(name: str, kind: str, parent: str, child: str, axis: str = "<xyz>0 1 0</xyz>") -> str:
    return f"""<joint name='{name}' type='{kind}'><parent>{parent}</parent><child>{child}</child>
      <axis>{axis}</axis></joint>"""


def arm(plugins: str = "", shoulder: str = "", elbow: str = "", name: str = "arm") -> str:
    """Return two levers of 1 m about y, stretched along x from (0, 0, 1), under gravity."""
    return f"""<model name='{name}'>{link("base", "0 0 0 0 0 0")}{joint("fix", "fixed", "world", "base")}
      {link("upper", "0 0 1 0 0 0", "0.5 0 0")}
      {joint("shoulder", "revolute", "base", "upper", "<xyz>0 1 0</xyz>" + shoulder)}
      {link("lower", "1 0 1 0 0 0", "0.5 0 0", 0.5)}
      {joint("elbow", "revolute", "upper", "lower", "<xyz>0 1 0</xyz>" + elbow)}{plugins}</model>"""


def world(inside: str, *, step: float = 0.001, seed: int = 0, gravity: str = "0 0 -9.8") -> World:
    """Return a world of models, with the Physics system."""
    text = f"""<sdf version='1.10'><world name='w'><gravity>{gravity}</gravity>
      <physics type='x'><max_step_size>{step}</max_step_size></physics>{plugin("Physics")}{inside}</world></sdf>"""
    return World.from_string(text, seed=seed, file_name="motion.sdf")
