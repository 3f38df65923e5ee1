"""Thermal camera: temperatures as numbers."""

from __future__ import annotations

import numpy as np
import pytest

from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.sensors.camera_rig import Load, eye, listen, sensor_of, thing

BOX = "<box><size>0.1 0.5 0.5</size></box>"


def warm(inside: str, name: str = "Thermal") -> str:
    file = {"Thermal": "gz-sim-thermal-system", "ThermalSensor": "gz-sim-thermal-sensor-system"}[name]
    return f"<plugin filename='{file}' name='gz::sim::systems::{name}'>{inside}</plugin>"


HOT = thing("hot", "3 1 1 0 0 0", BOX, more=warm("<temperature>310.5</temperature>"))
COLD = thing("cold", "3 -1 1 0 0 0", BOX, more=warm("<temperature>150</temperature>"))
LEFT, RIGHT = 32 - 15, 32 + 15


def test_each_pixel_is_a_temperature(load_text: Load, node: Node) -> None:
    world = load_text(
        HOT + COLD + thing("wall", "5 0 1 0 0 0", BOX) + eye(kind="thermal_camera", format="L16"), node=node
    )
    assert not world.warnings
    images = listen(node, Image, "/world/w/model/rig/link/l/sensor/eye/image")
    world.step(1)
    (image,) = images
    assert (image.pixel_format_type, image.step) == (2, 128)
    pixels = np.frombuffer(image.data, "<u2").reshape(48, 64)
    assert (pixels[24, LEFT], pixels[24, RIGHT]) == (31050, 15000)
    assert pixels[24, 32] == pixels[0, 0] == 28815, "what has no temperature has that of the air"


def test_eight_bits_range_resolution_and_atmosphere(load_text: Load) -> None:
    air = "<atmosphere type='adiabatic'><temperature>300</temperature></atmosphere>"
    camera = eye(kind="thermal", format="L8")
    image = sensor_of(load_text(air + HOT + camera)).image()
    assert (image.dtype, image[24, LEFT], image[24, 32]) == (np.uint8, 103, 100)
    limits = warm("<min_temp>200</min_temp><max_temp>305</max_temp><resolution>2.5</resolution>", "ThermalSensor")
    image = sensor_of(load_text(air + HOT + COLD + camera.replace("</camera>", f"</camera>{limits}"))).image()
    assert (image[24, LEFT], image[24, RIGHT], image[24, 32]) == (122, 80, 120)
    noise = "<noise><type>gaussian</type><mean>0</mean><stddev>2</stddev></noise>"
    image = sensor_of(load_text(eye(kind="thermal", format="L16", more=noise))).image()
    assert np.std(image * 0.01) == pytest.approx(2.0, rel=0.1)


def test_what_cannot_be_warm_is_said(load_text: Load) -> None:
    signature = warm("<heat_signature>body.png</heat_signature><min_temp>290</min_temp><max_temp>310</max_temp>")
    world = load_text(thing("man", "3 0 1 0 0 0", BOX, more=signature) + eye(kind="thermal", format="L16"))
    assert "<heat_signature> is not read" in world.warnings[0]
    assert sensor_of(world).image()[24, 32] == 30000
    assert "belongs inside a <visual>" in load_text(warm("<temperature>3</temperature>")).warnings[0]
    bad = warm("<resolution>0</resolution>", "ThermalSensor")
    world = load_text(eye(kind="thermal").replace("</camera>", f"</camera>{bad}"))
    (warning,) = world.warnings
    assert "a <resolution> greater than zero" in warning and "stays silent" in warning
