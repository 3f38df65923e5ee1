"""NavSat (GPS): latitude, longitude, altitude and velocity, as `gz.msgs.NavSat`.

The NavSat system runs it. The world's `<spherical_coordinates>` define its place on the earth.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/NavSatSensor.cc
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "sensor": "navsat gps",
    "navsat": "position_sensing velocity_sensing",
    "gps": "position_sensing velocity_sensing",
    "position_sensing": "horizontal vertical",
    "velocity_sensing": "horizontal vertical",
    "horizontal": "noise",
    "vertical": "noise",
}

SUSPICIOUS_DEGREES = 0.01
"""Standard deviation [deg] of the horizontal position (1.1 km) from which on it is probably in metres."""


@sensor_type("navsat", "gps")
class NavSat(SiteSensor):
    """A satellite navigation receiver; velocities are along the world's x, y and z even if the world has a heading, as
    in Gazebo.
    """

    runs_in = sensor_system("NavSat", "gz-sim-navsat-system")
    suffix = "navsat"
    message_type = "gz.msgs.NavSat"

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read `<navsat>` or `<gps>`; warns if the world has no place on the earth, and about noise that seems to be in
        metres.
        """
        super().__init__(world, description)
        where, name = description.element.where, description.name
        if world.description.spherical_coordinates is None:
            text = f"sensor '{name}' reports zeros because the world has no <spherical_coordinates>"
            world.diagnostics.warn(where, text)
        stddev = self.read_noises(description.element)[0][1].stddev
        if stddev >= SUSPICIOUS_DEGREES:
            text = f"the noise of the horizontal position is in degrees, as in Gazebo: {stddev:g} degrees of latitude"
            world.diagnostics.warn(where, f"{text} are {stddev * 111.0:.3g} km (sensor '{name}')")

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noises of latitude and longitude [deg], altitude [m], and velocity east, north, up [m/s]."""
        holder = "navsat" if element.find("navsat") is not None else "gps"
        across, up = (noise_at(element, f"{holder}/position_sensing/{side}") for side in ("horizontal", "vertical"))
        fast, rising = (noise_at(element, f"{holder}/velocity_sensing/{side}") for side in ("horizontal", "vertical"))
        # Latitude and longitude share one bias, east and north another.
        position = [("horizontal position", across)] * 2 + [("vertical position", up)]
        return [*position, *[("horizontal velocity", fast)] * 2, ("vertical velocity", rising)]

    def fill_header(self, header: Any, now_ns: int) -> None:
        """Write stamp and sequence number; the frame is a field of the message itself."""
        super().fill_header(header, now_ns)
        del header.data[0]

    def fill(self, message: Any) -> None:
        message.frame_id = self.frame_id
        measured = np.zeros(6)
        coordinates = self.world.description.spherical_coordinates
        if coordinates is not None:
            measured[:3] = coordinates.spherical(self.motion.position())
            measured[3:], _ = self.motion.velocity(local=False)
        latitude, longitude, altitude, east, north, up = self.noise.apply(measured.tolist())
        message.latitude_deg = _wrapped(latitude)
        message.longitude_deg = _wrapped(longitude)
        message.altitude = altitude
        message.velocity_east, message.velocity_north, message.velocity_up = east, north, up


def _wrapped(degrees: float) -> float:
    """Return an angle wrapped to -180..180 [deg]."""
    return degrees if abs(degrees) <= 180.0 else (degrees + 180.0) % 360.0 - 180.0
