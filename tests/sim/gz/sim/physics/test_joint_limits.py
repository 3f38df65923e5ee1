"""Limits of effort and velocity of joints: what each kind of drive may do, beside closed forms."""

import math

import numpy as np
import pytest

from gz_course.sim.gz.sim.world import World

JOINT_CONTROLLER = """<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">
<joint_name>spin</joint_name><initial_velocity>{speed}</initial_velocity></plugin>"""
FORCE = """<plugin filename="gz-sim-apply-joint-force-system" name="gz::sim::systems::ApplyJointForce">
<joint_name>spin</joint_name></plugin>"""


def one_joint(
    limit: str, plugin: str = "", *, inertia: float = 0.0005, gravity: float = 0.0, arm: float = 0.0
) -> World:
    """A rotor on a horizontal axis that is fixed to the world, its mass `arm` [m] off the axis."""
    return World.from_string(f"""<sdf version="1.9"><world name="w"><gravity>0 0 {-gravity}</gravity>
      <physics name="p" type="dart"><max_step_size>0.001</max_step_size></physics>
      <plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
      <model name="m"><link name="base"><inertial><mass>1</mass></inertial></link>
      <joint name="hold" type="fixed"><parent>world</parent><child>base</child></joint>
      <link name="rotor"><inertial><pose>{arm} 0 0 0 0 0</pose><mass>1</mass><inertia><ixx>{inertia}</ixx>
      <iyy>{inertia}</iyy><izz>{inertia}</izz></inertia></inertial></link>
      <joint name="spin" type="revolute"><parent>base</parent><child>rotor</child><axis><xyz>0 1 0</xyz>
      <limit>{limit}</limit></axis></joint>{plugin}</model></world></sdf>""")


def angle(world: World) -> float:
    return float(world.data.qpos[0])


def speed(world: World) -> float:
    return float(world.data.qvel[0])


@pytest.mark.parametrize("inertia", [1e-5, 0.0005, 0.1, 5.0])
@pytest.mark.parametrize("effort", [0.01, 1.0, 10.0, 1000.0])
@pytest.mark.parametrize("wanted", [0.3, 1.0, 5.0, -40.0])
def test_a_servo_reaches_its_speed_as_fast_as_its_effort_allows_and_never_passes_it(inertia, effort, wanted):
    world = one_joint(f"<effort>{effort}</effort>", JOINT_CONTROLLER.format(speed=wanted), inertia=inertia)
    turned, fastest = 0.0, 0.0
    for _ in range(400):
        world.step()
        turned += speed(world) * 0.001
        fastest = max(fastest, abs(speed(world)))
    assert fastest <= abs(wanted) * (1.0 + 1e-6)
    rise = abs(wanted) * inertia / effort  # [s] of constant acceleration
    expected = 0.4 * wanted - wanted * rise / 2.0 if rise < 0.4 else math.copysign(0.08 * effort / inertia, wanted)
    assert turned == pytest.approx(expected, rel=0.01, abs=abs(wanted) * 0.002)


def test_a_servo_holds_a_load_below_its_effort_and_gives_way_above():
    load = 9.8 * 0.5  # [N m]
    held = one_joint(f"<effort>{load * 1.02}</effort>", JOINT_CONTROLLER.format(speed=0.0), gravity=9.8, arm=0.5)
    held.step(2000)
    assert abs(angle(held)) < 0.002
    lost = one_joint(f"<effort>{load * 0.5}</effort>", JOINT_CONTROLLER.format(speed=0.0), gravity=9.8, arm=0.5)
    lost.step(200)
    assert angle(lost) == pytest.approx(0.5 * (load * 0.5) / (0.25 + 0.0005) * 0.2**2, rel=0.05)


@pytest.mark.parametrize("most", [0.0, 0.5, 3.0])
def test_no_command_turns_a_joint_faster_than_its_limit(most):
    world = one_joint(f"<velocity>{most}</velocity>", JOINT_CONTROLLER.format(speed=7.0))
    world.step(1000)
    assert angle(world) == pytest.approx(most, abs=0.01)


@pytest.mark.parametrize("most", [0.0, 0.5, 3.0])
def test_no_load_turns_a_passive_joint_faster_than_its_limit(most):
    world = one_joint(f"<velocity>{most}</velocity>", gravity=9.8, arm=0.1, inertia=0.01)
    world.step(2000)
    moved = angle(world)
    assert abs(speed(world)) <= most * (1.0 + 1e-5) + 1e-12
    assert moved <= 2.0 * most + 1e-6
    assert most == 0.0 or moved > 0.05


@pytest.mark.parametrize(("effort", "expected"), [(0.0, 0.0), (0.2, 0.2), (5.0, 1.0)])
def test_a_force_is_no_larger_than_the_effort(effort, expected):
    world = one_joint(f"<effort>{effort}</effort>", FORCE, inertia=0.1)
    (system,) = (each for each in world.systems if type(each).__name__ == "ApplyJointForce")
    system.command(1.0)
    world.step(1000)
    assert speed(world) == pytest.approx(expected * 1.0 / 0.1, rel=0.01, abs=1e-6)


