"""Metres to latitude and longitude and back, against radii of curvature and the inverse; invalid input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.spherical_coordinates import SphericalCoordinates

A, B = 6378137.0, 6356752.314245
E2 = 1 - (B / A) ** 2
places = st.builds(
    SphericalCoordinates,
    latitude_deg=st.floats(-89, 89),
    longitude_deg=st.floats(-179, 179),
    elevation=st.floats(-100, 5000),
    heading_deg=st.floats(-180, 180),
)
metres = st.floats(-2000, 2000)


@given(places, metres, metres, metres)
def test_there_and_back(place: SphericalCoordinates, x: float, y: float, z: float) -> None:
    assert place.local(*place.spherical(np.array((x, y, z)))) == pytest.approx((x, y, z), abs=1e-5)


@given(places)
def test_the_origin_is_where_the_file_says(place: SphericalCoordinates) -> None:
    latitude, longitude, elevation = place.spherical(np.zeros(3))
    assert (latitude, longitude) == pytest.approx((place.latitude_deg, place.longitude_deg), abs=1e-9)
    assert elevation == pytest.approx(place.elevation, abs=1e-6)


@given(st.floats(-80, 80), st.floats(-100, 3000), st.floats(-180, 180), st.floats(0, 2 * math.pi))
def test_a_metre_is_as_many_degrees_as_the_ellipsoid_says(
    latitude: float, elevation: float, heading: float, direction: float
) -> None:
    """One metre away: north by the radius of curvature of the meridian, east by that of the parallel."""
    place = SphericalCoordinates(latitude_deg=latitude, elevation=elevation, heading_deg=heading)
    east, north = math.cos(direction), math.sin(direction)
    # The world's x axis points `heading` to the left of east.
    turn = math.radians(heading)
    local = np.array(
        (east * math.cos(turn) + north * math.sin(turn), north * math.cos(turn) - east * math.sin(turn), 0)
    )
    found = place.spherical(local)
    sine = math.sin(math.radians(latitude))
    prime = A / math.sqrt(1 - E2 * sine**2)
    meridian = A * (1 - E2) / (1 - E2 * sine**2) ** 1.5
    assert math.radians(found[0] - latitude) * (meridian + elevation) == pytest.approx(north, abs=1e-4)
    across = (prime + elevation) * math.cos(math.radians(latitude))
    assert math.radians(found[1]) * across == pytest.approx(east, abs=1e-4)
    assert found[2] == pytest.approx(elevation, abs=1e-4)


def test_up_is_up() -> None:
    assert SphericalCoordinates(latitude_deg=40, longitude_deg=-70).spherical(np.array((0, 0, 123.0))) == pytest.approx(
        (40, -70, 123), abs=1e-6
    )


@pytest.mark.parametrize("latitude", [90.0, -90.0])
def test_the_poles_have_a_height_too(latitude: float) -> None:
    place = SphericalCoordinates(latitude_deg=latitude)
    found = place.spherical(np.array((0, 0, 50.0)))
    assert found[0] == pytest.approx(latitude) and found[2] == pytest.approx(50.0)


def test_reading() -> None:
    element = parse(
        "<spherical_coordinates><surface_model>MOON_SCS</surface_model><latitude_deg>-1.5</latitude_deg>"
        "<longitude_deg>30</longitude_deg><elevation>8</elevation><heading_deg>90</heading_deg></spherical_coordinates>"
    )
    place = SphericalCoordinates.from_sdf(element, Diagnostics())
    assert place == SphericalCoordinates("MOON_SCS", -1.5, 30.0, 8.0, 90.0, 1738100.0, 1736000.0)
    assert SphericalCoordinates.from_sdf(None, Diagnostics()) is None
    custom = element.find("surface_model")
    assert custom is not None
    custom.text = "CUSTOM_SURFACE"
    with pytest.raises(SdfError, match="needs <surface_axis_equatorial>"):
        SphericalCoordinates.from_sdf(element, Diagnostics())


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<surface_model>EARTH_WGS48</surface_model>", "did you mean 'EARTH_WGS84'"),
        ("<latitude_deg>inf</latitude_deg>", "must be finite"),
        ("<latitude_deg>48N</latitude_deg>", "needs a number"),
    ],
)
def test_bad_input_is_refused(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        SphericalCoordinates.from_sdf(parse(f"<spherical_coordinates>{inside}</spherical_coordinates>"), Diagnostics())


def test_another_orientation_than_enu_is_warned_about() -> None:
    diagnostics = Diagnostics()
    text = "<spherical_coordinates><world_frame_orientation>NED</world_frame_orientation></spherical_coordinates>"
    SphericalCoordinates.from_sdf(parse(text), diagnostics)
    assert "ENU is used" in diagnostics.warnings[0]
