"""Wide angle camera: where its lenses show what is at an angle to the axis."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.camera_info_pb2 import CameraInfo
from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.sensors.camera_rig import Load, eye, listen, sensor_of, thing

BALL = "<sphere><radius>0.15</radius></sphere>"
LIGHT = "<scene><ambient>1 1 1 1</ambient><background>0 0 1 1</background></scene>"


def lens(inside: str, **changes: Any) -> str:
    return eye(kind="wideanglecamera", width=128, height=128, more=f"<lens>{inside}</lens>", **changes)


def ball(angle: float) -> str:
    """Return a red ball 3 m away, to the left of the axis by an angle [rad]."""
    return thing("ball", f"{3 * math.cos(angle)} {3 * math.sin(angle)} 1 0 0 0", BALL)


def shown_at(image: Any) -> tuple[float, float]:
    """Return the middle of the red pixels: left of and above the middle of the image, in half widths."""
    rows, columns = np.nonzero((image[..., 0] > 100) & (image[..., 2] < 50))
    return 1 - (columns.mean() + 0.5) / 64, 1 - (rows.mean() + 0.5) / 64


@pytest.mark.parametrize(
    ("kind", "angle", "place"),
    [
        ("equidistant", 1.3, 1.3 / 1.5),
        ("stereographic", 1.3, math.tan(0.65) / math.tan(0.75)),
        ("equisolid_angle", 1.3, math.sin(0.65) / math.sin(0.75)),
        ("orthographic", 0.8, math.sin(0.8) / math.sin(1.5)),
        ("gnomonical", 1.2, math.tan(1.2) / math.tan(1.5)),
    ],
)
def test_lenses_show_an_angle_at_their_radius(load_text: Load, kind: str, angle: float, place: float) -> None:
    world = load_text(LIGHT + ball(angle) + lens(f"<type>{kind}</type>", fov=3.0))
    assert not world.warnings
    left, up = shown_at(sensor_of(world).image())
    assert (left, up) == pytest.approx((place, 0.0), abs=0.03)


def test_a_lens_sees_behind_itself_and_is_black_beyond_the_cutoff(load_text: Load, node: Node) -> None:
    wide = "<type>equidistant</type><cutoff_angle>2.2</cutoff_angle>"
    world = load_text(LIGHT + ball(2.0) + lens(wide, fov=5.0), node=node)
    images = listen(node, Image, "/world/w/model/rig/link/l/sensor/eye/image")
    infos = listen(node, CameraInfo, "/world/w/model/rig/link/l/sensor/eye/camera_info")
    world.step(1)
    assert (images[0].pixel_format_type, len(infos)) == (3, 1)
    image = np.frombuffer(images[0].data, "u1").reshape(128, 128, 3)
    assert shown_at(image) == pytest.approx((2.0 / 2.5, 0.0), abs=0.03)
    assert image[0, 0].tolist() == [0, 0, 0] == image[64, 127].tolist() and image[64, 64].tolist() == [0, 0, 255]


def test_a_custom_lens(load_text: Load) -> None:
    function = "<custom_function><c1>1.2</c1><c2>2</c2><c3>0</c3><f>0.8</f><fun>sin</fun></custom_function>"
    custom = f"<type>custom</type><scale_to_hfov>false</scale_to_hfov>{function}"
    left, _ = shown_at(sensor_of(load_text(LIGHT + ball(1.0) + lens(custom))).image())
    assert left == pytest.approx(1.2 * 0.8 * math.sin(0.5), abs=0.03)


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<type>fisheye</type>", "<type> of <lens> 'fisheye' is not known; known names are"),
        ("<type>gnomonical</type>", "a gnomonical lens cannot show a <horizontal_fov> of 3.2 rad"),
        ("<type>custom</type>", "a custom <lens> needs a <custom_function>"),
        ("<type>custom</type><custom_function><fun>cos</fun></custom_function>", "<fun> 'cos' is not known"),
        ("<type>custom</type><custom_function><f>0</f></custom_function>", "must be finite and not zero"),
    ],
)
def test_what_is_wrong_with_a_lens_is_said(load_text: Load, inside: str, sentence: str) -> None:
    (warning,) = load_text(lens(inside, fov=3.2)).warnings
    assert sentence in warning and "stays silent" in warning
