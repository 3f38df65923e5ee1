"""The place of a world on a planet (`<spherical_coordinates>`), and conversions between metres, latitude and longitude.

NavSat, Magnetometer and the IMU use it. The world's axes are east, north, up at the origin, rotated by `heading_deg`
about up. The conversion on the ellipsoid goes through planet-centred (ECEF) coordinates.

Source: https://gssc.esa.int/navipedia, "Ellipsoidal and Cartesian Coordinates Conversion" and "Transformations between
ECEF and ENU coordinates"
Source: National Geospatial-Intelligence Agency, World Geodetic System 1984 (NGA.STND.0036)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.pose import Vector
from gz_course.sim.gz.sim.sdf.element import Element

SURFACES = {
    "EARTH_WGS84": (6378137.0, 6356752.314245),
    "MOON_SCS": (1738100.0, 1736000.0),
    "CUSTOM_SURFACE": (0.0, 0.0),
}
"""Equatorial and polar semi-axes [m] of Gazebo's surface models; those of a custom surface are parameters."""


@dataclass(frozen=True)
class SphericalCoordinates:
    """Latitude, longitude [deg] and elevation [m] of the world's origin; `heading_deg` [deg] is the angle from east to
    the x axis, counter-clockwise.
    """

    surface_model: str = "EARTH_WGS84"
    latitude_deg: float = 0.0
    longitude_deg: float = 0.0
    elevation: float = 0.0
    heading_deg: float = 0.0
    surface_axis_equatorial: float = SURFACES["EARTH_WGS84"][0]
    surface_axis_polar: float = SURFACES["EARTH_WGS84"][1]

    @classmethod
    def from_sdf(cls, element: Element | None, diagnostics: Diagnostics) -> SphericalCoordinates | None:
        """Read `<spherical_coordinates>`; None if there is none.

        Raises SdfError for an unknown surface, axes that are not positive and angles that are not finite.
        """
        if element is None:
            return None
        surface = element.text_of("surface_model", "EARTH_WGS84")
        if surface not in SURFACES:
            hint = did_you_mean(surface, SURFACES, listing="surfaces are")
            raise element.error(f"<surface_model> '{surface}' is not known{hint}")
        equatorial, polar = SURFACES[surface]
        if surface == "CUSTOM_SURFACE":
            equatorial = element.number("surface_axis_equatorial", 0.0)
            polar = element.number("surface_axis_polar", 0.0)
            if not (0.0 < equatorial < math.inf and 0.0 < polar < math.inf):
                raise element.error(
                    "a CUSTOM_SURFACE needs <surface_axis_equatorial> and <surface_axis_polar> above zero, "
                    f"got {equatorial} and {polar}"
                )
        frame = element.text_of("world_frame_orientation", "ENU")
        if frame != "ENU":
            diagnostics.warn(element.where, f"<world_frame_orientation> '{frame}' is not known, ENU is used")
        tags = ("latitude_deg", "longitude_deg", "elevation", "heading_deg")
        latitude, longitude, elevation, heading = (element.number(tag, 0.0) for tag in tags)
        if not all(map(math.isfinite, (latitude, longitude, elevation, heading))):
            raise element.error("the numbers of <spherical_coordinates> must be finite")
        return cls(surface, latitude, longitude, elevation, heading, equatorial, polar)

    def spherical(self, position: Vector) -> tuple[float, float, float]:
        """Return latitude, longitude [deg] and elevation [m] of a point (3,) [m] in the world frame.

        Bowring's formula is exact to 1e-11 [rad] within kilometres of the surface.
        Source: B. R. Bowring, Transformation from spatial to geographical coordinates, Survey Review 23 (181), 1976
        """
        x, y, z = self._origin() + self._east_north_up() @ (self._heading() @ position)
        a, b = self.surface_axis_equatorial, self.surface_axis_polar
        across = math.hypot(x, y)
        theta = math.atan2(z * a, across * b)
        flat = 1.0 - b * b / (a * a)
        latitude = math.atan2(
            z + (a * a / (b * b) - 1.0) * b * math.sin(theta) ** 3, across - flat * a * math.cos(theta) ** 3
        )
        sine, cosine = math.sin(latitude), math.cos(latitude)
        elevation = across * cosine + z * sine - a * math.sqrt(1.0 - flat * sine * sine)
        return math.degrees(latitude), math.degrees(math.atan2(y, x)), elevation

    def local(self, latitude_deg: float, longitude_deg: float, elevation: float) -> Vector:
        """Return the point (3,) [m] in the world frame at a latitude, longitude [deg] and elevation [m]."""
        away = self._ecef(latitude_deg, longitude_deg, elevation) - self._origin()
        found: Vector = self._heading().T @ (self._east_north_up().T @ away)
        return found

    def _origin(self) -> Vector:
        return self._ecef(self.latitude_deg, self.longitude_deg, self.elevation)

    def _ecef(self, latitude_deg: float, longitude_deg: float, elevation: float) -> Vector:
        a, b = self.surface_axis_equatorial, self.surface_axis_polar
        latitude, longitude = math.radians(latitude_deg), math.radians(longitude_deg)
        ratio = b * b / (a * a)
        curvature = a / math.sqrt(1.0 - (1.0 - ratio) * math.sin(latitude) ** 2)
        across = (curvature + elevation) * math.cos(latitude)
        up = (ratio * curvature + elevation) * math.sin(latitude)
        return np.array((across * math.cos(longitude), across * math.sin(longitude), up))

    def _east_north_up(self) -> NDArray[np.float64]:
        """Return the matrix (3, 3) whose columns are east, north and up at the origin in ECEF axes."""
        latitude, longitude = math.radians(self.latitude_deg), math.radians(self.longitude_deg)
        sp, cp, sl, cl = math.sin(latitude), math.cos(latitude), math.sin(longitude), math.cos(longitude)
        return np.array(((-sl, -cl * sp, cl * cp), (cl, -sl * sp, sl * cp), (0.0, cp, sp)))

    def _heading(self) -> NDArray[np.float64]:
        """Return the matrix (3, 3) that rotates the world's axes into east, north and up."""
        c, s = math.cos(math.radians(self.heading_deg)), math.sin(math.radians(self.heading_deg))
        return np.array(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)))
