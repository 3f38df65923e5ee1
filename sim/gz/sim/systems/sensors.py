"""Sensors: runs the rendering sensors (lidars, cameras); a plugin of the world.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/sensors/Sensors.cc
"""

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
