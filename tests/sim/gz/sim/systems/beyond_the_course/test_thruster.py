"""Thruster: a propeller pushes its vehicle along the axis of its joint."""

from __future__ import annotations

import math
from typing import Any

import pytest

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node
from gz_course.tests.sim.gz.sim.systems.motion_world import joint, plugin, world

# n = sqrt(thrust / (1000 * 0.004 * 0.2^4)): 12.5 rad/s for 1 N.
PROPELLER = "<joint_name>shaft</joint_name><thrust_coefficient>0.004</thrust_coefficient>"
PROPELLER += "<propeller_diameter>0.2</propeller_diameter>"


def boat(inside: str = PROPELLER, *plugins: str) -> World:
    """Return a hull of 9 kg and a propeller of 1 kg behind it, in empty space."""

    def part(name: str, pose: str, mass: float, inertia: float) -> str:
        moments = "".join(f"<{axis}>{inertia}</{axis}>" for axis in ("ixx", "iyy", "izz"))
        return f"""<link name='{name}'><pose>{pose}</pose><inertial><mass>{mass}</mass><inertia>{moments}</inertia>
          </inertial></link>"""

    links = part("hull", "0 0 0 0 0 0", 9.0, 1.0) + part("screw", "-1 0 0 0 0 0", 1.0, 0.01)
    shaft = joint("shaft", "revolute", "hull", "screw", "<xyz>1 0 0</xyz>")
    return world(
        f"<model name='boat'>{links}{shaft}{plugin('Thruster', inside)}{''.join(plugins)}</model>", gravity="0 0 0"
    )


def thruster(made: World) -> Any:
    return next(each for each in made.systems if each.name == "Thruster")


def turning(made: World) -> float:
    return float(made.data.qvel[made.model.joint("boat::shaft").dofadr[0]])


def test_a_thrust_accelerates_the_vehicle_and_turns_the_propeller(node: Node) -> None:
    made = boat()
    assert not made.warnings
    made.attach(node)
    heard: list[float] = []
    node.subscribe(Double, "/model/boat/joint/shaft/ang_vel", lambda message: heard.append(message.data))
    command = node.advertise("/model/boat/joint/shaft/cmd_thrust", Double)
    command.publish(Double(data=4.0))
    made.step(1000)
    assert made.truth.velocity("boat").linear == pytest.approx((0.4, 0, 0), rel=1e-3)
    assert turning(made) == pytest.approx(25.0, abs=0.5)
    assert heard[-1] == pytest.approx(25.0, abs=0.5) and len(heard) == 1000
    command.publish(Double(data=math.nan))
    assert made.dropped_commands == {"/model/boat/joint/shaft/cmd_thrust": 1}
    made.reset()
    made.step(10)
    assert not made.data.qvel.any()


def test_a_speed_is_commanded_and_the_thrust_told(node: Node) -> None:
    made = boat(
        f"{PROPELLER}<use_angvel_cmd>1</use_angvel_cmd><velocity_control>1</velocity_control><namespace>n</namespace>"
    )
    made.attach(node)
    heard: list[float] = []
    node.subscribe(Double, "/model/n/joint/shaft/force", lambda message: heard.append(message.data))
    node.advertise("/model/n/joint/shaft/cmd_vel", Double).publish(Double(data=-50.0))
    made.step(200)
    assert turning(made) == pytest.approx(-50.0, rel=1e-2)
    assert heard[-1] == pytest.approx(-16.0)
    assert made.truth.velocity("boat").linear[0] == pytest.approx(-16.0 / 10 * 0.2, rel=1e-3)


def test_topic_limits_and_deadband(node: Node) -> None:
    limits = "<topic>go</topic><max_thrust_cmd>3</max_thrust_cmd><min_thrust_cmd>-1</min_thrust_cmd>"
    made = boat(f"{PROPELLER}{limits}<deadband>2</deadband>")
    made.attach(node)
    command = node.advertise("/boat/go", Double)
    command.publish(Double(data=9.0))
    assert thruster(made).thrust == 3.0
    command.publish(Double(data=-9.0))
    assert thruster(made).thrust == -1.0
    made.step(10)
    assert not made.data.qvel.any(), "-1 N is within the deadband"
    node.advertise("/boat/go/enable_deadband", Boolean).publish(Boolean(data=False))
    made.step(10)
    assert made.truth.velocity("boat").linear[0] == pytest.approx(-1e-3, rel=1e-2)


def test_the_coefficient_falls_with_the_way_through_the_water() -> None:
    made = boat(
        "<joint_name>shaft</joint_name><propeller_diameter>0.2</propeller_diameter><alpha_1>0.02</alpha_1>"
        "<alpha_2>-0.01</alpha_2><wake_fraction>0.5</wake_fraction>"
    )
    made.data.qvel[0] = 2.0
    system = thruster(made)
    system.command(10.0)
    made.step(300)
    coefficient = 0.02 - 0.01 * 0.5 * made.truth.velocity("boat").linear[0] / (system.speed * 0.2)
    assert system.speed == pytest.approx(math.sqrt(10.0 / (1000 * coefficient * 0.2**4)), rel=1e-2)


def test_an_empty_battery_stops_the_thruster() -> None:
    cell = """<battery_name>cell</battery_name><voltage>12</voltage><capacity>0.001</capacity>
      <initial_charge>0.001</initial_charge><open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef>
      <start_draining>true</start_draining><fix_issue_225>true</fix_issue_225>
      <smooth_current_tau>0.001</smooth_current_tau>"""
    drawn = "<battery_name>cell</battery_name><power_load>432</power_load>"
    made = boat(PROPELLER + drawn, plugin("LinearBatteryPlugin", cell))
    assert not made.warnings
    thruster(made).command(10.0)
    made.step(200)  # 36 A empty 0.001 Ah in 0.1 s
    assert made.truth.velocity("boat").linear[0] == pytest.approx(0.1, rel=0.05)


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("", "Thruster needs a <joint_name>"),
        ("<joint_name>shat</joint_name>", "names joint 'shat', which model 'boat' does not have; did you mean 'shaft'"),
        (f"{PROPELLER}<fluid_density>0</fluid_density>", "<fluid_density> must be greater than zero, got 0"),
    ],
)
def test_what_is_wrong_is_named(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        boat(inside)
