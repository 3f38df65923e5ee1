"""The magnetic field of the earth by latitude and longitude: the World Magnetic Model at its epoch 2025.0.

Used by the magnetometer. The Gauss coefficients go up to degree 8; the higher degrees change the field by less than
half a degree and 0.25 [uT].

Source: NOAA and British Geological Survey, World Magnetic Model 2025 (public domain)
"""

from __future__ import annotations

import functools
import math

REFERENCE_RADIUS = 6371200.0
"""The radius [m] of the reference sphere of the coefficients."""
_DEGREE = 8
# Cosine and sine coefficients [nT]: degree 1 orders 0 and 1, degree 2 orders 0 to 2, ...
_COSINE = (
    (-29351.8, -1410.8),
    (-2556.6, 2951.1, 1649.3),
    (1361.0, -2404.1, 1243.8, 453.6),
    (895.0, 799.5, 55.7, -281.1, 12.1),
    (-233.2, 368.9, 187.2, -138.7, -142.0, 20.9),
    (64.4, 63.8, 76.9, -115.7, -40.9, 14.9, -60.7),
    (79.5, -77.0, -8.8, 59.3, 15.8, 2.5, -11.1, 14.2),
    (23.2, 10.8, -17.5, 2.0, -21.7, 16.9, 15.0, -16.8, 0.9),
)
_SINE = (
    (0.0, 4545.4),
    (0.0, -3133.6, -815.1),
    (0.0, -56.6, 237.5, -549.5),
    (0.0, 278.6, -133.9, 212.0, -375.6),
    (0.0, 45.4, 220.2, -122.9, 43.0, 106.1),
    (0.0, -18.4, 16.8, 48.8, -59.8, 10.9, 72.7),
    (0.0, -48.9, -14.4, -1.0, 23.4, -7.4, -25.1, -2.3),
    (0.0, 7.1, -12.6, 11.4, -9.7, 12.7, 0.7, -5.2, 3.9),
)


def earth_field(latitude_deg: float, longitude_deg: float) -> tuple[float, float, float]:
    """Return the field [T] north, east and down at sea level; angles are rounded to a thousandth of a degree."""
    return _field(round(latitude_deg, 3), round(longitude_deg, 3))


@functools.lru_cache(maxsize=256)
def _field(latitude_deg: float, longitude_deg: float) -> tuple[float, float, float]:
    # Geocentric latitude and radius of the point on the WGS84 ellipsoid.
    a, b = 6378137.0, 6356752.314245
    latitude = math.radians(max(-89.999, min(89.999, latitude_deg)))
    longitude = math.radians(longitude_deg)
    across, up = a * a * math.cos(latitude), b * b * math.sin(latitude)
    scale = math.hypot(a * math.cos(latitude), b * math.sin(latitude))
    geocentric, radius = math.atan2(up, across), math.hypot(across, up) / scale
    values, slopes = _legendre(math.pi / 2.0 - geocentric)
    north = east = down = 0.0
    for n in range(1, _DEGREE + 1):
        weight = (REFERENCE_RADIUS / radius) ** (n + 2)
        for m in range(n + 1):
            g, h = _COSINE[n - 1][m], _SINE[n - 1][m]
            c, s = math.cos(m * longitude), math.sin(m * longitude)
            north += weight * (g * c + h * s) * slopes[n][m]
            east += weight * m * (g * s - h * c) * values[n][m] / math.cos(geocentric)
            down -= weight * (n + 1) * (g * c + h * s) * values[n][m]
    tilt = geocentric - latitude
    c, s = math.cos(tilt), math.sin(tilt)
    return (north * c - down * s) * 1e-9, east * 1e-9, (north * s + down * c) * 1e-9


def _legendre(angle: float) -> tuple[list[list[float]], list[list[float]]]:
    """Return the Schmidt semi-normalized Legendre functions of cos(angle), [n][m], and their derivatives by the
    angle.
    """
    c, s = math.cos(angle), math.sin(angle)
    size = _DEGREE + 1
    values = [[0.0] * size for _ in range(size)]
    slopes = [[0.0] * size for _ in range(size)]
    values[0][0] = 1.0
    for n in range(1, size):
        factor = 1.0 if n == 1 else math.sqrt((2 * n - 1) / (2 * n))
        values[n][n] = factor * s * values[n - 1][n - 1]
        slopes[n][n] = factor * (c * values[n - 1][n - 1] + s * slopes[n - 1][n - 1])
        for m in range(n):
            below = math.sqrt((n - 1) ** 2 - m * m)
            root = math.sqrt(n * n - m * m)
            two = (values[n - 2][m], slopes[n - 2][m]) if n > 1 else (0.0, 0.0)
            values[n][m] = ((2 * n - 1) * c * values[n - 1][m] - below * two[0]) / root
            slopes[n][m] = ((2 * n - 1) * (c * slopes[n - 1][m] - s * values[n - 1][m]) - below * two[1]) / root
    return values, slopes
