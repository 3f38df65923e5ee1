"""The IMU against mechanics: rest, free fall, circles, reference frames; its message and noise."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.pose import matrix, quaternion_from_rpy
from gz_course.sim.gz.sim.sensors.imu import Imu
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

from .conftest import inertial, sensor_world, sensors_of

Listen = Callable[..., list[Any]]
TOPIC = "/world/w/model/m/link/l/sensor/s/imu"
GRAVITY = 9.8


def imu(inside: str = "", rate: float = 0, pose: str = "0 0 0 0 0 0") -> str:
    return f"<sensor name='s' type='imu'><pose>{pose}</pose><update_rate>{rate}</update_rate>{inside}</sensor>"


def model(sensor: str, pose: str = "0 0 1 0 0 0", extra: str = "") -> str:
    return f"<model name='m'><pose>{pose}</pose>{extra}<link name='l'>{inertial()}{sensor}</link></model>"


def vector(message: Any) -> np.ndarray[Any, Any]:
    return np.array((message.x, message.y, message.z))


def turn(message: Any) -> np.ndarray[Any, Any]:
    """Return the matrix that rotates the sensor's coordinates into those of the reference frame."""
    return matrix(np.array((message.w, message.x, message.y, message.z)))


@settings(max_examples=15, deadline=None)
@given(st.tuples(*[st.floats(-3.1, 3.1)] * 3))
def test_a_static_imu_feels_gravity_along_its_own_axes(rpy: tuple[float, float, float]) -> None:
    world = sensor_world(model(imu(), pose="1 2 3 {} {} {}".format(*map(repr, rpy)), extra="<static>1</static>"), "Imu")
    world.step()
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    linear, angular = sensor.motion.velocity(local=True)
    assert (linear == 0).all() and (angular == 0).all()
    up = matrix(quaternion_from_rpy(*rpy)).T @ (0, 0, GRAVITY)
    # MuJoCo takes a quaternion within 1e-6 of no turn for no turn.
    assert sensor.motion.specific_force() == pytest.approx(up, abs=1e-4)


def test_in_free_fall_nothing_is_felt_but_the_spin(listen: Listen) -> None:
    world = sensor_world(model(imu(pose="0.3 0 0 0 0 1.5707963267948966")), "Imu")
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.data.qvel[:] = (1, 2, 3, 0, 0, 2.5)
    world.step(300)
    for message in heard:
        # The sensor's y axis points to the centre of its circular path.
        assert vector(message.linear_acceleration) == pytest.approx((0, 2.5**2 * 0.3, 0), abs=1e-6)
        assert vector(message.angular_velocity) == pytest.approx((0, 0, 2.5), abs=1e-9)
    assert len(heard) == 300


ARM = f"""<model name='m'><link name='base'>{inertial()}</link><link name='l'><pose>0 0 0.5 0 0 0</pose>{inertial()}
  {{sensor}}</link><joint name='fixed' type='fixed'><parent>world</parent><child>base</child></joint>
  <joint name='hinge' type='revolute'><parent>base</parent><child>l</child><axis><xyz>{{axis}}</xyz></axis></joint>
  </model>"""


@settings(max_examples=10, deadline=None)
@given(st.floats(-6, 6), st.floats(0.1, 2))
def test_on_a_turntable_it_feels_the_centripetal_acceleration(rate: float, radius: float) -> None:
    world = sensor_world(ARM.format(sensor=imu(pose=f"{radius!r} 0 0 0 0 0"), axis="0 0 1"), "Imu")
    world.data.qvel[0] = rate
    world.step(50)
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    linear, angular = sensor.motion.velocity(local=True)
    assert linear == pytest.approx((0, rate * radius, 0), abs=1e-9)
    assert angular == pytest.approx((0, 0, rate), abs=1e-9)
    assert sensor.motion.specific_force() == pytest.approx((-(rate**2) * radius, 0, GRAVITY), abs=1e-6)


