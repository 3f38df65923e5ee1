"""Periods of topics for all frequencies, including invalid ones."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.plugins.period import LONGEST_NS, period_ns
from gz_course.sim.gz.sim.world import World


def test_a_frequency_has_a_period_and_none_means_each_step() -> None:
    assert [period_ns(hertz) for hertz in (50.0, 30.0, 0.0, -3.0, 1e10)] == [20_000_000, 33_333_333, 0, 0, 0]


@given(st.floats(allow_nan=False))
def test_every_frequency_has_a_period(hertz: float) -> None:
    assert 0 <= period_ns(hertz) <= LONGEST_NS


PLUGIN = "<plugin filename='gz-sim-{file}-system' name='gz::sim::systems::{name}'>{inside}</plugin>"
SLOW = [
    ("pose-publisher", "PosePublisher", "<update_frequency>1e-310</update_frequency>"),
    ("odometry-publisher", "OdometryPublisher", "<odom_publish_frequency>1e-310</odom_publish_frequency>"),
    ("joint-state-publisher", "JointStatePublisher", "<update_rate>1e-310</update_rate>"),
    ("scene-broadcaster", "SceneBroadcaster", "<dynamic_pose_hertz>1e-310</dynamic_pose_hertz>"),
]


@pytest.mark.parametrize(("file", "name", "inside"), SLOW)
def test_systems_run_at_next_to_no_frequency(file: str, name: str, inside: str) -> None:
    plugin = PLUGIN.format(file=file, name=name, inside=inside)
    of_world, of_model = (plugin, "") if name == "SceneBroadcaster" else ("", plugin)
    world = World.from_string(
        f"<sdf version='1.10'><world name='w'>{of_world}<model name='m'><link name='l'>"
        "<sensor name='s' type='imu'><update_rate>1e-310</update_rate></sensor></link>"
        f"{of_model}</model></world></sdf>"
    )
    world.step(3)
    assert world.iterations == 3
