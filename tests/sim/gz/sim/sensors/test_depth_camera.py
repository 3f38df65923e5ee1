"""Cameras that measure depth or show labels, against geometry; image formats."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gz_course.sim.gz.msgs.camera_info_pb2 import CameraInfo
from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.msgs.pointcloud_packed_pb2 import PointCloudPacked
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.sensors.camera import encode
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.sensors.camera_rig import SCENE, WALL, Load, eye, listen, sensor_of, thing


def test_depth_is_measured_along_the_axis_and_points_lie_on_the_wall(load_text: Load, node: Node) -> None:
    world = load_text(eye(kind="depth_camera", far=10) + thing("wall", "3.1 0 1 0 0 0", WALL), node=node)
    camera = sensor_of(world)
    assert camera.topic == "/world/w/model/rig/link/l/sensor/eye/depth_image"
    images = listen(node, Image, camera.topic)
    clouds = listen(node, PointCloudPacked, camera.topic + "/points")
    infos = listen(node, CameraInfo, "/world/w/model/rig/link/l/sensor/eye/camera_info")
    world.step(1)
    (image,), (cloud,), (info,) = images, clouds, infos
    assert image.pixel_format_type == 13 and image.step == 64 * 4
    assert np.frombuffer(image.data, "<f4") == pytest.approx(3.0, abs=1e-5)
    assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step, cloud.is_dense) == (64, 48, 24, 24 * 64, True)
    assert [(f.name, f.offset, f.datatype) for f in cloud.field] == [
        ("x", 0, 6),
        ("y", 4, 6),
        ("z", 8, 6),
        ("rgb", 16, 6),
    ]
    points = np.frombuffer(cloud.data, "u1").reshape(48, 64, 24)[:, :, :12].copy().view("<f4")
    fx, cx, cy = info.intrinsics.k[0], info.intrinsics.k[2], info.intrinsics.k[5]
    assert (fx, cx, cy) == pytest.approx((32 / math.tan(0.6), 32, 24))
    for row, column in ((0, 0), (10, 50), (47, 63)):
        x, y, z = points[row, column]
        assert (x, y, z) == pytest.approx((3, -3 * (column + 0.5 - cx) / fx, -3 * (row + 0.5 - cy) / fx), abs=1e-4)
    assert list(info.projection.p) == pytest.approx([fx, 0, cx, 0, 0, fx, cy, 0, 0, 0, 1, 0])


def test_depth_says_too_near_and_too_far(load_text: Load) -> None:
    near = thing("near", "0.3 0 1 0 0 0", "<box><size>0.1 0.05 0.05</size></box>")
    camera = sensor_of(load_text(eye(kind="depth_camera", near=0.5, far=2) + near + thing("w", "3 2 1 0 0 0", WALL)))
    depth = camera.depths(camera.cast())
    assert depth[24, 32] == -math.inf and depth[0, 0] == math.inf
    assert set(np.unique(depth)) == {-math.inf, math.inf}


def test_rgbd_publishes_below_its_topic_only_what_is_heard(load_text: Load, node: Node) -> None:
    wall = thing("wall", "3.1 0 1 0 0 0", WALL)
    world = load_text(SCENE + eye(kind="rgbd_camera", topic="<topic>rgbd</topic>") + wall, node=node)
    names = ("/rgbd/image", "/rgbd/depth_image", "/rgbd/points", "/rgbd/camera_info")
    kinds = (Image, Image, PointCloudPacked, CameraInfo)
    heard = [listen(node, kind, name) for kind, name in zip(kinds, names, strict=True)]
    world.step(1)
    image, depth, points, info = (each[0] for each in heard)
    assert image.pixel_format_type == 3 and image.data[:3] == bytes((77, 0, 0))
    assert np.frombuffer(depth.data, "<f4") == pytest.approx(3.0, abs=1e-5)
    assert points.data[16:20] == bytes((0, 0, 77, 0)), "0x00RRGGBB, little-endian"
    assert info.width == 64


def label(number: int) -> str:
    return f"<plugin filename='gz-sim-label-system' name='gz::sim::systems::Label'><label>{number}</label></plugin>"


def test_segmentation_shows_labels_and_instances(load_text: Load, node: Node) -> None:
    box = "<box><size>0.2 0.5 0.5</size></box>"
    scene = (
        thing("left", "3 1 1 0 0 0", box, more=label(40))
        + thing("right", "3 -1 1 0 0 0", box).replace("</link>", "</link>" + label(40))
        + thing("middle", "3 0 1 0 0 0", box)
    )
    world = load_text(scene + eye(kind="segmentation_camera"), node=node)
    base = "/world/w/model/rig/link/l/sensor/eye/segmentation"
    labels, colours = listen(node, Image, base + "/labels_map"), listen(node, Image, base + "/colored_map")
    infos = listen(node, CameraInfo, base + "/camera_info")
    world.step(1)
    assert len(labels) == len(colours) == len(infos) == 1
    pixels = np.frombuffer(labels[0].data, "u1").reshape(48, 64, 3)
    left, middle, right = 32 - 15, 32, 32 + 15
    assert [pixels[24, column].tolist() for column in (left, middle, right)] == [[40] * 3, [0] * 3, [40] * 3]
    seen = np.frombuffer(colours[0].data, "u1").reshape(48, 64, 3)
    assert (seen[24, left] == seen[24, right]).all() and seen[24, left].any() and not seen[24, middle].any()
    panoptic = load_text(scene + eye(kind="segmentation", more="<segmentation_type>Instance</segmentation_type>"))
    marks, shades = sensor_of(panoptic).maps()
    assert [marks[24, column].tolist() for column in (left, middle, right)] == [[1, 0, 40], [0, 0, 0], [2, 0, 40]]
    assert (shades[24, left] != shades[24, right]).any()


def test_formats() -> None:
    colours = np.array([[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]], dtype=np.float32)
    assert encode(colours, 2, 2, "RGB_INT8").tolist() == [[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 255]]]
    assert encode(colours, 2, 2, "L_INT8").tolist() == [[76, 150], [29, 255]]
    assert encode(colours, 2, 2, "L_INT16").tolist() == [[19595, 38469], [7471, 65535]]
    assert encode(colours, 2, 2, "BAYER_RGGB8").tolist() == [[255, 255], [0, 255]]
    assert encode(colours, 2, 2, "BAYER_BGGR8").tolist() == [[0, 255], [0, 255]]
    assert encode(colours, 2, 2, "BAYER_GBRG8").tolist() == [[0, 0], [0, 255]]
    assert encode(colours, 2, 2, "BAYER_GRBG8").tolist() == [[0, 0], [255, 255]]


@pytest.mark.parametrize(("stated", "kind", "bytes_each"), [("L8", 1, 1), ("L16", 2, 2), ("BAYER_RGGB8", 15, 1)])
def test_grey_and_bayer_images(load_text: Load, node: Node, stated: str, kind: int, bytes_each: int) -> None:
    world = load_text(SCENE + eye(format=stated) + thing("wall", "3.1 0 1 0 0 0", WALL, "1 1 1 1"), node=node)
    images = listen(node, Image, sensor_of(world).topic)
    world.step(1)
    assert (images[0].pixel_format_type, images[0].step) == (kind, 64 * bytes_each)
    value = np.frombuffer(images[0].data, "<u2" if bytes_each == 2 else "u1")
    assert value == pytest.approx(0.3 * (65535 if bytes_each == 2 else 255), abs=1)


@pytest.mark.parametrize("kind", ["depth_camera", "rgbd_camera", "segmentation_camera"])
def test_only_cameras_look_at_the_format(load_text: Load, kind: str) -> None:
    assert load_text(eye(kind=kind, format="R_FLOAT32")).warnings == []


def test_a_label_must_fit_a_byte(load_text: Load) -> None:
    with pytest.raises(SdfError, match="0 to 255, got '256'"):
        load_text(eye() + thing("a", "3 1 1 0 0 0", WALL).replace("</link>", "</link>" + label(256)))