def test_on_a_pendulum_it_feels_what_the_pendulum_equation_says() -> None:
    # At the distance r below the hinge: g cos(a) + w^2 r along the rod, g sin(a) - |alpha| r across it.
    mass, moment, radius = 1.0, 0.1, 0.8
    hang = f"""<model name='m'><link name='base'>{inertial()}</link>
      <link name='l'><inertial><pose>0 0 -{radius} 0 0 0</pose><mass>{mass}</mass><inertia><ixx>{moment}</ixx>
      <iyy>{moment}</iyy><izz>{moment}</izz></inertia></inertial>{imu(pose=f"0 0 -{radius} 0 0 0")}</link>
      <joint name='fixed' type='fixed'><parent>world</parent><child>base</child></joint>
      <joint name='hinge' type='revolute'><parent>base</parent><child>l</child><axis><xyz>0 1 0</xyz></axis></joint>
      </model>"""
    world = sensor_world(hang, "Imu", step=0.0002)
    world.data.qpos[0] = 1.2
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    for _ in range(20):
        world.step(100)
        angle, rate = float(world.data.qpos[0]), float(world.data.qvel[0])
        slowing = -mass * GRAVITY * radius * math.sin(angle) / (moment + mass * radius**2)
        linear, angular = sensor.motion.velocity(local=True)
        assert angular == pytest.approx((0, rate, 0), abs=1e-12)
        assert linear == pytest.approx((-rate * radius, 0, 0), abs=1e-12)
        # The bob at (0, 0, -r) moves towards -x for a growing angle; at rest it measures (-g sin, 0, g cos).
        expected = (-radius * slowing - GRAVITY * math.sin(angle), 0, GRAVITY * math.cos(angle) + rate**2 * radius)
        assert sensor.motion.specific_force() == pytest.approx(expected, abs=0.01)


def test_standing_on_the_ground_is_steady(listen: Listen) -> None:
    box = "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
    world = sensor_world(
        "<include><uri>model://ground_plane</uri></include>" + model(imu() + box, pose="0 0 0.5 0 0 0"), "Imu"
    )
    world.step(1000)
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.step(500)
    felt = np.array([vector(message.linear_acceleration) for message in heard])
    assert felt.mean(axis=0) == pytest.approx((0, 0, GRAVITY), abs=1e-3)
    assert felt.std(axis=0).max() < 1e-6


ROBOT = f"""<include><uri>model://ground_plane</uri></include><model name='m'><pose>0 0 0.1 0 0 0</pose>
  <link name='l'>{inertial(8)}{{sensor}}<collision name='caster'><pose>-0.2 0 -0.05 0 0 0</pose>
  <geometry><sphere><radius>0.05</radius></sphere></geometry><surface><friction><ode><mu>0</mu></ode></friction></surface>
  </collision></link>{{wheels}}
  <plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'><left_joint>left</left_joint>
  <right_joint>right</right_joint><wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius></plugin>
  </model>"""
WHEEL = f"""<link name='{{side}}_wheel'><pose>0.1 {{y}} 0 -1.5707963267948966 0 0</pose>{inertial(1, 0.005)}
  <collision name='c'><geometry><cylinder><radius>0.1</radius><length>0.04</length></cylinder></geometry>
  </collision></link>
  <joint name='{{side}}' type='revolute'><parent>l</parent><child>{{side}}_wheel</child>
  <axis><xyz>0 0 1</xyz></axis></joint>"""


def test_driving_a_circle_pushes_to_the_side(listen: Listen) -> None:
    wheels = WHEEL.format(side="left", y=0.2) + WHEEL.format(side="right", y=-0.2)
    # The sensor is above the axle, where the velocity is exactly forward.
    world = sensor_world(ROBOT.format(sensor=imu(pose="0.1 0 0.2 0 0 0"), wheels=wheels), "Imu")
    drive = next(each for each in world.systems if each.name == "DiffDrive")
    drive.command(0.5, 0.8)  # type: ignore[attr-defined]
    world.step(3000)
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.step(1000)
    felt = np.array([vector(message.linear_acceleration) for message in heard]).mean(axis=0)
    spin = np.array([vector(message.angular_velocity) for message in heard]).mean(axis=0)
    assert felt == pytest.approx((0, 0.5 * 0.8, GRAVITY), abs=0.01)
    assert spin == pytest.approx((0, 0, 0.8), abs=0.01)


