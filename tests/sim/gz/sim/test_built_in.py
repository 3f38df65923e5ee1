"""The built-in worlds and models: they load without warnings, run, and are listed in the README."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gz_course.sim.gz.sim.world as gz_sim_world
from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.sim.plugins.sensor import sensor_types
from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

ROOM = Path(gz_sim_world.__file__).parent
WORLDS = sorted(path.name for path in (ROOM / "worlds").glob("*.sdf"))
MODELS = sorted(path.name for path in (ROOM / "models").iterdir())
README = (ROOM / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", WORLDS)
def test_a_built_in_world_is_free_of_warnings_and_calm(name: str) -> None:
    world = World.load(name, strict=True)
    world.step(1500)
    assert not world.warnings
    assert np.isfinite(world.data.qpos).all()
    names = world.truth.model_names()
    speeds = [np.linalg.norm(world.truth.velocity(model).linear) for model in names if model != "pendulum"]
    assert all(speed < 2.0 for speed in speeds), dict(zip(names, speeds, strict=False))


@pytest.mark.parametrize("name", MODELS)
def test_a_built_in_model_comes_by_its_name(name: str) -> None:
    text = f"<sdf version='1.10'><world name='w'><include><uri>model://{name}</uri></include></world></sdf>"
    world = World.from_string(text)
    called = {each.lower().replace(" ", "_") for each in world.truth.model_names(static=True)}
    assert name in called | {light.name for light in world.description.lights}
    assert not [warning for warning in world.warnings if "stays silent" not in warning]


# World of Gazebo's -> its name inside, its models (also static ones), some of its topics.
OF_GAZEBO = {
    "diff_drive": ("diff_drive", "vehicle_blue vehicle_green", "/model/vehicle_blue/odometry /model/vehicle_green/tf"),
    "velocity_control": ("velocity_control", "vehicle_blue vehicle_green", "/model/vehicle_blue/cmd_vel"),
    "camera_sensor": ("camera_sensor", "box sphere camera", "/camera /camera_info"),
    "sensors_demo": (
        "lidar_sensor",
        "box cameras_alone camera_with_lidar rgbd_camera thermal_camera",
        "/camera /camera_alone /depth_camera /rgbd_camera/image /rgbd_camera/points /thermal_camera /lidar",
    ),
    "gpu_lidar_sensor": ("gpu_lidar_sensor", "box model_with_lidar Playground", "/lidar /lidar/points"),
    "visualize_lidar": ("visualize_lidar_world", "box model_with_lidar vehicle_blue", "/lidar /lidar2"),
    "spherical_coordinates": ("spherical_coordinates", "NavSat", "/navsat"),
    "tunnel": ("diff_drive", "vehicle tile_0", "/camera /cmd_vel"),
    "triggered_camera_sensor": ("triggered_camera_sensor", "box sphere camera", "/camera /camera/trigger"),
    "linear_battery_demo": (
        "default",
        "vehicle_blue vehicle_green",
        "/model/vehicle_blue/battery/linear_battery/state /model/vehicle_green/battery/linear_battery/state",
    ),
    "apply_joint_force": ("apply_joint_force", "joint_force_example", "/model/joint_force_example/joint/j1/cmd_force"),
    "actor": ("actors", "box camera demo_actor actor_talking actor_walking", "/camera"),
}


@pytest.mark.parametrize("name", OF_GAZEBO)
def test_a_world_of_gazebo_has_its_models_and_topics(name: str, node: Node) -> None:
    world = World.load(f"{name}.sdf", node=node)
    called, models, topics = OF_GAZEBO[name]
    assert world.name == called
    assert {"ground_plane", *models.split()} <= set(world.truth.model_names(static=True))
    assert set(topics.split()) <= set(node.topic_list())


def test_the_vehicle_of_gazebo_drives_within_its_limits(node: Node) -> None:
    world = World.load("diff_drive.sdf", node=node)
    twist = message_class("gz.msgs.Twist")()
    twist.linear.x = 2.0
    world.step(10)
    node.advertise("/model/vehicle_blue/cmd_vel", type(twist)).publish(twist)
    world.step(4000)
    assert world.truth.velocity("vehicle_blue").linear[0] == pytest.approx(0.5, rel=0.05)


def test_everything_stands_in_the_readme() -> None:
    missing = [name for name in (*systems(), *WORLDS) if not re.search(rf"\b{re.escape(name)}\b", README)]
    aliases = {"depth", "gps", "gpu_ray", "ray", "rgbd", "segmentation", "boundingbox", "thermal"}
    missing += [kind for kind in sensor_types() if kind not in aliases and f"`{kind}`" not in README]
    missing += [name for name in MODELS if f"`{name}`" not in README]
    assert not missing


def test_every_sensor_of_the_sensors_world_is_heard(node: Node) -> None:
    world = World.load("sensors.sdf", node=node)
    heard: dict[str, int] = {}

    def listen(topic: str) -> None:
        node.subscribe_raw(topic, lambda data, info: heard.update({topic: heard.get(topic, 0) + 1}))

    mine = [topic for topic in node.topic_list() if not topic.startswith("/world/")]
    assert len(mine) == 31
    for topic in mine:
        listen(topic)
    world.step(1001)
    world.close()
    assert sorted(heard) == sorted(mine)
    assert heard["/imu"] == 101 and heard["/navsat"] == 2 and heard["/camera/image"] == 11


def test_the_cargo_robot_drives_as_it_is_told() -> None:
    world = World.load("warehouse.sdf")
    drive: Any = next(system for system in world.systems if system.name == "DiffDrive")
    drive.command(0.8, 0.0)
    world.step(3000)
    velocity = world.truth.velocity("cargo_robot")
    assert velocity.linear[0] == pytest.approx(0.8, rel=0.005)
    assert abs(world.truth.pose("cargo_robot").position[1]) < 0.001
    drive.command(0.0, 0.0)
    world.step(1500)
    assert np.linalg.norm(world.truth.velocity("cargo_robot").linear) < 1e-3
    assert abs(world.truth.pose("cargo_robot").rpy()[1]) < 0.02
