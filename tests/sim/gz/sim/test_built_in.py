"""The built-in worlds and models: they load without warnings, run, and are listed in the README."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gz_course.sim.gz.sim.world as gz_sim_world
from gz_course.sim.gz.msgs import message_class
from gz_course.sim.gz.msgs.text import from_text
from gz_course.sim.gz.sim.plugins.sensor import sensor_types
from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

ROOM = Path(gz_sim_world.__file__).parent
WORLDS = sorted(path.name for path in (ROOM / "worlds").glob("*.sdf"))
MODELS = sorted(path.name for path in (ROOM / "models").iterdir())
README = (ROOM / "README.md").read_text(encoding="utf-8")
FAST = {
    "rolling_shapes.sdf",
    "auto_inertia_rolling_shapes.sdf",
    "contact_sensor.sdf",
    "buoyancy.sdf",
    "graded_buoyancy.sdf",
}
"""In these worlds something rolls, sinks or rises ever faster."""


@pytest.mark.parametrize("name", WORLDS)
def test_a_built_in_world_is_free_of_warnings_and_calm(name: str) -> None:
    world = World.load(name, strict=True)
    world.step(1500)
    assert not world.warnings
    assert np.isfinite(world.data.qpos).all()
    names = world.truth.model_names()
    speeds = [np.linalg.norm(world.truth.velocity(model).linear) for model in names if model != "pendulum"]
    assert all(speed < 2.0 for speed in speeds) != (name in FAST), dict(zip(names, speeds, strict=False))


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
    "shapes": ("shapes", "box cylinder sphere capsule ellipsoid cone", "/world/shapes/dynamic_pose/info"),
    "pose_publisher": ("pose_publisher", "double_pendulum_with_base", "/model/double_pendulum_with_base/pose"),
    "triggered_publisher": (
        "triggered_publisher",
        "vehicle_blue trigger box1 box2",
        "/start /reset_robot /cmd_vel /trigger/touched /altimeter /box1/detach /box2/detach",
    ),
    "rolling_shapes": ("shapes", "box cylinder sphere capsule ellipsoid", "/world/shapes/dynamic_pose/info"),
    "auto_inertia_rolling_shapes": (
        "auto_inertia_rolling_shapes",
        "inclined_plane cylinder hollow_cylinder sphere capsule",
        "/world/auto_inertia_rolling_shapes/dynamic_pose/info",
    ),
    "auto_inertia_pendulum": ("auto_inertia_pendulum", "pendulum pendulum2", "/world/auto_inertia_pendulum/pose/info"),
    "joint_controller": (
        "default",
        "joint_controller_demo joint_controller_demo_2",
        "/model/joint_controller_demo/joint/j1/cmd_vel /model/joint_controller_demo_2/joint/j1/cmd_vel",
    ),
    "joint_position_controller": ("default", "joint_position_controller_demo", "/rotor_cmd"),
    "contact_sensor": ("contact_sensor", "contact_model", "/contact_example"),
    "touch_plugin": ("touch", "white_box green_box_for_white", "/white_touches_only_green/touched"),
    "detachable_joint": (
        "detachable_joint",
        "vehicle_blue B1 B2 B3",
        "/model/vehicle_blue/cmd_vel /B1/detach /B1/attach /B1/state /B2/state /B3/state",
    ),
    "logical_camera_sensor": ("logical_camera_sensor", "box logical_camera", "/logical_camera"),
    "mecanum_drive": ("mecanum_drive", "vehicle_blue", "/model/vehicle_blue/cmd_vel /model/vehicle_blue/odometry"),
    "ackermann_steering": (
        "ackermann_steering",
        "vehicle_blue",
        "/model/vehicle_blue/cmd_vel /model/vehicle_blue/odometry /model/vehicle_blue/tf",
    ),
    "tracked_vehicle_simple": (
        "default",
        "simple_tracked stairs_very_simple cylinder_obstacle box_obstacle",
        "/model/simple_tracked/cmd_vel /model/simple_tracked/link/left_track/track_cmd_vel",
    ),
    "buoyancy": (
        "buoyancy",
        "submarine submarine_sinking submarine_buoyant",
        "/model/submarine/joint/propeller_joint/cmd_force",
    ),
    "graded_buoyancy": (
        "buoyancy",
        "water_plane lighter_than_water balloon_lighter_than_air box_neutral_buoyancy box_negative_buoyancy "
        "box_neutral_buoyancy_collision_offset multi_collision_neutral_buoyancy box_no_buoyancy",
        "/world/buoyancy/dynamic_pose/info",
    ),
}
WITHOUT_GROUND = {"joint_controller", "joint_position_controller", "buoyancy", "graded_buoyancy"}


@pytest.mark.parametrize("name", OF_GAZEBO)
def test_a_world_of_gazebo_has_its_models_and_topics(name: str, node: Node) -> None:
    world = World.load(f"{name}.sdf", node=node)
    called, models, topics = OF_GAZEBO[name]
    assert world.name == called
    there = set(world.truth.model_names(static=True))
    assert set(models.split()) <= there and ("ground_plane" in there) != (name in WITHOUT_GROUND)
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


def send(node: Node, topic: str, kind: str, text: str = "") -> None:
    message = from_text(text, message_class(kind))
    node.advertise(topic, type(message)).publish(message)


def hear(node: Node, topic: str, kind: str) -> list[Any]:
    heard: list[Any] = []
    node.subscribe(message_class(kind), topic, heard.append)
    return heard


def speed(world: World, joint: str) -> float:
    return float(world.data.qvel[world.model.joint(joint).dofadr[0]])


def test_the_pose_publisher_publishes_both_links_of_the_pendulum(node: Node) -> None:
    world = World.load("pose_publisher.sdf", node=node)
    poses = hear(node, "/model/double_pendulum_with_base/pose", "gz.msgs.Pose")
    world.step(10)
    own = "double_pendulum_with_base"
    assert {pose.name for pose in poses} == {f"{own}::{link}" for link in ("base", "upper_link", "lower_link")}
    assert len(poses) == 30
    world.step(6000)
    assert len({round(pose.orientation.x, 1) for pose in poses if "lower" in pose.name}) > 5, "it swings"
    assert np.linalg.norm(world.truth.pose(own).position) < 0.05


def test_the_triggered_publisher_passes_on_from_one_thing_to_the_next(node: Node) -> None:
    world = World.load("triggered_publisher.sdf", node=node)
    touched = hear(node, "/trigger/touched", "gz.msgs.Boolean")

    def heights() -> list[float]:
        return [round(float(world.truth.pose(box).position[2]), 1) for box in ("box1", "box2")]

    world.step(1000)
    assert heights() == [8.0, 5.0] and not touched
    send(node, "/start", "gz.msgs.Empty")
    world.step(3000)
    assert world.truth.pose("vehicle_blue").position[0] > 5.0 and [each.data for each in touched] == [True]
    assert heights() == [0.5, 5.0]
    world.step(2500)
    assert heights() == [0.5, 5.0], "the second box waits for 5 s"
    world.step(3000)
    assert heights() == [0.5, 0.5]
    send(node, "/reset_robot", "gz.msgs.Empty")
    world.step(3000)
    assert np.linalg.norm(world.truth.velocity("vehicle_blue").linear) < 0.01


def test_round_shapes_roll_and_the_box_is_left_behind() -> None:
    world = World.load("rolling_shapes.sdf")
    world.step(3000)
    ways = {name: -world.truth.pose(name).position[0] for name in world.truth.model_names()}
    assert min(ways.values()) == ways["box"] > 1.0
    assert max(ways.values()) == ways["sphere"] > 10.0
    assert ways["capsule"] > 10.0 and ways["cylinder"] > 10.0 and ways["ellipsoid"] > 5.0


def test_more_inertia_rolls_and_swings_more_slowly() -> None:
    world = World.load("auto_inertia_rolling_shapes.sdf")
    world.step(2000)
    ways = {name: -world.truth.pose(name).position[0] for name in world.truth.model_names()}
    assert ways["sphere"] > ways["capsule"] > ways["cylinder"] > ways["hollow_cylinder"] + 0.3 > 2.0
    world = World.load("auto_inertia_pendulum.sdf")
    turns = {"pendulum": 0, "pendulum2": 0}
    before = dict.fromkeys(turns, 0.0)
    for _ in range(1000):
        world.step(10)
        for name in turns:
            now = speed(world, f"{name}::upper_joint")
            turns[name] += now * before[name] < 0.0
            before[name] = now
    assert turns["pendulum"] > turns["pendulum2"] > 5


def test_rotors_turn_as_they_are_told(node: Node) -> None:
    world = World.load("joint_controller.sdf", node=node)
    world.step(1000)
    assert speed(world, "joint_controller_demo::j1") == pytest.approx(5.0, rel=0.01)
    assert speed(world, "joint_controller_demo_2::j1") == pytest.approx(0.0, abs=0.01)
    for model in ("joint_controller_demo", "joint_controller_demo_2"):
        send(node, f"/model/{model}/joint/j1/cmd_vel", "gz.msgs.Double", "data: -1")
    world.step(2000)
    for model in ("joint_controller_demo", "joint_controller_demo_2"):
        assert speed(world, f"{model}::j1") == pytest.approx(-1.0, rel=0.02)
    world.close()
    world = World.load("joint_position_controller.sdf", node=node)
    world.step(10)
    send(node, "/rotor_cmd", "gz.msgs.Double", "data: -1")
    world.step(8000)
    angle = world.data.qpos[world.model.joint("joint_position_controller_demo::j1").qposadr[0]]
    assert angle == pytest.approx(-1.0, abs=0.05)


def test_a_touch_is_felt_and_a_camera_names_what_it_sees(node: Node) -> None:
    contacts = hear(node, "/contact_example", "gz.msgs.Contacts")
    world = World.load("contact_sensor.sdf", node=node)
    world.step(500)
    assert not any(message.contact for message in contacts)
    world.step(1000)
    names = {each.collision1.name for message in contacts for each in message.contact}
    names |= {each.collision2.name for message in contacts for each in message.contact}
    assert "contact_model::link::collision_sphere" in names
    world.close()
    touched = hear(node, "/white_touches_only_green/touched", "gz.msgs.Boolean")
    world = World.load("touch_plugin.sdf", node=node)
    world.step(3500)
    assert not touched
    world.step(1000)
    assert [each.data for each in touched] == [True]
    world.close()
    seen = hear(node, "/logical_camera", "gz.msgs.LogicalCameraImage")
    world = World.load("logical_camera_sensor.sdf", node=node)
    world.step(1001)
    assert len(seen) >= 10 and "box" in {model.name for model in seen[-1].model}
    world.close()


def test_the_vehicle_drops_what_it_carries_and_takes_it_again(node: Node) -> None:
    world = World.load("detachable_joint.sdf", node=node)
    states = hear(node, "/B1/state", "gz.msgs.StringMsg")
    world.step(1000)
    send(node, "/model/vehicle_blue/cmd_vel", "gz.msgs.Twist", "linear: {x: 0.5}")
    send(node, "/B1/detach", "gz.msgs.Empty")
    world.step(4000)
    positions = {name: world.truth.pose(name).position for name in world.truth.model_names()}
    assert states[-1].data == "detached" and positions["vehicle_blue"][0] > 1.5
    assert positions["B1"][2] == pytest.approx(0.25, abs=0.01) and abs(positions["B1"][0] + 1.5) < 0.2
    assert positions["B2"][2] == pytest.approx(0.5, abs=0.02)
    assert positions["B2"][0] == pytest.approx(positions["vehicle_blue"][0] - 1.5, abs=0.02)
    send(node, "/B1/attach", "gz.msgs.Empty")
    world.step(2000)
    assert states[-1].data == "attached" and world.truth.pose("B1").position[0] > positions["B1"][0] + 0.8


# World -> model, command for 4 s, and the way ahead [m], to the left [m] and round [rad]. The car is longer than its
# <wheel_base>, as in Gazebo, so it turns more slowly than commanded.
DRIVEN = {
    "mecanum_drive": ("vehicle_blue", "linear: {x: 0.25, y: 0.5}", (1.0, 2.0, 0.0)),
    "ackermann_steering": ("vehicle_blue", "linear: {x: 0.5}, angular: {z: 0.1}", (1.95, 0.43, 0.27)),
    "tracked_vehicle_simple": ("simple_tracked", "linear: {x: 0.4}", (1.6, 0.0, 0.0)),
}


@pytest.mark.parametrize("name", DRIVEN)
def test_a_vehicle_of_gazebo_drives(name: str, node: Node) -> None:
    model, command, way = DRIVEN[name]
    world = World.load(f"{name}.sdf", node=node)
    world.step(round(0.5e9 / world.step_size_ns))
    start = world.truth.pose(model)
    send(node, f"/model/{model}/cmd_vel", "gz.msgs.Twist", command)
    world.step(round(4e9 / world.step_size_ns))
    end = world.truth.pose(model)
    ahead, left, _ = np.subtract(end.position, start.position)
    assert (ahead, left, end.rpy()[2]) == pytest.approx(way, abs=0.12)


def test_one_submarine_stays_one_sinks_one_rises_and_the_first_is_driven(node: Node) -> None:
    world = World.load("buoyancy.sdf", node=node)
    world.step(2000)
    depths = [world.truth.pose(f"submarine{kind}").position[2] for kind in ("", "_sinking", "_buoyant")]
    assert abs(depths[0]) < 0.01 and depths[1] < -2.0 and depths[2] > 2.0
    send(node, "/model/submarine/joint/propeller_joint/cmd_force", "gz.msgs.Double", "data: 1.2")
    world.step(8000)
    assert abs(world.truth.pose("submarine").position[1]) > 0.2


def test_what_is_light_floats_between_water_and_air() -> None:
    world = World.load("graded_buoyancy.sdf")
    names = world.truth.model_names()
    before = {name: world.truth.pose(name).position[2] for name in names}
    world.step(3000)
    rise = {name: float(world.truth.pose(name).position[2] - before[name]) for name in names}
    assert rise.pop("balloon_lighter_than_air") > 10.0 and rise.pop("lighter_than_water") == pytest.approx(0, abs=0.2)
    assert rise.pop("box_no_buoyancy") < rise.pop("box_negative_buoyancy") < -2.0
    assert len(rise) == 3 and list(rise.values()) == pytest.approx([0.0] * 3, abs=0.01)
