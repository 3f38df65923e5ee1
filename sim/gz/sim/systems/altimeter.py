"""Altimeter: runs the altimeters of the world; a plugin of the world.

What is common to all systems that run sensors is in `gz.sim.systems.sensor_system`.
"""

from __future__ import annotations

from gz_course.sim.gz.sim.systems.registry import system
from gz_course.sim.gz.sim.systems.sensor_system import SensorSystem


@system("Altimeter", "gz-sim-altimeter-system")
class Altimeter(SensorSystem):
    """Runs every sensor of type altimeter."""
