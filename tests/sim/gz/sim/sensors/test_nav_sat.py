"""NavSat: position, velocity, message fields, noise."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.sim.spherical_coordinates import SphericalCoordinates

from .conftest import inertial, sensor_world

Listen = Callable[..., list[Any]]
TOPIC = "/world/w/model/m/link/l/sensor/s/navsat"
PLACE = (
    "<spherical_coordinates><latitude_deg>48.1</latitude_deg><longitude_deg>11.6</longitude_deg>"
    "<elevation>520</elevation><heading_deg>{}</heading_deg></spherical_coordinates>"
)


def model(inside: str = "", kind: str = "navsat", pose: str = "100 50 5 0 0 1", extra: str = "") -> str:
    sensor = f"<sensor name='s' type='{kind}'><pose>0.5 0 0 0 0 0</pose>{inside}</sensor>"
    return f"<model name='m'>{extra}<pose>{pose}</pose><link name='l'>{inertial()}{sensor}</link></model>"


@pytest.mark.parametrize("kind", ["navsat", "gps"])
def test_position_and_velocity(listen: Listen, kind: str) -> None:
    world = sensor_world(PLACE.format(0) + model(kind=kind), "NavSat")
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.data.qvel[:] = (3, 4, 9.8 * 0.001, 0, 0, 2)
    world.step(1)
    (fix,) = heard
    at = np.array((100 + 0.5 * np.cos(1.002) + 0.003, 50 + 0.5 * np.sin(1.002) + 0.004, 5))
    expected = SphericalCoordinates(latitude_deg=48.1, longitude_deg=11.6, elevation=520).spherical(at)
    assert (fix.latitude_deg, fix.longitude_deg) == pytest.approx(expected[:2], abs=1e-11)
    assert fix.altitude == pytest.approx(expected[2], abs=1e-4)
    # The sensor is 0.5 m ahead of the centre of a body that rotates with 2 rad/s.
    assert fix.velocity_east == pytest.approx(3 - np.sin(1.002), abs=1e-3)
    assert fix.velocity_north == pytest.approx(4 + np.cos(1.002), abs=1e-3)
    assert fix.velocity_up == pytest.approx(0, abs=1e-6)
    assert fix.frame_id == "m::l::s" and [each.key for each in fix.header.data] == ["seq"]


def test_the_heading_of_the_world_turns_positions_but_not_velocities(listen: Listen) -> None:
    """As in Gazebo: with a heading of 90 degrees the world's x axis points north."""
    world = sensor_world(PLACE.format(90) + model(pose="99.5 0 0 0 0 0"), "NavSat")
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.data.qvel[0] = 3
    world.step(1)
    assert heard[0].longitude_deg == pytest.approx(11.6, abs=1e-7)
    assert heard[0].latitude_deg == pytest.approx(48.1 + 100 / 111_200, abs=1e-5)
    assert heard[0].velocity_east == pytest.approx(3)


def test_a_world_that_lies_nowhere_is_warned_about(listen: Listen) -> None:
    world = sensor_world(model(), "NavSat")
    assert "has no <spherical_coordinates>" in world.warnings[0] and len(world.warnings) == 1
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.step(1)
    assert (heard[0].latitude_deg, heard[0].altitude, heard[0].velocity_up) == (0, 0, 0)


def noise(across: float, up: float, fast: float = 0.0, rising: float = 0.0) -> str:
    def sides(tag: str, horizontal: float, vertical: float) -> str:
        gaussian = "<noise type='gaussian'><stddev>{}</stddev><bias_mean>{}</bias_mean></noise>"
        both = (("horizontal", horizontal), ("vertical", vertical))
        return f"<{tag}>{''.join(f'<{side}>{gaussian.format(n, 10 * n)}</{side}>' for side, n in both)}</{tag}>"

    return f"<navsat>{sides('position_sensing', across, up)}{sides('velocity_sensing', fast, rising)}</navsat>"


def test_noise_across_and_up(listen: Listen) -> None:
    parts = noise(1e-5, 0.5, 0.2, 0.3)
    world = sensor_world(PLACE.format(0) + model(parts, pose="-0.5 0 0 0 0 0", extra="<static>1</static>"), "NavSat")
    assert world.warnings == []
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.step(2000)
    fields = ("latitude_deg", "longitude_deg", "altitude", "velocity_east", "velocity_north", "velocity_up")
    values = np.array([[getattr(fix, name) for name in fields] for fix in heard]) - (48.1, 11.6, 520, 0, 0, 0)
    deviations = np.array((1e-5, 1e-5, 0.5, 0.2, 0.2, 0.3))
    assert values.std(axis=0) == pytest.approx(deviations, rel=0.06)
    bias = values.mean(axis=0)
    assert np.abs(bias) == pytest.approx(10 * deviations, rel=0.05)
    # Latitude and longitude have one bias, east and north as well.
    assert np.sign(bias[0]) == np.sign(bias[1]) and np.sign(bias[3]) == np.sign(bias[4])


@pytest.mark.parametrize("seed", range(4))
def test_latitude_and_longitude_have_one_bias_whatever_the_seed(listen: Listen, seed: int) -> None:
    still = noise(1e-5, 0, 1).replace("<stddev>1e-05", "<stddev>0").replace("<stddev>1<", "<stddev>0<")
    place = PLACE.format(0) + model(still, pose="-0.5 0 0 0 0 0", extra="<static>1</static>")
    world = sensor_world(place, "NavSat", seed=seed)
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.step(1)
    away = heard[0].latitude_deg - 48.1
    assert abs(away) == pytest.approx(1e-4) and heard[0].longitude_deg - 11.6 == pytest.approx(away)
    assert abs(heard[0].velocity_east) == 10 and heard[0].velocity_north == heard[0].velocity_east


def test_noise_that_was_meant_in_metres_is_warned_about() -> None:
    world = sensor_world(PLACE.format(0) + model(noise(0.5, 0.5)), "NavSat")
    (warning,) = world.warnings
    assert "in degrees" in warning and "55.5 km" in warning


def test_longitudes_go_round(listen: Listen) -> None:
    far = "<horizontal><noise type='gaussian'><mean>170</mean></noise></horizontal>"
    bias = f"<navsat><position_sensing>{far}</position_sensing></navsat>"
    world = sensor_world(PLACE.format(0) + model(bias), "NavSat")
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.step(1)
    assert heard[0].longitude_deg == pytest.approx(11.6 + 170 - 360, abs=0.01)


def test_the_place_may_change_while_it_runs(listen: Listen) -> None:
    world = sensor_world(PLACE.format(0) + model(), "NavSat")
    heard = listen(world, TOPIC, "gz.msgs.NavSat")
    world.step(1)
    world.editor.set_spherical_coordinates(SphericalCoordinates(latitude_deg=-30))
    world.step(1)
    assert heard[1].latitude_deg == pytest.approx(-30, abs=0.01)
