"""Logical camera: the models in the frustum, relative poses, the two topics; invalid input."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.sensors.logical_camera import LogicalCamera

from .conftest import inertial, sensor_world, sensors_of

Listen = Callable[..., list[Any]]
TOPIC = "/world/w/model/m/link/l/sensor/s/logical_camera"
CAMERA = (
    "<near>0.5</near><far>10</far><horizontal_fov>1.0471975511965976</horizontal_fov><aspect_ratio>2</aspect_ratio>"
)


def camera(inside: str = CAMERA) -> str:
    sensor = f"<sensor name='s' type='logical_camera'><logical_camera>{inside}</logical_camera></sensor>"
    return (
        "<model name='m'><static>1</static><pose>0 0 1 0 0 1.5707963267948966</pose>"
        f"<link name='l'>{sensor}</link></model>"
    )


def thing(name: str, pose: str) -> str:
    return f"<model name='{name}'><static>1</static><pose>{pose}</pose><link name='l'/></model>"


def test_models_in_view_are_told_by_name_and_pose(listen: Listen) -> None:
    # The camera looks along the world's y axis.
    things = thing("z", "0 3 1 0 0 0") + thing("a", "1 4 2 0 0 0.5") + thing("behind", "0 -3 1 0 0 0")
    world = sensor_world(things + camera() + thing("far", "0 10.1 1 0 0 0"), "LogicalCamera")
    heard = listen(world, TOPIC, "gz.msgs.LogicalCameraImage")
    world.step(1)
    (image,) = heard
    assert [model.name for model in image.model] == ["a", "z"]
    first = image.model[0].pose
    assert (first.position.x, first.position.y, first.position.z) == pytest.approx((4, -1, 1))
    assert 2 * math.atan2(first.orientation.z, first.orientation.w) == pytest.approx(0.5 - math.pi / 2)
    assert image.pose.position.z == 1 and image.header.data[0].value[0] == "m::l::s"


def test_moving_and_nested_models_are_seen_where_they_are(listen: Listen) -> None:
    body = f"<link name='l'>{inertial()}</link>"
    off = f"<link name='l'><pose>0 0 0.3 0 0 0</pose>{inertial()}</link>"
    nested = f"<model name='out'><pose>0 3 1 0 0 0</pose>{body}<model name='in'><pose>0 1 0 0 0 0</pose>{off}</model>"
    hold = "<joint name='j' type='fixed'><parent>l</parent><child>in::l</child></joint></model>"
    world = sensor_world(camera() + nested + hold, "LogicalCamera")
    heard = listen(world, TOPIC, "gz.msgs.LogicalCameraImage")
    world.step(200)
    fallen = -4.9 * 0.2**2
    seen = {model.name: model.pose.position for model in heard[-1].model}
    assert seen["out"].x == pytest.approx(3) and seen["in"].x == pytest.approx(4)
    assert seen["out"].z == pytest.approx(fallen, rel=0.01) and seen["in"].z == pytest.approx(fallen, rel=0.01)


def test_the_frustum_has_a_topic(listen: Listen) -> None:
    world = sensor_world(camera(), "LogicalCamera")
    heard = listen(world, f"{TOPIC}/frustum", "gz.msgs.LogicalCameraSensor")
    world.step(1)
    assert (heard[0].near_clip, heard[0].far_clip, heard[0].aspect_ratio) == (0.5, 10, 2)
    assert heard[0].horizontal_fov == pytest.approx(math.pi / 3)
    assert [each.key for each in heard[0].header.data] == ["frame_id"]


@settings(max_examples=100, deadline=None)
@given(st.floats(0.1, 12), st.floats(-0.7, 0.7), st.floats(-0.7, 0.7))
@example(2.0, 0.0, 0.4)
@example(2.0, 0.4, 0.0)
@example(2.0, -0.5, -0.27)
@example(10.1, 0.0, 0.0)
@example(0.4, 0.0, 0.0)
def test_the_frustum_is_that_of_its_angles(distance: float, azimuth: float, elevation: float) -> None:
    world = sensor_world(camera(), "LogicalCamera")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, LogicalCamera)
    point = (distance, distance * math.tan(azimuth), distance * math.tan(elevation))
    half_height = math.atan(math.tan(math.pi / 6) / 2)
    near_edge = min(abs(abs(azimuth) - math.pi / 6), abs(abs(elevation) - half_height)) < 1e-9
    inside = 0.5 <= distance <= 10 and abs(azimuth) <= math.pi / 6 and abs(elevation) <= half_height
    assert near_edge or sensor.contains(point) == inside  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (camera(CAMERA.replace("<far>10", "<far>0.1")), "0 <= near < far"),
        (camera(CAMERA.replace("1.047", "4.047")), "between 0 and pi"),
    ],
)
def test_an_impossible_frustum_leaves_the_sensor_out(text: str, sentence: str) -> None:
    world = sensor_world(text, "LogicalCamera")
    (warning,) = world.warnings
    assert sentence in warning and sensors_of(world) == []
    world.step()


def test_without_its_element_it_has_the_values_of_sdf() -> None:
    world = sensor_world(
        "<model name='m'><link name='l'><sensor name='s' type='logical_camera'/></link></model>", "LogicalCamera"
    )
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, LogicalCamera) and world.warnings == []
    assert (sensor.near, sensor.far, sensor.horizontal_fov, sensor.aspect_ratio) == (0.0, 1.0, 1.0, 1.0)
