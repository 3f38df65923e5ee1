"""Bounding box camera: boxes of labelled models, in the image and in space."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gz_course.sim.gz.msgs.annotated_axis_aligned_2d_box_v_pb2 import AnnotatedAxisAligned2DBox_V
from gz_course.sim.gz.msgs.annotated_oriented_3d_box_v_pb2 import AnnotatedOriented3DBox_V
from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.sensors.camera_rig import SCENE, Load, eye, listen, sensor_of, thing

BASE = "/world/w/model/rig/link/l/sensor/eye/boundingbox"
FOCAL = 32 / math.tan(0.6)


def labelled(text: str, number: int = 7) -> str:
    plugin = "<plugin filename='gz-sim-label-system' name='gz::sim::systems::Label'>"
    return text.replace("</link>", f"</link>{plugin}<label>{number}</label></plugin>")


BOX = labelled(thing("box", "3 0.4 1.2 0 0 0", "<box><size>0.002 0.6 0.4</size></box>"))
SCREEN = thing("screen", "2 0.2 1 0 0 0", "<box><size>0.002 0.2 2</size></box>")


def pixel(y: float, z: float, x: float = 3.0) -> tuple[float, float]:
    """Return the pixel (x, y) of a point before the camera, which is at a height of 1 m."""
    return 32 - FOCAL * y / x, 24 - FOCAL * (z - 1.0) / x


@pytest.mark.parametrize("kind", ["2d", "full_2d"])
def test_the_corners_of_a_box_are_where_it_is_in_the_image(load_text: Load, node: Node, kind: str) -> None:
    unseen = labelled(thing("behind", "-3 0 1 0 0 0", "<sphere><radius>0.5</radius></sphere>"), 9)
    more = f"<box_type>{kind}</box_type>"
    world = load_text(SCENE + BOX + SCREEN + unseen + eye(kind="boundingbox_camera", more=more), node=node)
    assert not world.warnings
    boxes, images = listen(node, AnnotatedAxisAligned2DBox_V, BASE), listen(node, Image, BASE + "_image")
    world.step(1)
    (found,), (image,) = boxes[0].annotated_box, images
    assert found.label == 7 and boxes[0].header.data[0].value[0] == "rig::l::eye"
    (left, top), (right, bottom) = pixel(0.7, 1.4), pixel(0.1, 1.0)
    if kind == "2d":  # the screen hides what is right of 0.2 m at 2 m
        right = pixel(0.3, 1.0, 2.0)[0]
    assert (found.box.min_corner.x, found.box.min_corner.y) == pytest.approx((left, top), abs=1.0)
    assert (found.box.max_corner.x, found.box.max_corner.y) == pytest.approx((right, bottom), abs=1.0)
    pixels = np.frombuffer(image.data, "u1").reshape(48, 64, 3)
    assert pixels[round(found.box.min_corner.y), round(found.box.min_corner.x)].tolist() == [0, 255, 0]


def test_a_box_in_space_is_in_the_axes_of_its_visual(load_text: Load, node: Node) -> None:
    turned = labelled(thing("box", "3 0.4 1.2 0 0 0.5", "<box><size>0.4 0.6 0.2</size></box>"))
    more = "<box_type>3d</box_type>"
    world = load_text(turned + eye(kind="boundingbox", more=more), node=node)
    boxes, images = listen(node, AnnotatedOriented3DBox_V, BASE), listen(node, Image, BASE + "_image")
    world.step(1)
    box = boxes[0].annotated_box[0].box
    assert (box.center.x, box.center.y, box.center.z) == pytest.approx((-0.4, 0.2, -3.0))
    assert (box.boxSize.x, box.boxSize.y, box.boxSize.z) == pytest.approx((0.4, 0.6, 0.2))
    # The camera looks along x: its y is up, so the turn about the vertical is one about y.
    quaternion = np.array((box.orientation.w, box.orientation.x, box.orientation.y, box.orientation.z))
    half = 0.25
    before = np.array((0.5, -0.5, 0.5, 0.5))
    expected = np.array(
        (
            before[0] * math.cos(half) - before[3] * math.sin(half),
            before[1] * math.cos(half) + before[2] * math.sin(half),
            before[2] * math.cos(half) - before[1] * math.sin(half),
            before[3] * math.cos(half) + before[0] * math.sin(half),
        )
    )
    assert abs(quaternion @ expected) == pytest.approx(1.0)
    green = (np.frombuffer(images[0].data, "u1").reshape(-1, 3) == (0, 255, 0)).all(axis=1)
    assert 30 < green.sum() < 300


def test_the_parts_of_a_model_share_a_box(load_text: Load) -> None:
    sphere = "<geometry><sphere><radius>0.2</radius></sphere></geometry>"
    more = f"</visual><visual name='u'><pose>0 -1 0 0 0 0</pose>{sphere}"
    ball = labelled(thing("balls", "4 0.5 1 0 0 0", "<sphere><radius>0.2</radius></sphere>", more=more))
    world = load_text(ball + eye(kind="boundingbox_camera", more="<box_type>3d</box_type>"))
    (box,) = sensor_of(world).boxes()
    assert box.size == pytest.approx((0.4, 1.4, 0.4), rel=1e-3)
    assert box.pose.position == pytest.approx((4, 0, 0), abs=1e-6)
    world = load_text(ball + eye(kind="boundingbox_camera"))
    (box,) = sensor_of(world).boxes()
    assert box.low[0] == pytest.approx(32 - FOCAL * 0.7 / 4, abs=1.5)
    assert box.high[0] == pytest.approx(32 + FOCAL * 0.7 / 4, abs=1.5)


@pytest.mark.parametrize("shape", ["sphere", "cylinder", "capsule", "ellipsoid", "plane"])
def test_the_whole_box_of_a_shape_in_full_sight_is_its_visible_one(load_text: Load, shape: str) -> None:
    inside = {
        "sphere": "<radius>0.4</radius>",
        "cylinder": "<radius>0.4</radius><length>0.5</length>",
        "capsule": "<radius>0.2</radius><length>0.5</length>",
        "ellipsoid": "<radii>0.2 0.3 0.5</radii>",
        "plane": "<normal>-1 0 0</normal><size>1 0.6</size>",
    }[shape]
    model = labelled(thing("it", "3 0 1 0.3 0.2 0.1", f"<{shape}>{inside}</{shape}>"))
    found = [
        sensor_of(load_text(model + eye(kind="boundingbox", more=f"<box_type>{kind}</box_type>"))).boxes()[0]
        for kind in ("2d", "full_2d")
    ]
    assert (*found[0].low, *found[0].high) == pytest.approx((*found[1].low, *found[1].high), abs=1.5)


def test_an_unknown_type_of_box_silences_the_sensor(load_text: Load) -> None:
    world = load_text(eye(kind="boundingbox_camera", more="<box_type>2D</box_type>"))
    assert "<box_type> '2D' is not known; did you mean '2d'?" in world.warnings[0]