def test_orientation_starts_at_zero_and_turns_with_the_body(listen: Listen) -> None:
    world = sensor_world(model(imu(pose="0 0 0 0.3 0.2 0.1"), pose="0 0 5 0 0 2"), "Imu")
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.data.qvel[5] = 1.0
    world.step(500)
    assert turn(heard[0].orientation) == pytest.approx(np.eye(3), abs=2e-3)
    # The rotation of the body by 0.5 rad about its z axis, in the frame of the tilted sensor.
    tilt = matrix(quaternion_from_rpy(0.3, 0.2, 0.1))
    yaw = matrix(quaternion_from_rpy(0, 0, 0.5))
    assert turn(heard[-1].orientation) == pytest.approx(tilt.T @ yaw @ tilt, abs=1e-6)


FRAMES = {  # where the sensor's axes (here the world's: east, north, up) point in the reference frame
    "ENU": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "NED": ((0, 1, 0), (1, 0, 0), (0, 0, -1)),
    "NWU": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    "CUSTOM": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
}


def reference(inside: str) -> str:
    return imu(f"<imu><orientation_reference_frame>{inside}</orientation_reference_frame></imu>")


@pytest.mark.parametrize("name", sorted(FRAMES))
def test_named_frames(name: str) -> None:
    world = sensor_world(model(reference(f"<localization>{name}</localization>")), "Imu")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    assert pytest.approx(np.array(FRAMES[name]), abs=1e-9) == matrix(sensor.orientation()).T


def test_the_heading_of_the_world_turns_the_named_frames() -> None:
    """The rotation is by +heading, as in Gazebo."""
    place = "<spherical_coordinates><heading_deg>30</heading_deg></spherical_coordinates>"
    world = sensor_world(place + model(reference("<localization>ENU</localization>")), "Imu")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    assert matrix(sensor.orientation()) == pytest.approx(matrix(quaternion_from_rpy(0, 0, -math.pi / 6)))


def test_a_frame_without_localization_is_custom() -> None:
    world = sensor_world(model(reference("<custom_rpy>0 0 0.5</custom_rpy>"), pose="0 0 1 0 0 2"), "Imu")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu) and sensor.localization == "CUSTOM"
    assert matrix(sensor.orientation()) == pytest.approx(matrix(quaternion_from_rpy(0, 0, 1.5)))


@pytest.mark.parametrize(("parent", "yaw"), [("world", 1.5), ("other::l", 0.8), ("m::l", -0.5)])
def test_custom_frames_relative_to_the_world_or_a_link(parent: str, yaw: float) -> None:
    rpy = f"<localization>CUSTOM</localization><custom_rpy parent_frame='{parent}'>0 0 0.5</custom_rpy>"
    other = "<model name='other'><static>1</static><pose>0 0 0 0 0 0.7</pose><link name='l'/></model>"
    world = sensor_world(model(reference(rpy), pose="0 0 1 0 0 2") + other, "Imu")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    assert matrix(sensor.orientation()) == pytest.approx(matrix(quaternion_from_rpy(0, 0, yaw)))


def test_gravity_frames() -> None:
    ahead = "<grav_dir_x parent_frame='world'>0 2 7</grav_dir_x>"
    for name, axes in {
        # The reference x axis is north; up: y is west; down: y is east.
        "GRAV_UP": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
        "GRAV_DOWN": ((0, 1, 0), (1, 0, 0), (0, 0, -1)),
    }.items():
        world = sensor_world(model(reference(f"<localization>{name}</localization>{ahead}")), "Imu")
        (sensor,) = sensors_of(world)
        assert isinstance(sensor, Imu)
        assert pytest.approx(np.array(axes), abs=1e-9) == matrix(sensor.orientation()).T


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<localization>NEDD</localization>", "did you mean 'NED'"),
        ("<custom_rpy parent_frame='m::k'>0 0 0</custom_rpy>", "did you mean 'm::l'"),
        ("<localization>GRAV_UP</localization><grav_dir_x parent_frame='world'>0 0 1</grav_dir_x>", "not parallel"),
    ],
)
def test_frames_that_make_no_sense_are_warned_about(inside: str, sentence: str) -> None:
    world = sensor_world(model(reference(inside), pose="0 0 1 0 0 2"), "Imu")
    (warning,) = world.warnings
    assert sentence in warning and warning.startswith("<string>:1:")
    (sensor,) = sensors_of(world)
    assert isinstance(sensor, Imu)
    assert matrix(sensor.orientation()) == pytest.approx(np.eye(3))


