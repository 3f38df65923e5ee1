"""The cameras' own ray casting against MuJoCo's, ray by ray."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from gz_course.sim.gz.sim.rendering.tiles import Tiles
from gz_course.sim.gz.sim.world import World
from gz_course.tests.sim.gz.sim.sensors.camera_rig import eye, sensor_of, thing

SHAPES = (
    "<box><size>.5 .4 .8</size></box>",
    "<sphere><radius>.35</radius></sphere>",
    "<cylinder><radius>.25</radius><length>.8</length></cylinder>",
    "<capsule><radius>.2</radius><length>.6</length></capsule>",
    "<ellipsoid><radii>.2 .3 .5</radii></ellipsoid>",
    "<cone><radius>.3</radius><length>.6</length></cone>",
    "<plane><normal>0.1 0.2 1</normal><size>1 0.5</size></plane>",
)


def clutter(seed: int, count: int, reach: float = 3.0) -> str:
    random = np.random.default_rng(seed)
    poses = random.uniform((0.3, -reach, -reach, -3, -3, -3), (2 * reach, reach, reach, 3, 3, 3), (count, 6))
    return "".join(
        thing(f"t{i}", " ".join(map(repr, pose)), SHAPES[i % len(SHAPES)]) for i, pose in enumerate(poses.tolist())
    )


def bare(world: World) -> tuple[np.ndarray, np.ndarray]:
    """MuJoCo's own ray casting of the same pixels, without near and far planes."""
    camera = sensor_of(world)
    position, quaternion = camera.caster.pose()
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, quaternion)
    rays = camera.directions @ axes.reshape(3, 3).T
    geom, distance = np.zeros(len(rays), np.int32), np.zeros(len(rays))
    groups = np.array((0, 1, 0, 0, 0, 0), np.uint8)
    mujoco.mj_multiRay(
        world.model, world.data, position, rays.ravel(), groups, True, -1, geom, distance, None, len(rays), 1e10
    )  # fmt: skip
    return distance, geom


@pytest.mark.parametrize("many", [1000, 10**6])
@pytest.mark.parametrize("fov", [0.7, 2.6])
def test_every_pixel_meets_what_mujocos_rays_meet(many: int, fov: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.rendering.tiles._MANY_PIXELS", many)
    floor = thing("floor", "0 0 -3 0 0 0", "<plane><normal>0 0 1</normal><size>200 200</size></plane>")
    world = World.from_string(
        "<sdf version='1.10'><world name='w'><plugin name='gz::sim::systems::Sensors'/>"
        f"{eye(width=123, height=101, fov=fov, near=1e-4, far=1e4)}{floor}{clutter(5, 42)}</world></sdf>"
    )
    view = sensor_of(world).cast()
    distance, geom = bare(world)
    same = view.geom == geom
    assert len(np.unique(geom)) >= 10
    # Only pixels on an edge may fall on either side of it.
    assert same.mean() > 0.999
    assert view.distance[same] == pytest.approx(distance[same], rel=1e-4, abs=1e-4)


def test_near_and_far_planes_and_hidden_parts_are_those_of_single_rays() -> None:
    world = World.from_string(
        "<sdf version='1.10'><world name='w'><plugin name='gz::sim::systems::Sensors'/>"
        f"{eye(width=60, height=50, near=1.0, far=3.0)}{clutter(6, 42, 1.5)}</world></sdf>"
    )
    camera = sensor_of(world)
    view = camera.cast()
    distance, geom = view.distance, view.geom
    position, quaternion = camera.caster.pose()
    axes = np.zeros(9)
    mujoco.mju_quat2Mat(axes, quaternion)
    rays = camera.directions @ axes.reshape(3, 3).T
    groups = np.array((0, 1, 0, 0, 0, 0), np.uint8)
    met = np.zeros(1, np.int32)
    wrong = 0
    for ray in range(0, len(rays), 7):
        near, far = 1.0 / camera.directions[ray, 0], 3.0 / camera.directions[ray, 0]
        beyond = mujoco.mj_ray(world.model, world.data, position + near * rays[ray], rays[ray], groups, True, -1, met)
        expected = near + beyond if 0.0 <= beyond < far - near else -1.0
        wrong += abs(distance[ray] - expected) > 1e-3 or geom[ray] != (met[0] if expected > 0.0 else -1)
    assert wrong <= 2 and (geom >= 0).mean() > 0.2


def test_a_picture_of_any_size_is_put_together_again() -> None:
    for width, height in ((1, 1), (7, 9), (64, 48), (401, 403)):
        count = width * height
        rays = np.tile((1.0, 0.0, 0.0), (count, 1))
        tiles = Tiles(width, height, rays, np.zeros(count), np.ones(count))
        numbers = np.arange(count, dtype=np.float64)
        assert (tiles.joined(tiles.cut(numbers)) == numbers).all()


def test_one_tile_at_a_time_gives_the_same_pixels(monkeypatch: pytest.MonkeyPatch) -> None:
    text = (
        "<sdf version='1.10'><world name='w'><plugin name='gz::sim::systems::Sensors'/><light name='s' "
        "type='directional'><cast_shadows>1</cast_shadows><direction>.3 .2 -1</direction></light>"
        f"{eye(width=100, height=70)}{clutter(7, 20)}</world></sdf>"
    )
    whole = sensor_of(World.from_string(text)).image()
    monkeypatch.setattr("gz_course.sim.gz.sim.rendering.tile_caster._TILES_AT_ONCE", 8)
    assert (sensor_of(World.from_string(text)).image() == whole).all()