@pytest.mark.parametrize("word", ["effort", "velocity"])
def test_a_limit_of_zero_is_told(word):
    world = one_joint(f"<{word}>0</{word}>", JOINT_CONTROLLER.format(speed=1.0))
    world.step(500)
    assert angle(world) == pytest.approx(0.0, abs=1e-9)
    assert any(
        f"joint 'spin' is driven, but has the limit {word} 0, so it cannot be moved" in each for each in world.warnings
    )


def test_no_limit_and_a_huge_one_are_the_same():
    free = one_joint("", JOINT_CONTROLLER.format(speed=2.0))
    huge = one_joint("<effort>1e16</effort><velocity>1e16</velocity>", JOINT_CONTROLLER.format(speed=2.0))
    for world in (free, huge):
        world.step(300)
    assert (angle(free), speed(free)) == (angle(huge), speed(huge))
    assert free.warnings == huge.warnings == []


def test_a_run_with_limits_is_the_same_again():
    world = one_joint("<effort>0.01</effort><velocity>4</velocity>", JOINT_CONTROLLER.format(speed=7.0))
    world.step(700)
    first = (angle(world), speed(world))
    world.reset()
    world.step(700)
    assert (angle(world), speed(world)) == first


ROBOT = """<robot name="r">
  <link name="base"><inertial><origin xyz="-0.07 0 -0.05"/><mass value="5"/>
    <inertia ixx="0.05" iyy="0.07" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="-0.15 0 -0.07"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  {wheels}
  <gazebo reference="base"><mu1>0</mu1><mu2>0</mu2></gazebo>
  <gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>left</left_joint>
    <right_joint>right</right_joint><wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius></plugin>
  </gazebo></robot>"""
WHEEL = """<link name="{side}_wheel"><inertial><mass value="0.5"/>
    <inertia ixx="0.0014" iyy="0.0014" izz="0.0025" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><cylinder radius="0.1" length="0.05"/></geometry></collision></link>
  <joint name="{side}" type="continuous"><parent link="base"/><child link="{side}_wheel"/>
    <origin xyz="0 {y} -0.02" rpy="-1.5708 0 0"/><axis xyz="0 0 1"/>{limit}</joint>"""


def robot(tmp_path, limit: str) -> World:
    """A robot of two wheels and a smooth runner on a plane, from a URDF."""
    wheels = "".join(WHEEL.format(side=side, y=y, limit=limit) for side, y in (("left", 0.2), ("right", -0.2)))
    (tmp_path / "robot.urdf").write_text(ROBOT.format(wheels=wheels))
    return World.from_string(f"""<sdf version="1.9"><world name="w">
      <plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
      <model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
      </collision></link></model>
      <include><uri>{tmp_path}/robot.urdf</uri><pose>0 0 0.12 0 0 0</pose></include></world></sdf>""")


def drive(world: World, forward: float, steps: int) -> float:
    (system,) = (each for each in world.systems if type(each).__name__ == "DiffDrive")
    assert system.command(forward, 0.0)
    start = world.truth.pose("r").position[0]
    world.step(steps)
    return float(world.truth.pose("r").position[0] - start)


@pytest.mark.parametrize(
    ("limit", "metres"),
    [
        ("", 2.0),
        ('<limit effort="100" velocity="100"/>', 2.0),
        ('<limit effort="100" velocity="1"/>', 0.4),
        ('<limit effort="100" velocity="2"/>', 0.8),
        ('<limit effort="0" velocity="100"/>', 0.0),
        ('<limit effort="100" velocity="0"/>', 0.0),
    ],
)
def test_a_robot_from_a_urdf_drives_as_its_limits_allow(tmp_path, limit, metres):
    world = robot(tmp_path, limit)
    assert drive(world, 0.5, 4000) == pytest.approx(metres, abs=0.04)
    told = [each for each in world.warnings if "limit" in each]
    assert bool(told) == (metres < 2.0), told


def reversals(world: World) -> tuple[float, float]:
    """Drive to and fro ten times at 0.3 m/s; return where the wheels end [rad] and their largest speed [rad/s]."""
    (system,) = (each for each in world.systems if type(each).__name__ == "DiffDrive")
    wheels = [int(world.model.joint(f"r::{side}").dofadr[0]) for side in ("left", "right")]
    turned, fastest = np.zeros(2), 0.0
    for number in range(10):
        system.command(0.3 if number % 2 == 0 else -0.3, 0.0)
        for _ in range(300):
            world.step()
            speeds = world.data.qvel[wheels]
            turned += speeds * 0.001
            fastest = max(fastest, float(np.max(abs(speeds))))
    return float(turned.mean()), fastest


@pytest.mark.parametrize("effort", [10, 20, 50])
def test_wheels_with_an_effort_do_not_race_and_odometry_does_not_drift(tmp_path, effort):
    end, fastest = reversals(robot(tmp_path, f'<limit effort="{effort}" velocity="1000"/>'))
    _, usual = reversals(robot(tmp_path, ""))
    assert fastest <= usual * 1.05  # the body rocks a little longer
    assert abs(end) * 0.1 < 0.01  # [m]
