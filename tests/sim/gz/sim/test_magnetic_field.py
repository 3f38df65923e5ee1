"""The earth's field against the World Magnetic Model, its maps, and properties of a potential field."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.magnetic_field import earth_field


@pytest.mark.parametrize(
    ("place", "declination", "inclination", "microtesla"),
    # Maps of the model: declination and inclination in degrees.
    [
        ((50, 10), 3.8, 65.8, 49.0),
        ((0, 0), -4.0, -30.4, 31.9),
        ((-30, 150), 11.0, -60.8, 55.1),
        ((40, -100), 4.6, 66.8, 52.0),
        ((80, 0), 1.3, 83.2, 55.2),
        ((0, 120), -0.2, -14.9, 41.1),
        ((-80, -120), 68.8, -72.0, 54.7),
    ],
)
def test_maps(place: tuple[float, float], declination: float, inclination: float, microtesla: float) -> None:
    north, east, down = earth_field(*place)
    across = math.hypot(north, east)
    assert math.degrees(math.atan2(east, north)) == pytest.approx(declination, abs=0.4)
    assert math.degrees(math.atan2(down, across)) == pytest.approx(inclination, abs=0.4)
    assert math.hypot(across, down) * 1e6 == pytest.approx(microtesla, abs=0.3)


@given(st.floats(-90, 90), st.floats(-180, 180))
def test_strength_is_that_of_the_earth_everywhere(latitude: float, longitude: float) -> None:
    field = earth_field(latitude, longitude)
    assert 22e-6 < math.sqrt(sum(part * part for part in field)) < 67e-6
    for mine, other in zip(field, earth_field(latitude, longitude + 360), strict=True):
        assert mine == pytest.approx(other, abs=1e-9)


@given(st.floats(-80, 80))
def test_no_current_flows_through_the_surface(latitude: float) -> None:
    """The field is a gradient: the sum of its east component along a parallel is zero."""
    steps = [earth_field(latitude, float(longitude))[1] for longitude in range(0, 360, 5)]
    assert sum(steps) / len(steps) == pytest.approx(0, abs=1e-12)
