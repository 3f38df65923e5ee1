"""gz.msgs.Scene: the content of a world in a message."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from gz_course.sim.gz.msgs.geometry_pb2 import Geometry
from gz_course.sim.gz.msgs.joint_pb2 import Joint
from gz_course.sim.gz.msgs.light_pb2 import Light
from gz_course.sim.gz.msgs.material_pb2 import Material
from gz_course.sim.gz.msgs.sensor_noise_pb2 import SensorNoise
from gz_course.sim.gz.sim.scene.message import scene_message
from gz_course.sim.gz.sim.world import World


def named(parts: Any, name: str) -> Any:
    return next(part for part in parts if part.name == name)


def vector(field: Any) -> tuple[float, ...]:
    return tuple(getattr(field, axis) for axis in "xyz")


def colour(field: Any) -> Any:
    return pytest.approx((field.r, field.g, field.b, field.a))


def link_of(world: World, model: str, link: str) -> Any:
    return named(named(scene_message(world).model, model).link, link)


def test_the_scene_itself(world: World) -> None:
    scene = scene_message(world)
    assert scene.name == "w"
    assert colour(scene.ambient) == (0.1, 0.2, 0.3, 1)
    assert colour(scene.background) == (0.4, 0.5, 0.6, 1)
    assert (scene.grid, scene.shadows) == (False, True)
    assert scene.sky.wind_speed == 12
    assert [model.name for model in scene.model] == ["floor", "robot"]
    assert [model.is_static for model in scene.model] == [True, False]


def test_links_of_nested_models_are_in_their_model(world: World) -> None:
    robot = named(scene_message(world).model, "robot")
    assert [link.name for link in robot.link] == ["base", "wheel"]
    (arm,) = robot.model
    assert [link.name for link in arm.link] == ["hand", "finger"]
    assert vector(arm.pose.position) == pytest.approx((0, 0, 1))
    assert arm.id == world.entities.number("model", "robot", "arm")
    assert named(robot.link, "base").canonical
    assert not named(robot.link, "wheel").canonical
    assert named(robot.link, "base").inertial.mass == 3


def test_poses_are_those_of_now(world: World) -> None:
    world.data.qvel[:] = 0.5
    world.step(100)
    robot, pose = named(scene_message(world).model, "robot"), world.truth.pose("robot")
    assert vector(robot.pose.position) == pytest.approx(tuple(pose.position))
    at = robot.pose.orientation
    assert (at.w, at.x, at.y, at.z) == pytest.approx(tuple(pose.quaternion))


def test_visuals(world: World) -> None:
    slab = link_of(world, "floor", "slab")
    (look,) = slab.visual
    assert look.geometry.type == Geometry.PLANE
    assert vector(look.geometry.plane.normal) == (0, 0, 1)
    assert (look.geometry.plane.size.x, look.geometry.plane.size.y) == (20, 30)
    assert (look.transparency, look.cast_shadows, look.is_static) == (0.25, False, True)
    assert colour(look.material.diffuse) == (0.5, 0.6, 0.7, 1)
    assert colour(look.material.ambient) == (0.1, 0.1, 0.1, 1)
    assert (look.parent_name, look.parent_id) == ("slab", slab.id)
    body, head = link_of(world, "robot", "base").visual
    assert vector(body.geometry.box.size) == (1, 2, 3)
    assert vector(body.pose.position) == (0, 0, 0.1)
    assert head.geometry.sphere.radius == 0.5
    assert not head.HasField("material")
    assert head.cast_shadows
    (tyre,) = link_of(world, "robot", "wheel").visual
    assert (tyre.geometry.cylinder.radius, tyre.geometry.cylinder.length) == (0.2, 0.1)


def test_a_colour_that_was_changed_shows(world: World) -> None:
    head = world.description.models[1].links[0].visuals[1]
    world.editor.set_colour(head, (1.0, 0.0, 0.0, 0.5))
    shown = link_of(world, "robot", "base").visual[1]
    assert colour(shown.material.diffuse) == (1, 0, 0, 0.5)


def test_collisions_carry_friction(world: World) -> None:
    (touch,) = link_of(world, "floor", "slab").collision
    assert touch.geometry.type == Geometry.PLANE
    assert touch.surface.friction.mu == 0.6
    assert touch.surface.collide_bitmask == 0xFF


def test_joints(world: World) -> None:
    robot = named(scene_message(world).model, "robot")
    axle = named(robot.joint, "axle")
    assert (axle.type, axle.parent, axle.child) == (Joint.REVOLUTE, "base", "wheel")
    assert (axle.parent_id, axle.child_id) == tuple(named(robot.link, name).id for name in ("base", "wheel"))
    assert vector(axle.axis1.xyz) == pytest.approx((0, 0, 1))
    assert (axle.axis1.limit_lower, axle.axis1.limit_upper, axle.axis1.damping) == (-1, 2, 0.3)
    assert not axle.HasField("axis2")
    assert named(robot.joint, "shoulder").type == Joint.FIXED
    knuckle = named(robot.model[0].joint, "knuckle")
    assert knuckle.child_id == named(robot.model[0].link, "finger").id


def test_an_axis_is_given_in_the_frame_of_the_joint(load_text: Callable[..., World]) -> None:
    world = load_text(
        "<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'>"
        "<pose>0 0 0 0 0 1.5707963267948966</pose><parent>a</parent><child>b</child>"
        "<axis><xyz>1 0 0</xyz></axis></joint></model>"
    )
    (joint,) = scene_message(world).model[0].joint
    assert vector(joint.axis1.xyz) == pytest.approx((1, 0, 0))


def test_joints_between_models_stand_in_the_scene(load_text: Callable[..., World]) -> None:
    world = load_text(
        "<model name='a'><link name='l'/></model><model name='b'><pose>1 0 0 0 0 0</pose><link name='l'/></model>"
        "<joint name='tie' type='ball'><parent>a</parent><child>b</child></joint>"
    )
    scene = scene_message(world)
    (tie,) = scene.joint
    assert (tie.type, tie.parent, tie.child) == (Joint.BALL, "a::l", "b::l")
    assert (tie.parent_id, tie.child_id) == tuple(model.link[0].id for model in scene.model)
    assert tie.id == world.entities.number("joint", "tie") > 0


def test_lights_of_the_world_and_of_links(world: World) -> None:
    (sun,) = scene_message(world).light
    assert (sun.type, sun.id) == (Light.DIRECTIONAL, world.entities.number("light", "sun"))
    assert colour(sun.diffuse) == (0.8, 0.7, 0.6, 1)
    assert math.hypot(*vector(sun.direction)) == pytest.approx(1)
    assert (sun.cast_shadows, sun.is_light_off, sun.intensity) == (True, False, 1)
    base = link_of(world, "robot", "base")
    (lamp,) = base.light
    assert (lamp.type, lamp.parent_id) == (Light.SPOT, base.id)
    assert (lamp.spot_inner_angle, lamp.spot_outer_angle) == pytest.approx((0.1, 0.5))
    world.editor.set_light("sun", intensity=0.25, on=False)
    (sun,) = scene_message(world).light
    assert (sun.intensity, sun.is_light_off) == (0.25, True)


def test_only_some_of_the_models(world: World) -> None:
    scene = scene_message(world, only=[world.entities.number("model", "floor")])
    assert [model.name for model in scene.model] == ["floor"]
    assert not scene.light


def test_a_camera(world: World) -> None:
    (eye,) = link_of(world, "robot", "base").sensor
    assert (eye.type, eye.update_rate, eye.parent) == ("camera", 10, "base")
    assert eye.topic == "/world/w/model/robot/link/base/sensor/eye/image"
    assert eye.camera.horizontal_fov == 1.2
    assert (eye.camera.image_size.x, eye.camera.image_size.y) == (8, 6)


SENSORS = {
    "gpu_lidar": (
        "<lidar><scan><horizontal><samples>7</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>"
        "</scan><range><min>0.1</min><max>9</max></range><noise type='gaussian'><stddev>0.02</stddev></noise></lidar>",
        lambda sensor: (
            (sensor.lidar.horizontal_samples, sensor.lidar.range_max, sensor.lidar.noise.stddev) == (7, 9, 0.02)
        ),
    ),
    "imu": (
        "<imu><angular_velocity><z><noise type='gaussian'><stddev>0.5</stddev></noise></z></angular_velocity></imu>",
        lambda sensor: sensor.imu.angular_velocity.z_noise.type == SensorNoise.GAUSSIAN,
    ),
    "altimeter": (
        "<altimeter><vertical_position><noise type='gaussian'><mean>2</mean></noise></vertical_position></altimeter>",
        lambda sensor: sensor.altimeter.vertical_position_noise.mean == 2,
    ),
    "magnetometer": (
        "<magnetometer><x><noise type='gaussian'><mean>3</mean></noise></x></magnetometer>",
        lambda sensor: sensor.magnetometer.x_noise.mean == 3,
    ),
    "air_pressure": (
        "<air_pressure><pressure><noise type='gaussian'><mean>4</mean></noise></pressure></air_pressure>",
        lambda sensor: sensor.air_pressure.pressure_noise.mean == 4,
    ),
    "navsat": (
        "<navsat><position_sensing><vertical><noise type='gaussian'><mean>5</mean></noise></vertical>"
        "</position_sensing></navsat>",
        lambda sensor: sensor.gps.position.vertical_noise.mean == 5,
    ),
    "contact": (
        "<contact><collision>c</collision></contact>",
        lambda sensor: sensor.contact.collision_name == "c",
    ),
    "logical_camera": (
        "<logical_camera><near>0.5</near><far>6</far></logical_camera>",
        lambda sensor: (sensor.logical_camera.near_clip, sensor.logical_camera.far_clip) == (0.5, 6),
    ),
}


@pytest.mark.parametrize("kind", SENSORS)
def test_what_is_special_to_a_sensor(load_text: Callable[..., World], kind: str) -> None:
    inside, as_wanted = SENSORS[kind]
    collision = "<collision name='c'><geometry><sphere/></geometry></collision>"
    world = load_text(
        f"<model name='m'><link name='l'>{collision}<sensor name='s' type='{kind}'>{inside}</sensor></link></model>"
    )
    (sensor,) = link_of(world, "m", "l").sensor
    assert sensor.type == kind
    assert as_wanted(sensor), sensor


SHAPES = {
    "<box><size>1 2 3</size></box>": lambda shape: vector(shape.box.size) == (1, 2, 3),
    "<sphere><radius>2</radius></sphere>": lambda shape: shape.sphere.radius == 2,
    "<cylinder><radius>1</radius><length>4</length></cylinder>": lambda shape: (
        (shape.cylinder.radius, shape.cylinder.length) == (1, 4)
    ),
    "<capsule><radius>1</radius><length>4</length></capsule>": lambda shape: (
        (shape.capsule.radius, shape.capsule.length) == (1, 4)
    ),
    "<cone><radius>1</radius><length>4</length></cone>": lambda shape: (shape.cone.radius, shape.cone.length) == (1, 4),
    "<ellipsoid><radii>1 2 3</radii></ellipsoid>": lambda shape: vector(shape.ellipsoid.radii) == (1, 2, 3),
    "<polyline><point>0 0</point><point>1 0</point><point>1 1</point><height>2</height></polyline>": lambda shape: (
        (shape.polyline[0].height, len(shape.polyline[0].point), shape.polyline[0].point[2].y) == (2, 3, 1)
    ),
}


@pytest.mark.parametrize("text", SHAPES)
def test_shapes(load_text: Callable[..., World], text: str) -> None:
    world = load_text(
        f"<model name='m'><link name='l'><visual name='v'><geometry>{text}</geometry></visual></link></model>"
    )
    (visual,) = link_of(world, "m", "l").visual
    assert Geometry.Type.Name(visual.geometry.type).lower() == text[1 : text.index(">")]
    assert SHAPES[text](visual.geometry), visual


def test_a_mesh_is_named_by_its_file(tmp_path: Path, load_text: Callable[..., World]) -> None:
    mesh = tmp_path / "thing.obj"
    mesh.write_text("o part\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
    world = load_text(
        f"<model name='m'><link name='l'><visual name='v'><geometry><mesh><uri>{mesh}</uri><scale>2 2 2</scale>"
        "</mesh></geometry></visual></link></model>"
    )
    shape = link_of(world, "m", "l").visual[0].geometry
    assert (shape.type, shape.mesh.filename, vector(shape.mesh.scale)) == (Geometry.MESH, str(mesh), (2, 2, 2))


def test_textures_and_workflows(load_text: Callable[..., World]) -> None:
    world = load_text(
        "<model name='m'><link name='l'><visual name='v'><geometry><sphere/></geometry><material>"
        "<specular>0.1 0.2 0.3 1</specular><emissive>0 1 0 1</emissive><lighting>false</lighting>"
        "<double_sided>true</double_sided><script><uri>file://a</uri><name>Gazebo/Red</name></script>"
        "<pbr><metal><albedo_map>missing.png</albedo_map><metalness>0.3</metalness><roughness>0.9</roughness>"
        "<light_map uv_set='2'>light.png</light_map></metal></pbr></material></visual></link></model>"
    )
    material = link_of(world, "m", "l").visual[0].material
    assert colour(material.specular) == (0.1, 0.2, 0.3, 1)
    assert colour(material.emissive) == (0, 1, 0, 1)
    assert (material.lighting, material.double_sided) == (False, True)
    assert colour(material.diffuse) == (1, 0, 0, 1)
    assert (material.script.name, list(material.script.uri)) == ("Gazebo/Red", ["file://a"])
    assert material.pbr.type == Material.PBR.METAL
    assert (material.pbr.albedo_map, material.pbr.metalness, material.pbr.roughness) == ("missing.png", 0.3, 0.9)
    assert (material.pbr.light_map, material.pbr.light_map_texcoord_set) == ("light.png", 2)


def test_nonsense_in_a_material_costs_one_sentence_and_not_the_scene(load_text: Callable[..., World]) -> None:
    world = load_text(
        "<model name='m'><link name='l'><visual name='v'><geometry><sphere/></geometry><material>"
        "<diffuse>1 0 0</diffuse><emissive>bright</emissive></material></visual></link></model>"
    )
    before = len(world.warnings)
    for _ in range(2):
        assert link_of(world, "m", "l").visual[0].geometry.type == Geometry.SPHERE
    (sentence,) = world.warnings[before:]
    assert "<emissive> needs 3 numbers, got 'bright'" in sentence
    assert sentence.count("<string>:") == 1


def test_every_world_that_is_built_in_has_a_scene() -> None:
    from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_WORLDS

    for path in sorted(BUILT_IN_WORLDS.glob("*.sdf")):
        world = World.load(path)
        scene = scene_message(world)
        assert [model.name for model in scene.model] == [model.name for model in world.description.models]
        assert type(scene).FromString(scene.SerializeToString()) == scene
