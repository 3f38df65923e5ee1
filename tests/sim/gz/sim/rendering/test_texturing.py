"""Pictures of textured things and coloured lights, against colours known beforehand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.sdf.test_textures import glb, write
from gz_course.tests.sim.gz.sim.sensors.camera_rig import WALL, eye, sensor_of, thing

BRIGHT = "<scene><ambient>1 1 1 1</ambient><background>0 0 0 1</background></scene>"
MAP = "<material><pbr><metal><albedo_map>a.png</albedo_map></metal></pbr></material>"


def seen(folder: Path, inside: str, **camera: object) -> np.ndarray:
    text = f"<sdf version='1.10'><world name='w'><plugin name='gz::sim::systems::Sensors'/>{inside}{eye(**camera)}"
    (folder / "w.sdf").write_text(text + "</world></sdf>")
    image: np.ndarray = sensor_of(World.load(str(folder / "w.sdf"))).image()
    return image


def model(pose: str, geometry: str, material: str = "") -> str:
    visual = f"<visual name='v'><geometry>{geometry}</geometry>{material}</visual>"
    return f"<model name='m'><static>1</static><pose>{pose}</pose><link name='l'>{visual}</link></model>"


@pytest.mark.parametrize(
    ("pose", "geometry"),
    [
        ("2 0 1 0 0 0", "<box><size>1 1 1</size></box>"),
        ("2 0 1 0 0 3.14159265", "<box><size>1 1 1</size></box>"),
        ("2 0 1 0 0 1.57079633", "<box><size>1 1 1</size></box>"),
        ("2 0 1 0 -1.57079633 0", "<plane><size>1 1</size></plane>"),
    ],
)
def test_a_texture_is_upright_on_walls_and_whole_on_a_plane(tmp_path: Path, pose: str, geometry: str) -> None:
    write(tmp_path)
    image = seen(tmp_path, BRIGHT + model(pose, geometry, MAP))
    corners = [tuple(image[row, column].tolist()) for row in (14, 34) for column in (22, 42)]
    if "plane" in geometry:
        # Its x axis points up here, and y to the left: the texture's upper edge is the left one.
        assert set(corners) == {(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)}
    else:
        assert corners == [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0)]


def test_meshes_show_the_places_of_their_files(tmp_path: Path) -> None:
    write(tmp_path)
    (tmp_path / "a.glb").write_bytes(glb())
    obj = "<mesh><uri>a.obj</uri></mesh>"
    # The painted side faces -y; turned by -90 degrees it faces -x, to the camera.
    image = seen(tmp_path, BRIGHT + model("2 0.5 0.5 0 0 -1.57079633", obj))
    assert [tuple(image[row, column].tolist()) for row in (14, 34) for column in (22, 42)] == [
        (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 0),
    ]  # fmt: skip
    sign = seen(tmp_path, BRIGHT + model("4 1 -2 0 0 -1.57079633", "<mesh><uri>a.glb</uri></mesh>"))
    assert [tuple(sign[row, column].tolist()) for row in (14, 34) for column in (22, 42)] == [
        (255, 0, 0), (0, 128, 0), (0, 0, 255), (255, 128, 0),
    ]  # fmt: skip
    # A <material> beside the mesh takes precedence over that of its file.
    red = "<material><diffuse>1 0 0 1</diffuse></material>"
    image = seen(tmp_path, BRIGHT + model("2 0.5 0.5 0 0 -1.57079633", obj, red))
    assert image[14, 42].tolist() == [255, 0, 0]


def test_far_textures_are_averaged_and_colours_multiply_them(tmp_path: Path) -> None:
    stripes = np.tile(np.array([[0], [255]], np.uint8), (256, 512))
    Image.fromarray(np.stack([stripes] * 3, axis=-1)).save(tmp_path / "a.png")
    half = MAP.replace("<material>", "<material><diffuse>1 0.5 0 1</diffuse>")
    image = seen(tmp_path, BRIGHT + model("20 0 1 0 0 0", "<box><size>1 10 10</size></box>", half))
    assert np.ptp(image[20:28, 26:38].reshape(-1, 3), axis=0).max() < 40
    assert image[24, 32].tolist() == pytest.approx([128, 64, 0], abs=20)


def test_lights_have_colours_spots_have_edges_and_shiny_things_a_highlight(tmp_path: Path) -> None:
    dark = "<scene><ambient>0.1 0.1 0.1 1</ambient></scene>"
    even = (
        "<attenuation><range>50</range><constant>1</constant><linear>0</linear><quadratic>0</quadratic></attenuation>"
    )
    lamp = f"<light name='a' type='{{}}'><pose>0 0 1 0 0 0</pose><diffuse>{{}}</diffuse>{even}{{}}</light>"
    cone = "<direction>1 0 0</direction><spot><inner_angle>0.3</inner_angle><outer_angle>0.4</outer_angle></spot>"
    wall = thing("wall", "3.1 0 1 0 0 0", WALL, "1 1 1 1")
    spot = seen(tmp_path, dark + lamp.format("spot", "0.8 0 0.4 1", cone) + wall)
    assert spot[24, 32].tolist() == pytest.approx([255 * 0.9, 255 * 0.1, 255 * 0.5], abs=3)
    assert spot[24, 5].tolist() == pytest.approx([255 * 0.1] * 3, abs=2)
    # Full inside the inner angle, half of it in the middle between both cosines.
    inside = 32 + round(np.tan(0.14) * 32 / np.tan(0.6))
    assert spot[24, inside].tolist() == pytest.approx(spot[24, 32].tolist(), abs=4)
    point = seen(tmp_path, dark + lamp.format("point", "0 0.8 0 1", "") + wall)
    assert point[24, 32].tolist() == pytest.approx([255 * 0.1, 255 * 0.9, 255 * 0.1], abs=3)
    short = lamp.format("point", "0 0.8 0 1", "").replace("<range>50", "<range>2")
    assert seen(tmp_path, dark + short + wall)[24, 32, 1] == pytest.approx(255 * 0.1, abs=2)
    ball = model(
        "3 0 1 0 0 0", "<sphere><radius>1</radius></sphere>", "<material><diffuse>0 0 1 1</diffuse>{}</material>"
    )
    dull, shiny = (
        seen(tmp_path, dark + lamp.format("point", "0.5 0.5 0.5 1", "<specular>1 1 1 1</specular>") + ball.format(more))
        for more in ("", "<specular>0.6 0.6 0.6 1</specular>")
    )
    assert shiny[24, 32, 0] > dull[24, 32, 0] + 120 and shiny[24, 46, 0] < dull[24, 46, 0] + 20
