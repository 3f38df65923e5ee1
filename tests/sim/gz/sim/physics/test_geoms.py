"""Shapes collide where their files place them: meshes, cones, polylines, heightmaps, rooms; lights move with links."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pytest

from gz_course.sim.gz.sim.physics.geoms import geom_names
from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.sdf.shapes_on_disk import write_heightmap, write_obj, write_stl

Load = Callable[..., World]
FLOOR = (
    "<model name='floor'><static>1</static><link name='l'><collision name='c'><geometry><plane/></geometry></collision>"
    "</link></model>"
)


def body(name: str, pose: str, geometry: str, static: bool = False, times: int = 1) -> str:
    shapes = "".join(
        f"<collision name='c{n}'><geometry>{geometry}</geometry></collision>"
        f"<visual name='v{n}'><geometry>{geometry}</geometry></visual>"
        for n in range(times)
    )
    return (
        f"<model name='{name}'><static>{static}</static><pose>{pose}</pose><link name='l'>"
        f"<inertial auto='true'/>{shapes}</link></model>"
    )


@pytest.mark.parametrize(
    ("geometry", "height"),
    [
        ("<cone><radius>0.5</radius><length>1</length></cone>", 0.5),
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", 0.5),
        ("<mesh><uri>{folder}/box.obj</uri><scale>1 1 0.5</scale></mesh>", 0.0),
        ("<polyline><point>0 0</point><point>1 0</point><point>1 1</point><point>0 1</point></polyline>", 0.0),
    ],
)
def test_shapes_rest_on_the_floor(load_text: Load, tmp_path: Path, geometry: str, height: float) -> None:
    write_obj(tmp_path / "box.obj", ((0, 0), (1, 0), (1, 1), (0, 1)))
    world = load_text(FLOOR + body("m", f"0 0 {height + 0.01} 0 0 0", geometry.replace("{folder}", str(tmp_path))))
    assert world.warnings == []
    world.step(800)
    assert world.truth.pose("m").position == pytest.approx((0, 0, height), abs=2e-3)
    assert np.abs(world.truth.pose("m").rpy()) == pytest.approx((0, 0, 0), abs=2e-3)


@pytest.mark.parametrize(
    ("geometry", "share"),
    [
        ("<cylinder><radius>0.5</radius><length>1</length></cylinder>", 2 / 3),
        ("<sphere><radius>0.5</radius></sphere>", 5 / 7),
    ],
)
def test_shapes_roll_down_a_slope_as_their_automatic_inertia_says(load_text: Load, geometry: str, share: float) -> None:
    slope = FLOOR.replace("<link ", "<pose>0 0 0 0 -0.3 0</pose><link ")
    world = load_text(slope + body("m", f"0 0 {0.5 / np.cos(0.3)} 1.5707963267948966 0 0", geometry))
    world.step(1000)
    travelled = float(np.linalg.norm(world.truth.pose("m").position - (0, 0, 0.5 / np.cos(0.3))))
    assert travelled == pytest.approx(0.5 * share * 9.8 * np.sin(0.3), rel=0.01)


def test_equal_meshes_are_one_asset(load_text: Load, tmp_path: Path) -> None:
    write_stl(tmp_path / "t.stl")
    mesh = f"<mesh><uri>{tmp_path}/t.stl</uri></mesh>"
    world = load_text(body("a", "0 0 0 0 0 0", mesh, times=3) + body("b", "5 0 0 0 0 0", mesh, times=3))
    assert world.model.ngeom == 12 and world.model.nmesh == 2  # its hull and its surface


def test_the_surface_that_is_seen_is_exact(load_text: Load, tmp_path: Path) -> None:
    write_obj(tmp_path / "ell.obj")
    world = load_text(body("m", "1 0 0 0 0 0", f"<mesh><uri>{tmp_path}/ell.obj</uri></mesh>", static=True))
    groups = np.array((0, 1, 0, 0, 0, 0), dtype=np.uint8)

    def height_at(x: float, y: float) -> float:
        hit = np.zeros(1, dtype=np.int32)
        return 5.0 - mujoco.mj_ray(
            world.model, world.data, np.array((x, y, 5.0)), np.array((0, 0, -1.0)), groups, True, -1, hit
        )

    assert height_at(1.5, 1.5) == pytest.approx(1.0)
    assert height_at(2.5, 0.5) == pytest.approx(1.0)
    assert height_at(2.5, 1.5) > 5.0  # there is no surface in the notch of the L


def test_a_ball_rolls_to_the_bottom_of_a_heightmap(load_text: Load, tmp_path: Path) -> None:
    across = np.abs(np.linspace(-1, 1, 41))
    write_heightmap(tmp_path / "v.png", np.tile((255 * across).astype(np.uint8), (41, 1)))
    ground = f"<heightmap><uri>{tmp_path}/v.png</uri><size>20 20 10</size><pos>0 0 1</pos></heightmap>"
    ball = body("ball", "1 4 5 0 0 0", "<sphere><radius>0.3</radius></sphere>").replace("<inertial auto='true'/>", "")
    world = load_text(body("ground", "0 0 2 0 0 0", ground, static=True) + ball)
    assert world.warnings == [] and world.model.nhfield == 1
    lowest = 9.0
    for _ in range(60):
        world.step(50)
        lowest = min(lowest, float(world.truth.pose("ball").position[2]))
    # Between slopes of 45 degrees the centre of a ball rests r sqrt(2) above the valley, which is at 3 m.
    assert lowest == pytest.approx(3 + 0.3 * 2**0.5, abs=0.1)
    assert world.truth.pose("ball").position[1] == pytest.approx(4.0, abs=0.05)


def test_a_room_made_of_one_mesh_is_hollow(load_text: Load, tmp_path: Path) -> None:
    write_obj(tmp_path / "room.obj", ((0, 0), (4, 0), (4, 4), (0, 4)), height=3.0)
    inside_out = (tmp_path / "room.obj").read_text().splitlines()
    turned = ["f " + " ".join(line.split()[:0:-1]) if line.startswith("f") else line for line in inside_out]
    (tmp_path / "room.obj").write_text("\n".join(turned))
    room = body("room", "0 0 0 0 0 0", f"<mesh><uri>{tmp_path}/room.obj</uri></mesh>", static=True)
    world = load_text(room + body("ball", "2 2 1 0 0 0", "<sphere><radius>0.3</radius></sphere>"))
    assert world.warnings == []
    world.step(1000)
    assert world.truth.pose("ball").position == pytest.approx((2, 2, 0.3), abs=5e-3)
    part = world.description.models[0].links[0].collisions[0]
    assert [world.model.geom(name).id for name in geom_names("room::l::c0", part)] == sorted(
        geom for geom in range(world.model.ngeom) if "room::l::c0" in world.model.geom(geom).name
    )


def test_a_flat_mesh_can_be_stood_on(load_text: Load, tmp_path: Path) -> None:
    write_stl(tmp_path / "sheet.stl", ((-2, -2, 0), (2, -2, 0), (-2, 2, 0), (2, 2, 0)))
    sheet = body("sheet", "0 0 1 0 0 0", f"<mesh><uri>{tmp_path}/sheet.stl</uri></mesh>", static=True)
    world = load_text(sheet + body("box", "0.5 0.5 1.26 0 0 0", "<box><size>0.5 0.5 0.5</size></box>"))
    world.step(500)
    assert world.truth.pose("box").position[2] == pytest.approx(1.25, abs=0.01)


def test_self_collision_of_one_link_is_enough_but_joints_keep_apart(load_text: Load) -> None:
    ball = "<collision name='c'><geometry><sphere><radius>0.5</radius></sphere></geometry></collision>"
    links = f"<link name='a'><self_collide>1</self_collide>{ball}</link><link name='b'>{ball}</link>"
    assert load_text(f"<model name='m'>{links}</model>").data.ncon == 1
    held = "<joint name='j' type='ball'><parent>a</parent><child>b</child></joint>"
    assert load_text(f"<model name='m'>{links}{held}</model>").data.ncon == 0


def test_lights_have_their_kind_and_those_of_links_move_along(load_text: Load) -> None:
    spot = (
        "<light name='lamp' type='spot'><pose>0 0 0 0 1.5707963267948966 0</pose>"
        "<spot><outer_angle>0.8</outer_angle></spot><cast_shadows>1</cast_shadows><intensity>0.5</intensity></light>"
    )
    fades = "<attenuation><quadratic>0.2</quadratic></attenuation>"
    point = f"<light name='bulb' type='point'>{fades}<light_on>0</light_on></light>"
    world = load_text(f"<model name='m'><pose>0 0 9 0 0 0</pose><link name='l'>{spot}</link></model>{point}")
    lamp, bulb = world.model.light("m::l::lamp"), world.model.light("bulb")
    assert lamp.cutoff == pytest.approx(np.degrees(0.4)) and lamp.castshadow[0] and lamp.diffuse == pytest.approx(0.5)
    assert bulb.attenuation == pytest.approx((1, 1, 0.2)) and not bulb.active[0] and not bulb.castshadow[0]
    world.step(300)
    mujoco.mj_forward(world.model, world.data)
    assert world.data.light_xpos[lamp.id][2] == pytest.approx(world.truth.pose("m").position[2], abs=1e-6)
    assert world.data.light_xdir[lamp.id] == pytest.approx((-1, 0, 0), abs=1e-6)
