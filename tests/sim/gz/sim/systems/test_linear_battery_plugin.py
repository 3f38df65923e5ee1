"""LinearBatteryPlugin: drained once a joint is driven, charged on request, and published."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from gz_course.sim.gz.msgs.battery_state_pb2 import BatteryState
from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.sim.gz.sim.physics.wheeled_robots import drive_of

Run = Callable[[str], tuple[World, list[Any]]]
BATTERY = """<battery_name>cell</battery_name><voltage>12</voltage><capacity>2</capacity>
<open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef>
<open_circuit_voltage_linear_coef>-2</open_circuit_voltage_linear_coef><initial_charge>1.5</initial_charge>
<resistance>0.1</resistance><smooth_current_tau>0.01</smooth_current_tau><power_load>24</power_load>"""
FIXED = BATTERY + "<fix_issue_225>true</fix_issue_225>"
PLACE = "/model/two_wheel_robot/battery/cell"


@pytest.fixture
def run() -> Iterator[Run]:
    """Load a robot with a battery; return its world and the list of states it publishes."""
    robot = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    robot = robot[robot.index("<model") : robot.index("</sdf>")]
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        worlds: list[World] = []

        def start(parameters: str) -> tuple[World, list[Any]]:
            plugin = "<plugin filename='gz-sim-linearbatteryplugin-system' "
            plugin += f"name='gz::sim::systems::LinearBatteryPlugin'>{parameters}</plugin></model>"
            sdf = "<sdf version='1.10'><world name='w'><plugin filename='gz-sim-physics-system' name='gz::sim::systems"
            sdf += "::Physics'/><plugin filename='gz-sim-sensors-system' name='gz::sim::systems::Sensors'/>"
            sdf += (
                f"<include><uri>model://ground_plane</uri></include>{robot.replace('</model>', plugin)}</world></sdf>"
            )
            worlds.append(World.from_string(sdf, node=node))
            heard: list[Any] = []
            node.subscribe(BatteryState, f"{PLACE}/state", heard.append)
            return worlds[-1], heard

        yield start
        for world in worlds:
            world.close()


def test_a_battery_is_drained_once_the_robot_is_driven(run: Run) -> None:
    world, heard = run(FIXED)
    assert not any("Battery" in warning for warning in world.warnings)
    world.step(100)
    assert {(state.charge, state.voltage, state.percentage) for state in heard} == {(1.5, 12.0, 75.0)}
    assert heard[-1].power_supply_status == BatteryState.NOT_CHARGING
    drive_of(world).command(0.5, 0.0)
    world.step(1001)
    state = heard[-1]
    assert state.power_supply_status == BatteryState.DISCHARGING
    # 12 V - 2 V for each part that is missing - 0.1 ohm times the current, which is 24 W by the voltage.
    voltage = 12 - 2 * (1 - state.charge / 2) - 0.1 * state.current
    assert state.voltage == pytest.approx(voltage, abs=1e-9)
    assert state.current == pytest.approx(24 / state.voltage, rel=1e-3)
    assert state.charge == pytest.approx(1.5 - state.current / 3600, rel=1e-4)
    assert state.percentage == pytest.approx(50 * state.charge)
    assert len(heard) == 56, "at 50 Hz of simulated time"
    world.reset()
    world.step(1)
    assert (heard[-1].charge, heard[-1].current) == (1.5, 0.0)


def test_the_state_of_charge_falls_as_fast_as_in_gazebo(run: Run) -> None:
    world, heard = run(f"{BATTERY}<start_draining>true</start_draining>")
    world.step(1000)
    fallen, used = 0.75 - heard[-1].percentage, (1.5 - heard[-1].charge) / 2
    assert 80 < fallen / used < 100, "each current counts in a hundred steps"


def test_a_battery_is_charged_on_request(run: Run) -> None:
    world, heard = run(f"{FIXED}<enable_recharge>true</enable_recharge><charging_time>0.5</charging_time>")
    assert world.node is not None
    assert world.node.request(f"{PLACE}/recharge/start", Boolean(data=True), Boolean, Empty)[0]
    world.step(1001)
    assert heard[-1].power_supply_status == BatteryState.CHARGING
    assert heard[-1].current == pytest.approx(-4.0, rel=1e-3) and heard[-1].charge > 1.501
    assert world.node.request(f"{PLACE}/recharge/stop", Boolean(data=True), Boolean, Empty)[0]
    world.step(40)
    assert heard[-1].power_supply_status == BatteryState.NOT_CHARGING


@pytest.mark.parametrize(
    ("parameters", "sentence"),
    [
        (BATTERY.replace("<battery_name>cell</battery_name>", ""), "needs a <battery_name>"),
        (BATTERY.replace("<capacity>2</capacity>", ""), "needs a <capacity> greater than zero, got 0"),
        (f"{BATTERY}<enable_recharge>1</enable_recharge>", "needs a <charging_time> greater than zero"),
    ],
)
def test_a_battery_needs_its_parameters(run: Run, parameters: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        run(parameters)
