"""AirPressure: runs the air pressure sensors of the world; a plugin of the world.

What is common to all systems that run sensors is in `gz.sim.systems.sensor_system`.
"""

from __future__ import annotations

from gz_course.sim.gz.sim.systems.registry import system
from gz_course.sim.gz.sim.systems.sensor_system import SensorSystem


@system("AirPressure", "gz-sim-air-pressure-system")
class AirPressure(SensorSystem):
    """Runs every sensor of type air_pressure."""
