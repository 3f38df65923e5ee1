"""Sensors: runs the rendering sensors (lidars, cameras); a plugin of the world."""

from __future__ import annotations

from gz_course.sim.gz.sim.plugins.sensor_system import SensorSystem
from gz_course.sim.gz.sim.plugins.system import system


@system("Sensors", "gz-sim-sensors-system")
class Sensors(SensorSystem):
    """Runs every rendering sensor of the world."""

    parameters = frozenset(
        (
            "render_engine",
            "background_color",
            "ambient_light",
            "disable_on_drained_battery",
            "render_engine_api_backend",
        )
    )