def axis_noise(**channels: str) -> str:
    def group(name: str) -> str:
        inside = "".join(f"<{k[-1]}>{v}</{k[-1]}>" for k, v in channels.items() if k.startswith(name[0]))
        return f"<{name}>{inside}</{name}>"

    return f"<imu>{group('angular_velocity')}{group('linear_acceleration')}</imu>"


def gaussian(stddev: float, extra: str = "") -> str:
    return f"<noise type='gaussian'><mean>0</mean><stddev>{stddev}</stddev>{extra}</noise>"


def test_message(listen: Listen) -> None:
    noise = axis_noise(ax=gaussian(0.1), lz=gaussian(0.5))
    world = sensor_world(model(imu(noise, rate=100)), "Imu")
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.step(100)
    assert [message.header.stamp.nsec // 1_000_000 for message in heard] == [1, *range(10, 101, 10)]
    message = heard[-1]
    assert message.entity_name == "m::l::s"
    assert {each.key: list(each.value) for each in message.header.data} == {"frame_id": ["m::l::s"], "seq": ["10"]}
    assert list(message.angular_velocity_covariance.data) == pytest.approx([0.01, 0, 0, 0, 0, 0, 0, 0, 0], abs=1e-9)
    assert list(message.linear_acceleration_covariance.data) == pytest.approx([0] * 8 + [0.25])
    assert list(message.orientation_covariance.data) == [0] * 9


def test_orientation_can_be_left_out(listen: Listen) -> None:
    world = sensor_world(model(imu("<imu><enable_orientation>0</enable_orientation></imu>")), "Imu")
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.step()
    assert not heard[0].HasField("orientation") and heard[0].HasField("angular_velocity")


def test_noise_is_that_of_the_file_axis_by_axis(listen: Listen) -> None:
    bias = "<bias_mean>3</bias_mean><bias_stddev>0.001</bias_stddev>"
    noise = axis_noise(ax=gaussian(0.1), ly=gaussian(0.5), lz=gaussian(0, bias))
    world = sensor_world(model(imu(noise), extra="<static>1</static>"), "Imu")
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.step(3000)
    turning = np.array([vector(message.angular_velocity) for message in heard])
    pushing = np.array([vector(message.linear_acceleration) for message in heard])
    assert turning.std(axis=0) == pytest.approx((0.1, 0, 0), rel=0.05)
    assert pushing.std(axis=0) == pytest.approx((0, 0.5, 0), rel=0.05, abs=1e-12)
    assert abs(pushing[0, 2] - GRAVITY) == pytest.approx(3, abs=0.01)
    assert abs(np.corrcoef(turning[:, 0], pushing[:, 1])[0, 1]) < 0.1


WANDERING = axis_noise(
    ax=gaussian(
        0.1,
        "<bias_mean>1</bias_mean><bias_stddev>1</bias_stddev><dynamic_bias_stddev>5</dynamic_bias_stddev>"
        "<dynamic_bias_correlation_time>2</dynamic_bias_correlation_time>",
    )
)


def test_numbers_do_not_depend_on_who_listened_before() -> None:
    def values(seed: int, listen_from: int, *, rebuilt: bool = False) -> list[float]:
        from gz_course.sim.gz.msgs.imu_pb2 import IMU

        heard: list[float] = []
        with Node(NodeOptions(scope=Scope.PROCESS)) as own:
            world = sensor_world(model(imu(WANDERING, rate=100)), "Imu", seed=seed, node=own)
            world.step(listen_from)
            if rebuilt:
                new = "<model name='n'><static>1</static><link name='l'/></model>"
                world.editor.spawn(f"<sdf version='1.10'>{new}</sdf>")
            own.subscribe(IMU, TOPIC, lambda message: heard.append(message.angular_velocity.x))
            world.step(1000 - listen_from)
            world.close()
        return heard

    whole = values(3, 0)
    assert len(set(whole)) == 101
    assert values(3, 0) == whole
    assert values(3, 505) == whole[-50:]
    assert values(3, 505, rebuilt=True) == whole[-50:]
    assert values(4, 0) != whole


def test_a_reset_begins_the_same_run_again(listen: Listen) -> None:
    world = sensor_world(model(imu(WANDERING, rate=100), extra="<static>1</static>"), "Imu")
    heard = listen(world, TOPIC, "gz.msgs.IMU")
    world.step(200)
    first = [message.angular_velocity.x for message in heard]
    heard.clear()
    world.reset()
    world.step(200)
    assert [message.angular_velocity.x for message in heard] == first


def test_listening_changes_no_truth(listen: Listen) -> None:
    ends = []
    for hear in (False, True):
        box = "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
        world = sensor_world(
            "<include><uri>model://ground_plane</uri></include>" + model(imu() + box, pose="0 0 0.7 0.3 0 0"), "Imu"
        )
        if hear:
            heard = listen(world, TOPIC, "gz.msgs.IMU")
        world.step(500)
        ends.append(world.data.qpos.tobytes() + world.data.qvel.tobytes())
    assert len(heard) == 500 and ends[0] == ends[1]


def test_in_nested_models_names_carry_the_scope(listen: Listen) -> None:
    nested = f"<model name='m'><model name='arm'><link name='l'>{inertial()}{imu()}</link></model></model>"
    world = sensor_world(nested, "Imu")
    heard = listen(world, "/world/w/model/m/model/arm/link/l/sensor/s/imu", "gz.msgs.IMU")
    world.step()
    assert heard[0].entity_name == "m::arm::l::s"


def test_two_imus_on_one_topic_are_both_heard(listen: Listen) -> None:
    sensors = "".join(imu().replace("'s'", f"'{name}'").replace("<pose>", "<topic>imu</topic><pose>") for name in "ab")
    world = sensor_world(model(sensors), "Imu")
    heard = listen(world, "/imu", "gz.msgs.IMU")
    world.step(2)
    assert [message.entity_name for message in heard] == ["m::l::a", "m::l::b"] * 2


@pytest.mark.parametrize(
    ("noise", "sentence"),
    [
        ("<stddev>-1</stddev>", "<stddev> of <noise> must be finite and not negative, got -1"),
        ("<stddev>nan</stddev>", "<stddev> must not be NaN"),
        ("<mean>inf</mean>", "<mean> of <noise> must be finite, got inf"),
        ("<dynamic_bias_correlation_time>-3</dynamic_bias_correlation_time>", "must be finite and not negative"),
    ],
)
def test_impossible_noise_leaves_the_sensor_out_and_names_its_line(noise: str, sentence: str) -> None:
    world = sensor_world(model(imu("\n\n\n" + axis_noise(lx=f"<noise type='gaussian'>{noise}</noise>"))), "Imu")
    (warning,) = world.warnings
    assert warning.startswith("<string>:4: ") and sentence in warning and sensors_of(world) == []


def test_without_its_element_it_measures_without_noise(listen: Listen) -> None:
    world = sensor_world(model("<sensor name='s' type='imu'><topic>imu</topic></sensor>"), "Imu")
    heard = listen(world, "/imu", "gz.msgs.IMU")
    world.step(2)
    assert len(heard) == 2 and world.warnings == []


def test_a_world_without_the_system_says_which_plugin_to_add() -> None:
    world = World.from_string(
        f"<sdf version='1.9'><world name='w'><plugin name='gz::sim::systems::Physics'/>{model(imu())}</world></sdf>"
    )
    (warning,) = world.warnings
    assert "gz-sim-imu-system" in warning
