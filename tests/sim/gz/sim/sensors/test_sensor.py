"""Common properties of sensors: topics, frames, schedule, the service that sets the rate, sensors created later."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.sim.plugins.sensor import sensor_types
from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

from .conftest import inertial, sensor_world, sensors_of

Listen = Callable[..., list[Any]]
TOPIC = "/world/w/model/m/link/l/sensor/s/altimeter"


def altimeter(inside: str = "") -> str:
    sensor = f"<sensor name='s' type='altimeter'>{inside}</sensor>"
    return f"<model name='m'><static>1</static><link name='l'>{sensor}</link></model>"


def rated(rate: float) -> str:
    return altimeter(f"<update_rate>{rate!r}</update_rate>")


def times(heard: list[Any]) -> list[int]:
    """Return the stamps in milliseconds."""
    return [message.header.stamp.sec * 1000 + message.header.stamp.nsec // 1_000_000 for message in heard]


def test_every_type_of_sensor_is_run_by_a_system_that_is_there() -> None:
    for name, found in sensor_types().items():
        assert found.runs_in in systems(), name


def test_topic_and_frame_can_be_given(listen: Listen) -> None:
    world = sensor_world(altimeter("<topic>my height</topic><gz_frame_id>mast</gz_frame_id>"), "Altimeter")
    heard = listen(world, "/my_height", "gz.msgs.Altimeter")
    world.step()
    assert heard[0].header.data[0].value[0] == "mast"


@pytest.mark.parametrize(
    ("rate", "step", "expected"),
    [
        (0, 0.001, list(range(1, 41))),
        (30, 0.001, [1, 33]),  # the period is truncated to whole milliseconds
        (100, 0.004, [4, 12, 20, 32, 40]),
        (400, 0.004, list(range(4, 41, 4))),
        (5000, 0.001, list(range(1, 41))),
    ],
)
def test_schedule(listen: Listen, rate: float, step: float, expected: list[int]) -> None:
    world = sensor_world(rated(rate), "Altimeter", step=step)
    heard = listen(world, TOPIC, "gz.msgs.Altimeter")
    world.step(round(0.04 / step))
    assert times(heard) == expected


@settings(max_examples=25, deadline=None)
@given(st.floats(1, 1000), st.sampled_from((1, 2, 4)), st.integers(0, 60))
def test_updates_stand_on_a_grid_from_zero_on_whoever_listens(rate: float, step: int, listen_from: int) -> None:
    from gz_course.sim.gz.msgs.altimeter_pb2 import Altimeter

    period = int(1000 / rate)
    heard: list[Any] = []
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        world = sensor_world(rated(rate), "Altimeter", step=step / 1000, node=node)
        world.step(listen_from)
        node.subscribe(Altimeter, TOPIC, heard.append)
        world.step(100 - listen_from)
        world.close()
    # An update is due at the first step at or after each multiple of the period.
    due = {max(step, -(-k * period // step) * step) for k in range(100 * step // period + 1)}
    assert times(heard) == [time for time in sorted(due) if step * listen_from < time <= 100 * step]


def set_rate(world: World, rate: float) -> bool:
    assert world.node is not None
    request = Double(data=rate)
    return world.node.request(f"{TOPIC}/set_rate", request, Double, Empty)[0]


def test_set_rate_makes_updates_rarer(listen: Listen) -> None:
    world = sensor_world(rated(100), "Altimeter")
    heard = listen(world, TOPIC, "gz.msgs.Altimeter")
    world.step(20)
    assert set_rate(world, 25)
    world.step(80)
    # The scheduled update is published, then one every 40 ms.
    assert times(heard) == [1, 10, 20, 30, 70]
    assert world.warnings == []


@pytest.mark.parametrize("rate", [200.0, 0.0, -5.0, float("inf"), float("nan")])
def test_set_rate_does_not_go_above_the_rate_of_the_file(listen: Listen, rate: float) -> None:
    world = sensor_world(rated(100), "Altimeter")
    heard = listen(world, TOPIC, "gz.msgs.Altimeter")
    set_rate(world, rate)
    world.step(50)
    assert times(heard) == [1, 10, 20, 30, 40, 50]
    assert len(world.warnings) == 1


def test_a_sensor_of_every_step_can_be_slowed_and_quickened(listen: Listen) -> None:
    world = sensor_world(rated(0), "Altimeter")
    heard = listen(world, TOPIC, "gz.msgs.Altimeter")
    world.step(3)
    set_rate(world, 100)
    world.step(12)
    assert times(heard) == [1, 2, 3, 4, 10]
    set_rate(world, 0)
    world.step(3)
    assert times(heard)[5:] == [16, 17, 18]


LATE = (
    "<sdf version='1.10'><model name='n'><static>1</static><pose>0 0 7 0 0 0</pose><link name='l'>"
    "<sensor name='s' type='altimeter'><update_rate>100</update_rate>{}</sensor></link></model></sdf>"
)


def test_models_that_come_and_go_take_their_sensors_along(listen: Listen) -> None:
    world = sensor_world(rated(100), "Altimeter")
    heard = listen(world, TOPIC.replace("/m/", "/n/"), "gz.msgs.Altimeter")
    world.step(105)
    world.editor.spawn(LATE.format(""))
    world.step(25)
    # Due at once, then at the same times as the others.
    assert times(heard) == [106, 110, 120, 130]
    assert heard[0].vertical_reference == 7.0
    world.editor.remove("n")
    world.step(50)
    assert len(heard) == 4
    assert [sensor.scoped_name for sensor in sensors_of(world)] == ["m::l::s"]
    assert world.node is not None
    assert world.node.topic_info(TOPIC.replace("/m/", "/n/"))[0] == []
    assert all("/n/" not in name for name in world.node.service_list())


def test_a_sensor_that_makes_no_sense_is_left_out_of_a_model_that_comes(listen: Listen) -> None:
    world = sensor_world(rated(100), "Altimeter")
    heard = listen(world, TOPIC, "gz.msgs.Altimeter")
    noise = "<altimeter><vertical_position><noise type='gausian'/></vertical_position></altimeter>"
    assert world.editor.spawn(LATE.format(noise)) == "n"
    (warning,) = world.warnings
    assert "did you mean 'gaussian'" in warning and warning.endswith("sensor 's' of model 'n' stays silent")
    world.step(20)
    assert times(heard) == [1, 10, 20]
    assert [sensor.scoped_name for sensor in sensors_of(world)] == ["m::l::s"]
    assert world.node is not None and all("/n/" not in name for name in world.node.topic_list())


def test_moving_sensors_find_their_place_again(listen: Listen) -> None:
    sensor = "<sensor name='s' type='altimeter'/>"
    world = sensor_world(f"<model name='m'><link name='l'>{inertial()}{sensor}</link></model>", "Altimeter")
    heard = listen(world, TOPIC, "gz.msgs.Altimeter")
    world.step(100)
    world.editor.spawn(LATE.format(""))
    world.step(100)
    # Falling from rest for 0.2 s, counted from where it began.
    assert heard[-1].vertical_position == pytest.approx(-0.5 * 9.8 * 0.2**2, rel=0.01)
    assert heard[-1].vertical_velocity == pytest.approx(-9.8 * 0.2, rel=1e-6)


def test_random_numbers_are_those_of_a_generator_made_anew() -> None:
    world = sensor_world(altimeter(), "Altimeter", seed=5)
    (sensor,) = sensors_of(world)
    for update in (0, 1, 70):
        sensor.updates = update
        key = hashlib.sha256(f"5/m::l::s/noise/{update}".encode()).digest()[:16]
        fresh = np.random.Generator(np.random.Philox(key=int.from_bytes(key, "little")))
        drawn = sensor.random()
        assert drawn.standard_normal(5).tolist() == fresh.standard_normal(5).tolist()
        assert drawn.integers(9, size=3, dtype=np.int32).tolist() == fresh.integers(9, size=3, dtype=np.int32).tolist()
    # Generators of two purposes do not disturb each other.
    noise, bias = sensor.random(), sensor.random("bias")
    first = noise.random()
    assert sensor.random().random() == first != bias.random()
