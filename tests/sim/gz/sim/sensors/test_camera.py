"""Cameras against geometry and Lambert's law, computed here independently of the simulator."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.camera_info_pb2 import CameraInfo
from gz_course.sim.gz.msgs.image_pb2 import Image
from gz_course.sim.gz.sim.rendering.tile_caster import TileCaster
from gz_course.sim.gz.sim.sensors.camera import Camera
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.sensors.camera_rig import SCENE, WALL, Load, eye, listen, sensor_of, sun, thing


@settings(max_examples=30, deadline=None)
@given(st.floats(2, 8), st.floats(-0.45, 0.45), st.floats(-0.3, 0.3))
def test_a_ball_is_where_the_pinhole_puts_it(x: float, left: float, up: float) -> None:
    ball = thing("ball", f"{x!r} {left * x!r} {1 + up * x!r} 0 0 0", "<sphere><radius>0.05</radius></sphere>")
    world = World.from_string(
        "<sdf version='1.10'><world name='w'><plugin name='gz::sim::systems::Sensors'/>"
        f"{eye(width=320, height=240)}{ball}</world></sdf>"
    )
    hits = sensor_of(world).cast()
    rows, columns = np.divmod(np.flatnonzero(hits.geom >= 0), 320)
    focal = 160 / math.tan(0.6)
    assert len(rows) > 0
    # The image of a ball off the axis is an ellipse whose centre is slightly further out.
    assert columns.mean() + 0.5 == pytest.approx(160 - focal * left, abs=0.8)
    assert rows.mean() + 0.5 == pytest.approx(120 - focal * up, abs=0.8)


def test_a_lit_wall_has_lamberts_colour_and_the_sky_its_own(load_text: Load) -> None:
    # The wall faces -x; light reaches it at 60 degrees.
    light = sun(f"{math.cos(math.pi / 3)} 0 {-math.sin(math.pi / 3)}", shadows=False)
    wall = thing("wall", "3.1 0 1 0 0 0", "<box><size>0.2 1 1</size></box>", "0.8 0.4 0.2 1")
    image = sensor_of(load_text(SCENE + light + wall + eye())).image()
    expected = np.array((0.8, 0.4, 0.2)) * (0.3 + 0.6 * math.cos(math.pi / 3)) * 255
    assert image.shape == (48, 64, 3)
    assert image[24, 32].tolist() == pytest.approx(expected.tolist(), abs=1)
    assert image[0, 0].tolist() == [0, 0, 255]


def test_a_sky_is_blue_above_and_pale_at_the_horizon(load_text: Load) -> None:
    image = sensor_of(load_text("<scene><sky/></scene>" + eye(fov=2.0))).image().astype(int)
    assert image[0, 32, 2] > image[0, 32, 0] + 40 and image[0, 32, 0] < image[23, 32, 0] - 40
    assert (image[30:] == image[30, 0]).all()


TABLE = thing("table", "3 0 1.5 0 0 0", "<box><size>1 1 0.1</size></box>", "0 1 0 1")
FLOOR = thing("floor", "0 0 0 0 0 0", "<plane><normal>0 0 1</normal><size>100 100</size></plane>", "1 1 1 1")


def test_shadows_fall_where_the_light_does_not(load_text: Load) -> None:
    world = load_text(SCENE + sun("0 0 -1") + TABLE + FLOOR + eye(width=160, height=120))
    image = sensor_of(world).image()
    focal = 80 / math.tan(0.6)

    def at(x: float, y: float) -> list[int]:
        """Return the pixel that shows a point of the floor."""
        return image[int(60 + focal * 1 / x), int(80 - focal * y / x)].tolist()

    lit, shaded = round(255 * 0.9), round(255 * 0.3)
    for x in (2.6, 3.0, 3.4):
        for y in (-0.4, 0.0, 0.4):
            assert at(x, y) == pytest.approx([shaded] * 3, abs=1), (x, y)
        for y in (-0.7, 0.7):
            assert at(x, y) == pytest.approx([lit] * 3, abs=1), (x, y)


def test_the_near_plane_is_looked_through_and_the_far_one_ends_the_view(load_text: Load) -> None:
    near = thing("near", "0.3 0 1 0 0 0", "<box><size>0.1 0.05 0.05</size></box>", "0 1 0 1")
    wall = thing("wall", "3.1 0 1 0 0 0", WALL)
    scene = SCENE + near + wall

    def middle(**clip: float) -> list[int]:
        return sensor_of(load_text(scene + eye(**clip))).image()[24, 32].tolist()

    assert middle(near=0.1) == pytest.approx([0, 255 * 0.3, 0], abs=1)
    assert middle(near=0.5) == pytest.approx([255 * 0.3, 0, 0], abs=1)
    assert middle(near=0.5, far=2.9) == [0, 0, 255]


@pytest.mark.parametrize(
    ("camera", "expected"),
    [
        ({}, "/world/w/model/rig/link/l/sensor/eye/camera_info"),
        ({"topic": "<topic>robot/front/image_raw</topic>"}, "/robot/front/camera_info"),
        ({"topic": "<topic>camera</topic>"}, "/camera_info"),
        ({"more": "<camera_info_topic>facts</camera_info_topic>"}, "/facts"),
    ],
)
def test_where_camera_info_stands(load_text: Load, camera: dict[str, str], expected: str) -> None:
    assert sensor_of(load_text(eye(**camera))).info_topic == expected


def test_rate_frame_and_laziness(load_text: Load, node: Node, monkeypatch: pytest.MonkeyPatch) -> None:
    casts = []
    original = TileCaster.look
    monkeypatch.setattr(TileCaster, "look", lambda self: casts.append(1) or original(self))
    world = load_text(eye(rate=30, more="<optical_frame_id>optical</optical_frame_id>"), node=node)
    infos = listen(node, CameraInfo, sensor_of(world).info_topic)
    world.step(50)
    assert len(infos) == 2 and not casts, "camera_info alone needs no picture"
    images = listen(node, Image, sensor_of(world).topic)
    world.step(50)
    assert len(casts) == len(images) == 2 and len(infos) == 4
    header = images[0].header
    assert (header.stamp.sec, header.stamp.nsec) == (0, 66_000_000)
    assert header.data[0].key == "frame_id" and list(header.data[0].value) == ["optical"]
    assert infos[0].header.data[0].value[0] == "optical"


def test_a_triggered_camera_waits_for_its_trigger(load_text: Load, node: Node) -> None:
    world = load_text(eye(more="<triggered>true</triggered>", topic="<topic>c/i</topic>", rate=0), node=node)
    images = listen(node, Image, "/c/i")
    world.step(100)
    assert not images
    trigger = node.advertise("/c/i/trigger", Boolean)
    trigger.publish(Boolean(data=True))
    world.step(100)
    assert len(images) == 1
    trigger.publish(Boolean(data=True))
    trigger.publish(Boolean(data=False))
    world.step(100)
    assert len(images) == 1


@settings(max_examples=15, deadline=None)
@given(st.floats(-0.1, 0.3), st.floats(-0.02, 0.1), st.floats(-0.02, 0.02), st.floats(-0.02, 0.02))
def test_a_distorted_lens_puts_points_where_browns_formula_says(k1: float, k2: float, p1: float, p2: float) -> None:
    lens = f"<distortion><k1>{k1!r}</k1><k2>{k2!r}</k2><k3>0</k3><p1>{p1!r}</p1><p2>{p2!r}</p2></distortion>"
    world = World.from_string(
        "<sdf version='1.10'><world name='w'><plugin name='gz::sim::systems::Sensors'/>"
        f"{eye(width=160, height=120, more=lens)}</world></sdf>"
    )
    camera = sensor_of(world)
    left, up = camera.pinhole.slopes()
    focal = 80 / math.tan(0.6)
    for index in (0, 80, 60 * 160 + 80, 119 * 160 + 159, 30 * 160 + 120):
        x, y = -left[index], -up[index]  # right and down, without distortion
        square = x * x + y * y
        radial = 1 + k1 * square + k2 * square**2
        u = focal * (x * radial + 2 * p1 * x * y + p2 * (square + 2 * x * x)) + 80
        v = focal * (y * radial + p1 * (square + 2 * y * y) + 2 * p2 * x * y) + 60
        assert (u, v) == pytest.approx((index % 160 + 0.5, index // 160 + 0.5), abs=0.05)


def test_stated_intrinsics_move_the_picture(load_text: Load) -> None:
    lens = "<lens><intrinsics><fx>100</fx><fy>100</fy><cx>10</cx><cy>5</cy><s>0</s></intrinsics></lens>"
    ball = thing("ball", "3 0 1 0 0 0", "<sphere><radius>0.05</radius></sphere>")
    hits = sensor_of(load_text(eye(more=lens) + ball)).cast()
    rows, columns = np.divmod(np.flatnonzero(hits.geom >= 0), 64)
    assert (columns.mean() + 0.5, rows.mean() + 0.5) == pytest.approx((10, 5), abs=0.5)


def test_noise_is_seeded_and_has_the_stated_spread(load_text: Load, node: Node) -> None:
    text = SCENE + thing("wall", "3.1 0 1 0 0 0", WALL, "1 1 1 1")
    text += eye(more="<noise><type>gaussian</type><mean>0</mean><stddev>0.05</stddev></noise>")
    one, same, other = (sensor_of(load_text(text, seed=seed)).image().astype(float) for seed in (1, 1, 2))
    assert (one == same).all() and (one != other).any()
    assert one.std() == pytest.approx(0.05 * 255, rel=0.1) and one.mean() == pytest.approx(0.3 * 255, abs=2)


def test_visibility_flags_hide_from_a_masked_camera(load_text: Load) -> None:
    ball = thing(
        "ball", "3 0 1 0 0 0", "<sphere><radius>0.5</radius></sphere>", more="<visibility_flags>2</visibility_flags>"
    )
    assert (sensor_of(load_text(ball + eye())).cast().geom >= 0).any()
    assert (sensor_of(load_text(ball + eye(more="<visibility_mask>2</visibility_mask>"))).cast().geom >= 0).any()
    assert not (sensor_of(load_text(ball + eye(more="<visibility_mask>5</visibility_mask>"))).cast().geom >= 0).any()
    assert (sensor_of(load_text(ball + eye(more="<visibility_mask>0x06</visibility_mask>"))).cast().geom >= 0).any()
    assert not (sensor_of(load_text(ball + eye(more="<visibility_mask>0x01</visibility_mask>"))).cast().geom >= 0).any()


def test_a_housing_is_looked_through_and_hides_nothing_for_others(load_text: Load) -> None:
    housing = "<visual name='h'><geometry><box><size>0.5 0.5 0.5</size></box></geometry></visual>"
    world = load_text(eye(parts=housing) + thing("wall", "3.1 0 1 0 0 0", WALL))
    groups = world.model.geom_group.copy()
    camera = sensor_of(world)
    assert camera.depth(camera.cast()) == pytest.approx(3.0)
    assert (world.model.geom_group == groups).all()


def test_binding_and_starting_again_gives_the_same_image(load_text: Load) -> None:
    text = SCENE + sun("0.4 0.3 -1") + TABLE + FLOOR
    camera = sensor_of(load_text(text + eye(more="<noise><type>gaussian</type><stddev>0.05</stddev></noise>")))
    before = camera.image()
    camera.updates = 5
    assert (camera.image() != before).any()
    camera.bind()
    camera.start()
    assert (camera.image() == before).all()


def test_images_are_the_same_bytes_in_another_world(load_text: Load) -> None:
    text = SCENE + sun("0.4 0.3 -1") + TABLE + FLOOR + eye()
    assert sensor_of(load_text(text)).image().tobytes() == sensor_of(load_text(text)).image().tobytes()


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"width": 0}, "1 to 8300000 pixels, this one is 0 x 48"),
        ({"width": 1_000_000, "height": 1_000_000}, "1 to 8300000 pixels"),
        ({"fov": 3.3}, "<horizontal_fov> must be between"),
        ({"fov": 3.14159}, "<horizontal_fov> must be between"),
        ({"fov": "nan"}, "must not be NaN"),
        ({"near": 5, "far": 1}, "0 < near < far"),
        ({"kind": "segmentation_camera", "more": "<segmentation_type>semantik</segmentation_type>"}, "'semantic'"),
        ({"more": "<lens><intrinsics><fx>0</fx></intrinsics></lens>"}, "focal length must be positive"),
        ({"more": "<distortion><k1>inf</k1></distortion>"}, "<distortion> must hold reasonable numbers"),
    ],
)
def test_an_impossible_camera_is_left_out_and_the_rest_runs(
    load_text: Load, changes: dict[str, Any], sentence: str
) -> None:
    world = load_text(eye(**changes))
    (warning,) = world.warnings
    assert warning.startswith("<string>:") and sentence in warning and "stays silent" in warning
    world.step(2)


@pytest.mark.parametrize("kind", ["camera", "depth_camera", "rgbd_camera", "segmentation_camera"])
def test_without_its_element_a_camera_has_the_values_of_sdf(load_text: Load, kind: str) -> None:
    link = f"<link name='l'><sensor name='s' type='{kind}'/></link>"
    world = load_text(f"<model name='m'><static>true</static>{link}</model>")
    lens = sensor_of(world).pinhole
    assert (lens.width, lens.height, lens.hfov, lens.near, lens.far) == (320, 240, 1.047, 0.1, 100.0)
    assert world.warnings == []


def test_a_format_that_cameras_do_not_make_is_named_and_the_image_is_in_colour(load_text: Load, node: Node) -> None:
    world = load_text(eye(format="B8G8R8"), node=node)
    assert any("'B8G8R8' is not one cameras make" in each and "'R8G8B8'" in each for each in world.warnings)
    images = listen(node, Image, sensor_of(world).topic)
    world.step(1)
    assert images[0].pixel_format_type == 3 and len(images[0].data) == 64 * 48 * 3


def test_saving_to_disk_is_named_as_ignored(load_text: Load) -> None:
    world = load_text(eye(more="<save enabled='true'><path>/tmp/x</path></save>"))
    assert any("<save> of sensor 'eye' is ignored" in warning for warning in world.warnings)
    assert isinstance(sensor_of(world), Camera)


def test_a_point_light_fades_and_a_spot_light_has_an_edge(load_text: Load) -> None:
    wall = thing("wall", "3.1 0 1 0 0 0", WALL, "1 1 1 1")
    fading = (
        "<attenuation><range>50</range><constant>0</constant><linear>0.5</linear><quadratic>0</quadratic></attenuation>"
    )
    lamp = f"<light name='a' type='point'><pose>0 0 1 0 0 0</pose><diffuse>0.6 0.6 0.6 1</diffuse>{fading}</light>"
    image = sensor_of(load_text(SCENE + lamp + wall + eye())).image()
    ahead = 0.3 + 0.6 / (0.5 * 3)
    assert image[24, 32, 0] == pytest.approx(255 * ahead, abs=2)
    assert image[24, 0, 0] < image[24, 32, 0] - 10
    spot = (
        "<light name='a' type='spot'><pose>0 0 1 0 0 0</pose><direction>1 0 0</direction><diffuse>.6 .6 .6 1</diffuse>"
        "<spot><inner_angle>0.2</inner_angle><outer_angle>0.4</outer_angle><falloff>1</falloff></spot></light>"
    )
    image = sensor_of(load_text(SCENE + spot + wall + eye())).image()
    assert image[24, 0, 0] == pytest.approx(255 * 0.3, abs=2) and image[24, 32, 0] > 100
