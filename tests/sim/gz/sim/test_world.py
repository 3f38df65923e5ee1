"""The world as a library: time, true state, geometry."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

Load = Callable[..., World]


def test_time_is_exact_integers() -> None:
    world = World.load("lidar_room")
    assert (world.name, world.step_size_ns, world.iterations, world.sim_time_ns) == (
        "lidar_room",
        1_000_000,
        0,
        0,
    )
    world.step()
    world.step(2999)
    assert (world.iterations, world.sim_time_ns) == (3000, 3_000_000_000)


def test_names_and_truth_at_the_start() -> None:
    world = World.load("lidar_room.sdf")
    assert world.truth.model_names() == ["robot"]
    assert set(world.truth.model_names(static=True)) > {"robot", "ground_plane", "crate"}
    assert tuple(world.truth.pose("robot").position) == (-2, 0, 0)
    assert world.truth.pose("crate").yaw() == pytest.approx(0.5)
    assert tuple(world.truth.link_pose("robot", "lidar_link").position) == pytest.approx((-2, 0, 0.18))
    assert tuple(world.truth.velocity("crate").linear) == (0, 0, 0)


@pytest.mark.parametrize(
    "ask",
    [lambda w: w.truth.pose("robt"), lambda w: w.truth.velocity("robt"), lambda w: w.truth.link_pose("robt", "x")],
)
def test_unknown_models_are_answered_with_the_nearest(ask: Callable[[World], object]) -> None:
    with pytest.raises(SimError, match="did you mean 'robot'"):
        ask(World.load("lidar_room.sdf"))


def test_unknown_links_are_answered_with_the_nearest() -> None:
    with pytest.raises(SimError, match="did you mean 'base_link'"):
        World.load("lidar_room.sdf").truth.link_pose("robot", "baselink")


def test_pose_and_velocity_are_those_of_the_model_frame_not_of_its_link(load_text: Load) -> None:
    world = load_text(
        "<gravity>0 0 0</gravity><model name='m'><pose>1 2 3 0 0 0.3</pose><link name='l'><pose>0 "
        "0.5 0 0 0 1</pose></link></model>"
    )
    assert tuple(world.truth.pose("m").position) == pytest.approx((1, 2, 3))
    assert world.truth.pose("m").yaw() == pytest.approx(0.3)
    world.data.qvel[:] = (0, 0, 0, 0, 0, 2.0)
    world.step(100)
    # The link rotates about itself at 2 rad/s, so the model frame moves around it at 0.5 m.
    velocity = world.truth.velocity("m")
    assert tuple(velocity.angular) == pytest.approx((0, 0, 2))
    assert np.linalg.norm(velocity.linear) == pytest.approx(1.0, rel=1e-6)
    before = world.truth.pose("m").position
    world.step()
    assert world.truth.pose("m").position - before == pytest.approx(velocity.linear * 1e-3, abs=3e-6)


def test_truth_is_of_this_moment_not_of_the_step_before(load_text: Load) -> None:
    world = load_text("<gravity>0 0 0</gravity><model name='m'><link name='l'/></model>")
    world.data.qvel[0] = 1.0
    world.step(1000)
    assert world.truth.pose("m").position[0] == pytest.approx(1.0, abs=1e-9)


def test_geometry_lists_every_visual_with_full_extents(load_text: Load) -> None:
    visual = (
        "<visual name='{0}'><pose>0 0 1 0 0 0</pose><geometry>{1}</geometry><material>"
        "<diffuse>1 0.5 0 1</diffuse></material><transparency>0.5</transparency></visual>"
    )
    shapes = {
        "box": ("<box><size>1 2 3</size></box>", (1, 2, 3)),
        "sphere": ("<sphere><radius>2</radius></sphere>", (4, 4, 4)),
        "cylinder": ("<cylinder><radius>1</radius><length>3</length></cylinder>", (2, 2, 3)),
        "capsule": ("<capsule><radius>1</radius><length>3</length></capsule>", (2, 2, 3)),
        "ellipsoid": ("<ellipsoid><radii>1 2 3</radii></ellipsoid>", (2, 4, 6)),
        "plane": ("<plane><normal>1 0 0</normal><size>5 6</size></plane>", (5, 6, 0)),
    }
    inside = "".join(visual.format(kind, text) for kind, (text, _) in shapes.items())
    world = load_text(f"<model name='m'><static>1</static><link name='l'>{inside}</link></model>")
    listed = {shape.kind: shape for shape in world.truth.geometry()}
    assert {kind: shape.size for kind, shape in listed.items()} == {kind: size for kind, (_, size) in shapes.items()}
    assert listed["box"].rgba == (1, 0.5, 0, 0.5)
    assert (listed["box"].model, listed["box"].link, listed["box"].name) == ("m", "l", "box")
    assert listed["plane"].pose.transform((0, 0, 1)) == pytest.approx((1, 0, 1))


def test_a_world_without_physics_plugin_says_so(load_text: Load, world_text: Callable[..., str]) -> None:
    text = world_text("").replace('<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>', "")
    assert any("not Physics" in warning for warning in World.from_string(text).warnings)
    assert load_text("").warnings == []


def test_unstable_physics_is_an_error_not_a_jump(load_text: Load) -> None:
    world = load_text("<model name='m'><link name='l'/></model>")
    world.data.qvel[:] = math.nan
    with pytest.raises(SimError, match="became unstable"):
        world.step()


def test_a_world_is_attached_to_one_node() -> None:
    with Node(NodeOptions(scope=Scope.PROCESS)) as one, Node(NodeOptions(scope=Scope.PROCESS)) as two:
        world = World.load("lidar_room.sdf", node=one)
        world.attach(one)
        with pytest.raises(SimError, match="already attached"):
            world.attach(two)


def test_commands_from_another_thread_do_not_disturb_stepping() -> None:
    import threading

    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        world = World.load("lidar_room.sdf", node=node)
        publisher = node.advertise("/model/robot/cmd_vel", Twist)
        stop = threading.Event()

        def hammer() -> None:
            command = Twist()
            command.linear.x = 0.3
            while not stop.is_set():
                publisher.publish(command)

        thread = threading.Thread(target=hammer)
        thread.start()
        try:
            world.step(2000)
        finally:
            stop.set()
            thread.join(120)
        assert world.truth.velocity("robot").linear[0] == pytest.approx(0.3, rel=0.01)


@pytest.mark.parametrize("start", [-1.0, 1e300, float("nan")])
def test_a_world_starts_at_a_time_that_can_be(start: float) -> None:
    with pytest.raises(SimError, match="initial_sim_time must be between"):
        World.from_string("<sdf version='1.10'><world name='w'/></sdf>", initial_sim_time=start)


def test_models_in_models_have_a_pose() -> None:
    world = World.from_string(
        "<sdf version='1.10'><world name='w'><gravity>0 0 -10</gravity><model name='arm'><pose>1 0 0 0 0 0</pose>"
        "<link name='l'/><model name='hand'><pose>0 2 0 0 0 1.5</pose><link name='palm'><pose>1 0 0 0 0 0</pose></link>"
        "</model></model></world></sdf>"
    )
    assert world.truth.pose("arm::hand").position == pytest.approx((1.0, 2.0, 0.0))
    world.step(1000)
    fallen = world.truth.pose("arm::hand")
    assert fallen.position == pytest.approx((1.0, 2.0, -5.0), abs=0.01)
    assert fallen.quaternion == pytest.approx((math.cos(0.75), 0.0, 0.0, math.sin(0.75)))
    with pytest.raises(SimError, match="model 'arm' has no model 'hnd'; did you mean 'hand'"):
        world.truth.pose("arm::hnd")
