"""Force-torque sensors against statics and dynamics: weights, levers, frames, a pendulum, contacts; invalid input."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.pose import matrix, quaternion_from_rpy

from .conftest import inertial, sensor_world, sensors_of

Listen = Callable[..., list[Any]]
TOPIC = "/world/w/model/m/joint/j/sensor/s/forcetorque"
GRAVITY = 9.8
FIXED = "<joint name='hold' type='fixed'><parent>world</parent><child>a</child></joint>"


def sensor(frame: str = "sensor", direction: str = "parent_to_child", at: str = "0 0 0 0 0 0", noise: str = "") -> str:
    inside = f"<frame>{frame}</frame><measure_direction>{direction}</measure_direction>{noise}"
    return f"<sensor name='s' type='force_torque'><pose>{at}</pose><force_torque>{inside}</force_torque></sensor>"


def model(
    sensor: str,
    *,
    hold: str = FIXED,
    kind: str = "fixed",
    joint: str = "",
    pose: str = "0 0 0.5 0 0 0",
) -> str:
    """Return a model with link b of 10 kg on link a of 2 kg, which is fixed to the world."""
    return (
        f"<model name='m'><pose>0 0 1 0 0 0</pose>{hold}<link name='a'>{inertial(2)}</link><link name='b'><pose>{pose}"
        f"</pose>{inertial(10)}</link><joint name='j' type='{kind}'>{joint}<parent>a</parent><child>b</child>"
        f"{sensor}</joint></model>"
    )


def read(message: Any) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    force, torque = message.force, message.torque
    return np.array((force.x, force.y, force.z)), np.array((torque.x, torque.y, torque.z))


def measured(listen: Listen, inside: str, steps: int = 20) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    world = sensor_world(inside, "ForceTorque")
    heard = listen(world, TOPIC, "gz.msgs.Wrench")
    world.step(steps)
    assert len(heard) == steps and world.warnings == []
    return read(heard[-1])


def test_the_parent_carries_the_weight_of_the_child(listen: Listen) -> None:
    force, torque = measured(listen, model(sensor()))
    assert force == pytest.approx((0, 0, 98)) and torque == pytest.approx((0, 0, 0), abs=1e-9)


def test_by_default_it_is_what_the_child_does_to_the_parent_along_the_childs_axes(listen: Listen) -> None:
    plain = "<sensor name='s' type='force_torque'/>"
    force, _ = measured(listen, model(plain, pose="0 0 0.5 1.5707963267948966 0 0"))
    # The child is rotated so that its y axis points up.
    assert force == pytest.approx((0, -98, 0), abs=1e-9)


def test_torque_is_about_the_sensor(listen: Listen) -> None:
    # The weight is 0.1 m behind the sensor, which requires a torque about y.
    _, torque = measured(listen, model(sensor(at="0.1 0 0 0 0 0")))
    assert torque == pytest.approx((0, 0.1 * 98, 0))
    _, torque = measured(listen, model(sensor(at="0 0.1 0.7 0 0 0")))
    assert torque == pytest.approx((-0.1 * 98, 0, 0))


@pytest.mark.parametrize(("frame", "rpy"), [("parent", (0, 0, 0)), ("child", (0.4, 0, 0)), ("sensor", (0.4, 0.3, 0))])
def test_frames(listen: Listen, frame: str, rpy: tuple[float, float, float]) -> None:
    turn = matrix(quaternion_from_rpy(0.4, 0, 0))
    if frame == "sensor":
        turn = turn @ matrix(quaternion_from_rpy(0, 0.3, 0))
    turn = np.eye(3) if frame == "parent" else turn
    tilted = model(sensor(frame, at="0.1 0 0 0 0.3 0"), pose="0 0 0.5 0.4 0 0")
    force, torque = measured(listen, tilted)
    assert force == pytest.approx(turn.T @ (0, 0, 98), abs=1e-9)
    # The sensor is at 0.1 m on the child's x axis, about which the child is tilted.
    assert torque == pytest.approx(turn.T @ (0, 9.8, 0), abs=1e-9)


def test_the_point_of_measurement_may_be_moved_with_the_joint(listen: Listen) -> None:
    shifted = model(sensor(at="0 0.2 0 0 0 0"), joint="<pose>0.1 0 0 0 0 1.5707963267948966</pose>")
    _, torque = measured(listen, shifted)
    # Joint 0.1 ahead and rotated to the left, sensor 0.2 to its left: at (-0.1, 0) of the child, with rotated axes.
    assert torque == pytest.approx((-0.1 * 98, 0, 0), abs=1e-9)


def test_a_swinging_pendulum_pulls_with_its_weight_and_its_speed(listen: Listen) -> None:
    radius = 0.5
    swing = model(
        sensor("child"), kind="revolute", pose=f"0 0 -{radius} 0 0 0",
        joint=f"<pose>0 0 {radius} 0 0 0</pose><axis><xyz>0 1 0</xyz></axis>",
    )  # fmt: skip
    world = sensor_world(swing, "ForceTorque")
    world.data.qpos[0] = 1.0
    heard = listen(world, TOPIC, "gz.msgs.Wrench")
    for _ in range(20):
        world.step(49)
        angle, rate = float(world.data.qpos[0]), float(world.data.qvel[0])
        world.step(1)
        force, torque = read(heard[-1])
        # Along the rod: m (g cos + w^2 r); across it: the force for the rotation of the bob, I alpha / r.
        alpha = -10 * GRAVITY * radius * math.sin(angle) / (0.1 + 10 * radius**2)
        across = -0.1 * alpha / radius
        assert force == pytest.approx((-across, 0, 10 * (GRAVITY * math.cos(angle) + rate**2 * radius)), abs=1e-6)
        assert torque == pytest.approx((0, 0, 0), abs=1e-6)


PLATE = "<collision name='c'><geometry><box><size>{}</size></box></geometry></collision></link>"
SCALE = (
    "<include><uri>model://ground_plane</uri></include>"
    f"<model name='m'><link name='a'><pose>0 0 0.05 0 0 0</pose>{inertial(5)}{PLATE.format('1 1 0.1')}"
    f"<link name='b'><pose>0 0 0.15 0 0 0</pose>{inertial(1)}{PLATE.format('1 1 0.1')}"
    f"<joint name='j' type='fixed'><parent>a</parent><child>b</child>{sensor()}</joint></model>"
    f"<model name='weight'><pose>0.2 0 0.3 0 0 0</pose><link name='l'>{inertial(3)}"
    f"{PLATE.format('0.2 0.2 0.2')}</model>"
)


def test_scales_weigh_what_lies_on_them(listen: Listen) -> None:
    world = sensor_world(SCALE, "ForceTorque")
    world.step(1000)
    heard = listen(world, TOPIC, "gz.msgs.Wrench")
    world.step(200)
    forces = np.array([read(message) for message in heard])
    assert forces[:, 0].mean(axis=0) == pytest.approx((0, 0, (1 + 3) * GRAVITY), abs=0.01)
    assert forces[:, 1].mean(axis=0) == pytest.approx((0, -0.2 * 3 * GRAVITY, 0), abs=0.01)


def test_models_inside_one_model_lie_on_each_other(listen: Listen) -> None:
    """A scale and a weight, both nested: no joint connects them, so they touch; links of each of them do not."""
    ground, scale, weight = SCALE.replace("<model", "\0<model").split("\0")
    inside = scale.replace("'m'", "'scale'") + weight
    world = sensor_world(f"{ground}<model name='m'>{inside}</model>", "ForceTorque")
    world.step(1000)
    heard = listen(world, TOPIC.replace("/joint/", "/model/scale/joint/"), "gz.msgs.Wrench")
    world.step(200)
    forces = np.array([read(message)[0] for message in heard])
    assert forces.mean(axis=0) == pytest.approx((0, 0, (1 + 3) * GRAVITY), abs=0.01)


def test_a_link_without_gravity_weighs_nothing(listen: Listen) -> None:
    light = model(sensor(at="0.1 0 0 0 0 0")).replace("<link name='b'>", "<link name='b'><gravity>0</gravity>")
    force, torque = measured(listen, light)
    assert force == pytest.approx((0, 0, 0), abs=1e-9) and torque == pytest.approx((0, 0, 0), abs=1e-9)


def test_in_free_fall_nothing_is_transmitted(listen: Listen) -> None:
    force, torque = measured(listen, model(sensor(), hold=""))
    assert force == pytest.approx((0, 0, 0), abs=1e-9) and torque == pytest.approx((0, 0, 0), abs=1e-9)


def test_a_joint_of_the_world_and_a_static_model(listen: Listen) -> None:
    held = FIXED.replace("hold", "j").replace("</joint>", f"{sensor()}</joint>")
    alone = f"<model name='m'>{held}<link name='a'>{inertial(2)}</link></model>"
    force, _ = measured(listen, alone)
    assert force == pytest.approx((0, 0, 2 * GRAVITY))
    force, _ = measured(listen, model(sensor()).replace("<pose>", "<static>1</static><pose>", 1))
    assert (force == 0).all()


def test_noise_of_each_axis(listen: Listen) -> None:
    gaussian = "<noise type='gaussian'><mean>0</mean><stddev>{}</stddev></noise>"
    noise = f"<force><x>{gaussian.format(2)}</x></force><torque><z>{gaussian.format(0.5)}</z></torque>"
    world = sensor_world(model(sensor(noise=noise)), "ForceTorque")
    heard = listen(world, TOPIC, "gz.msgs.Wrench")
    world.step(2000)
    values = np.array([np.concatenate(read(message)) for message in heard])
    assert values.std(axis=0) == pytest.approx((2, 0, 0, 0, 0, 0.5), rel=0.05, abs=1e-9)
    assert {each.key for each in heard[0].header.data} == {"frame_id", "seq"}
    assert heard[0].header.data[0].value[0] == "m::j::s"


def test_in_nested_models_names_carry_the_scope(listen: Listen) -> None:
    inner = model(sensor()).replace("name='m'", "name='arm'").replace(FIXED, "")
    hold = "<joint name='hold' type='fixed'><parent>world</parent><child>arm::a</child></joint>"
    world = sensor_world(f"<model name='m'>{inner}{hold}</model>", "ForceTorque")
    heard = listen(world, "/world/w/model/m/model/arm/joint/j/sensor/s/forcetorque", "gz.msgs.Wrench")
    world.step()
    assert read(heard[0])[0] == pytest.approx((0, 0, 98))
    assert heard[0].header.data[0].value[0] == "m::arm::j::s"
    assert world.entities.number("sensor", "m", "arm::j", "s") > 0


def test_looking_changes_no_truth(listen: Listen) -> None:
    ends = []
    for hear in (False, True):
        world = sensor_world(SCALE, "ForceTorque")
        if hear:
            heard = listen(world, TOPIC, "gz.msgs.Wrench")
        world.step(300)
        world.truth.refresh()
        ends.append(b"".join(each.tobytes() for each in (world.data.qpos, world.data.qvel, world.data.xpos)))
    assert len(heard) == 300 and ends[0] == ends[1]


def test_after_a_spawn_it_measures_on(listen: Listen) -> None:
    world = sensor_world(model(sensor()), "ForceTorque")
    heard = listen(world, TOPIC, "gz.msgs.Wrench")
    world.step(5)
    world.editor.spawn(f"<sdf version='1.10'><model name='n'><link name='l'>{inertial(50)}</link></model></sdf>")
    world.step(5)
    assert read(heard[-1])[0] == pytest.approx((0, 0, 98))


def test_a_sensor_on_a_link_is_warned_about() -> None:
    world = sensor_world(f"\n\n<model name='m'><link name='l'>{inertial()}{sensor()}</link></model>", "ForceTorque")
    (warning,) = world.warnings
    assert warning.startswith("<string>:3: ") and "must stand in a <joint>" in warning and "'l'" in warning
    world.step(3)


def test_a_joint_that_closes_a_loop_is_warned_about() -> None:
    """The links are connected as a - b and a - c - b."""
    c = f"<link name='c'>{inertial()}</link><joint name='to_c' type='fixed'><parent>a</parent><child>c</child></joint>"
    loop = f"<joint name='k' type='fixed'><parent>c</parent><child>b</child>{sensor()}</joint></model>"
    world = sensor_world(model("").replace("</model>", c + loop), "ForceTorque")
    assert any("closes a loop" in warning for warning in world.warnings)
    world.step(3)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("<sensor name='s'/>", "needs a type"),
        (sensor() + sensor(), "already has a <sensor> called 's'"),
    ],
)
def test_bad_input_names_its_line(text: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=rf"^<string>:2: .*{sentence}"):
        sensor_world("\n" + model(text), "ForceTorque")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (sensor(frame="childd"), "<frame> 'childd' is not known; did you mean 'child'"),
        (sensor(direction="parent_to_chidl"), "did you mean 'parent_to_child'"),
    ],
)
def test_a_frame_or_direction_that_is_not_known_leaves_the_sensor_out(text: str, sentence: str) -> None:
    world = sensor_world("\n" + model(text), "ForceTorque")
    (warning,) = world.warnings
    assert warning.startswith("<string>:2: ") and sentence in warning and sensors_of(world) == []
