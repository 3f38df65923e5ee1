"""AirSpeed: runs the air speed sensors of the world; a plugin of the world.

What is common to all systems that run sensors is in `gz.sim.systems.sensor_system`.
"""

from __future__ import annotations

from gz_course.sim.gz.sim.systems.registry import system
from gz_course.sim.gz.sim.systems.sensor_system import SensorSystem


@system("AirSpeed", "gz-sim-air-speed-system")
class AirSpeed(SensorSystem):
    """Runs every sensor of type air_speed."""
