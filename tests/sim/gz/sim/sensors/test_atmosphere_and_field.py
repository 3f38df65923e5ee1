"""Altimeter, air pressure, air speed and magnetometer against tables of the standard atmosphere and geometry."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.pose import matrix, quaternion_from_rpy
from gz_course.sim.gz.sim.sensors.air_pressure import standard_pressure
from gz_course.sim.gz.sim.sensors.magnetometer import Magnetometer

from .conftest import inertial, sensor_world, sensors_of

Listen = Callable[..., list[Any]]
GAUSSIAN = "<noise type='gaussian'><mean>0</mean><stddev>{}</stddev></noise>"


def model(kind: str, inside: str = "", pose: str = "0 0 5 0 0 0", extra: str = "") -> str:
    sensor = f"<sensor name='s' type='{kind}'><pose>0.5 0 0.25 0 0 0</pose>{inside}</sensor>"
    return f"<model name='m'>{extra}<pose>{pose}</pose><link name='l'>{inertial()}{sensor}</link></model>"


def topic(kind: str) -> str:
    return f"/world/w/model/m/link/l/sensor/s/{kind}"


def test_altimeter_counts_from_where_it_began(listen: Listen) -> None:
    world = sensor_world(model("altimeter"), "Altimeter")
    heard = listen(world, topic("altimeter"), "gz.msgs.Altimeter")
    # Thrown upwards and rotating about y: the sensor, half a metre ahead, moves down with the rotation.
    world.data.qvel[:] = (0, 0, 2, 0, 1, 0)
    world.step(100)
    last = heard[-1]
    assert last.vertical_reference == 5.25
    height = 2 * 0.1 - 4.9 * 0.1**2 - 0.5 * np.sin(0.1) + 0.25 * (np.cos(0.1) - 1)
    assert last.vertical_position == pytest.approx(height, abs=1e-3)
    assert last.vertical_velocity == pytest.approx(2 - 0.98 - 0.5 * np.cos(0.1) - 0.25 * np.sin(0.1), abs=1e-3)


def test_altimeter_noise(listen: Listen) -> None:
    parts = (
        f"<altimeter><vertical_position>{GAUSSIAN.format(0.1)}</vertical_position>"
        f"<vertical_velocity>{GAUSSIAN.format(0.02)}</vertical_velocity></altimeter>"
    )
    world = sensor_world(model("altimeter", parts, extra="<static>1</static>"), "Altimeter")
    heard = listen(world, topic("altimeter"), "gz.msgs.Altimeter")
    world.step(2000)
    values = np.array([(message.vertical_position, message.vertical_velocity) for message in heard])
    assert values.std(axis=0) == pytest.approx((0.1, 0.02), rel=0.06)
    assert values.mean(axis=0) == pytest.approx((0, 0), abs=0.01)


def test_a_reset_takes_the_reference_anew(listen: Listen) -> None:
    world = sensor_world(model("altimeter"), "Altimeter")
    heard = listen(world, topic("altimeter"), "gz.msgs.Altimeter")
    world.step(300)
    world.reset()
    world.step(1)
    assert heard[-1].vertical_reference == 5.25 and abs(heard[-1].vertical_position) < 1e-4


@pytest.mark.parametrize(
    ("height", "pressure"),
    # U.S. Standard Atmosphere 1976, geometric height (m) and pressure (Pa).
    [(0, 101325), (1000, 89876), (2000, 79501), (3000, 70121), (5000, 54048), (8000, 35652), (-500, 107477)],
)
def test_pressure_is_that_of_the_standard_atmosphere(height: float, pressure: float) -> None:
    assert standard_pressure(height) == pytest.approx(pressure, rel=3e-5)


def test_pressure_is_finite_wherever_a_robot_may_fly_to() -> None:
    values = [standard_pressure(height) for height in (-6e6, -1e4, 11e3, 44e3, 1e5, 1e9)]
    assert np.isfinite(values).all() and values == sorted(values, reverse=True)


def test_air_pressure_message(listen: Listen) -> None:
    noisy = f"<air_pressure><pressure>{GAUSSIAN.format(4)}</pressure></air_pressure>"
    high = "0 0 999.75 0 0 0"
    world = sensor_world(model("air_pressure", noisy, high, "<static>1</static>"), "AirPressure")
    heard = listen(world, topic("air_pressure"), "gz.msgs.FluidPressure")
    world.step(2000)
    values = np.array([message.pressure for message in heard])
    assert values.mean() == pytest.approx(89876, abs=1) and values.std() == pytest.approx(4, rel=0.06)
    # Gazebo's variance is the square root of the deviation.
    assert heard[0].variance == 2.0 and heard[0].header.data[0].value[0] == "m::l::s"


def test_reference_altitude_has_no_effect_and_says_so(listen: Listen) -> None:
    reference = "<air_pressure><reference_altitude>123</reference_altitude></air_pressure>"
    world = sensor_world(model("air_pressure", reference, "0 0 -0.25 0 0 0", "<static>1</static>"), "AirPressure")
    heard = listen(world, topic("air_pressure"), "gz.msgs.FluidPressure")
    world.step(1)
    assert heard[0].pressure == 101325.0 and heard[0].variance == 0.0
    assert len(world.warnings) == 1 and "<reference_altitude> has no effect" in world.warnings[0]


@pytest.mark.parametrize(("speed", "height", "density"), [(20, 0, 1.225), (-20, 0, 1.225), (30, 2000, 1.0066)])
def test_air_speed_is_the_dynamic_pressure_from_ahead(
    listen: Listen, speed: float, height: float, density: float
) -> None:
    world = sensor_world(model("air_speed", pose=f"0 0 {height - 0.25} 0 0 2"), "AirSpeed")
    heard = listen(world, topic("air_speed"), "gz.msgs.AirSpeed")
    world.data.qvel[:] = (speed * np.cos(2), speed * np.sin(2), 0, 0, 0, 0)
    world.step(1)
    assert heard[0].diff_pressure == pytest.approx(0.5 * density * speed * abs(speed), rel=3e-4)
    assert heard[0].temperature == pytest.approx(288.15 - 0.0065 * height, abs=1e-3)


def test_air_speed_noise_is_in_hectopascals(listen: Listen) -> None:
    noisy = f"<air_speed><pressure>{GAUSSIAN.format(0.02)}</pressure></air_speed>"
    world = sensor_world(model("air_speed", noisy, extra="<static>1</static>"), "AirSpeed")
    heard = listen(world, topic("air_speed"), "gz.msgs.AirSpeed")
    world.step(2000)
    assert np.std([message.diff_pressure for message in heard]) == pytest.approx(2, rel=0.06)


@settings(max_examples=15, deadline=None)
@given(st.tuples(*[st.floats(-3.1, 3.1)] * 3))
def test_the_field_is_seen_from_the_sensor(rpy: tuple[float, float, float]) -> None:
    pose = "0 0 0 {} {} {}".format(*map(repr, rpy))
    field = "<magnetic_field>1e-5 2e-5 -4e-5</magnetic_field>"
    world = sensor_world(field + model("magnetometer", pose=pose), "Magnetometer")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Magnetometer)
    message = _message()
    sensor.fill(message)
    seen = (message.field_tesla.x, message.field_tesla.y, message.field_tesla.z)
    assert seen == pytest.approx(matrix(quaternion_from_rpy(*rpy)).T @ (1e-5, 2e-5, -4e-5), abs=1e-12)


def _message() -> Any:
    from gz_course.sim.gz.msgs.magnetometer_pb2 import Magnetometer as Message

    return Message()


def test_magnetometer_message_and_noise(listen: Listen) -> None:
    noise = f"<magnetometer><x>{GAUSSIAN.format(1e-6)}</x></magnetometer>"
    world = sensor_world(model("magnetometer", noise, extra="<static>1</static>"), "Magnetometer")
    heard = listen(world, topic("magnetometer"), "gz.msgs.Magnetometer")
    world.step(2000)
    values = np.array([(m.field_tesla.x, m.field_tesla.y, m.field_tesla.z) for m in heard])
    # The default field of SDF.
    assert values.mean(axis=0) == pytest.approx((5.5645e-6, 22.8758e-6, -42.3884e-6), abs=1e-7)
    assert values.std(axis=0) == pytest.approx((1e-6, 0, 0), rel=0.06, abs=1e-12)


ON_EARTH = (
    "<spherical_coordinates><latitude_deg>50</latitude_deg><longitude_deg>10</longitude_deg></spherical_coordinates>"
)
NORTH, EAST, DOWN = 20072e-9, 1347e-9, 44690e-9


@pytest.mark.parametrize(
    ("parameters", "expected"),
    [
        ("", (NORTH * 1e4, EAST * 1e4, DOWN * 1e4)),
        ("<use_units_gauss>0</use_units_gauss>", (NORTH, EAST, DOWN)),
        ("<use_units_gauss>0</use_units_gauss><use_earth_frame_ned>0</use_earth_frame_ned>", (EAST, NORTH, -DOWN)),
    ],
)
def test_on_earth_the_field_is_that_of_the_place(
    listen: Listen, parameters: str, expected: tuple[float, float, float]
) -> None:
    plugin = (
        f"<plugin filename='gz-sim-magnetometer-system' name='gz::sim::systems::Magnetometer'>{parameters}</plugin>"
    )
    world = sensor_world(ON_EARTH + plugin + model("magnetometer", extra="<static>1</static>"))
    heard = listen(world, topic("magnetometer"), "gz.msgs.Magnetometer")
    world.step(1)
    field = heard[0].field_tesla
    assert (field.x, field.y, field.z) == pytest.approx(expected, rel=2e-3)


def test_a_field_that_is_not_finite_is_refused() -> None:
    with pytest.raises(SdfError, match="<magnetic_field> must be finite"):
        sensor_world("<magnetic_field>0 inf 0</magnetic_field>", "Magnetometer")
