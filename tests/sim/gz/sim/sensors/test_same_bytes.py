"""All sensors together: the same world and seed give the same bytes, also after a reset and in other processes."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys

from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

from .conftest import inertial, sensor_world

SYSTEMS = ("Imu", "Contact", "ForceTorque", "NavSat", "Magnetometer", "Altimeter", "AirPressure", "LogicalCamera")
NOISE = (
    "<noise type='gaussian'><stddev>0.1</stddev><bias_mean>1</bias_mean><dynamic_bias_stddev>1</dynamic_bias_stddev>"
    "<dynamic_bias_correlation_time>1</dynamic_bias_correlation_time></noise>"
)
SENSORS = {
    "imu": f"<imu><angular_velocity><x>{NOISE}</x></angular_velocity></imu>",
    "navsat": "",
    "magnetometer": f"<magnetometer><x>{NOISE}</x></magnetometer>",
    "altimeter": "",
    "air_pressure": f"<air_pressure><pressure>{NOISE}</pressure></air_pressure>",
    "logical_camera": "<logical_camera><near>0.1</near><far>9</far></logical_camera>",
    "contact": "<contact><collision>c</collision><topic>contact</topic></contact>",
}
TOPICS = [*SENSORS, "force_torque"]


def world(node: Node, seed: int) -> World:
    """Return a world in which a box with all sensors and a second link falls on its edge."""
    place = "<spherical_coordinates><latitude_deg>40</latitude_deg></spherical_coordinates>"
    ground = "<include><uri>model://ground_plane</uri></include>"
    parts = "".join(
        f"<sensor name='{kind}' type='{kind}'>{inside}{'' if kind == 'contact' else f'<topic>{kind}</topic>'}</sensor>"
        for kind, inside in SENSORS.items()
    )
    box = "<collision name='c'><geometry><box><size>1 1 1</size></box></geometry></collision>"
    joint = (
        "<joint name='j' type='fixed'><parent>l</parent><child>b</child>"
        "<sensor name='f' type='force_torque'><topic>force_torque</topic></sensor></joint>"
    )
    model = (
        f"<model name='m'><pose>0 0 0.7 0.3 0 0</pose><link name='l'>{inertial(2)}{box}{parts}</link>"
        f"<link name='b'><pose>0 0 1 0 0 0</pose>{inertial(1)}</link>{joint}</model>"
    )
    return sensor_world(place + ground + model, *SYSTEMS, seed=seed, node=node)


def digests(seed: int, steps: int = 400) -> tuple[str, str]:
    """Return the digests of all topics in a run, and in the run after a reset."""
    found: list[str] = []
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        loaded = world(node, seed)
        assert loaded.warnings == []
        heard: set[str] = set()
        digest = hashlib.sha256()

        def take(data: bytes, info: object) -> None:
            topic = info.topic  # type: ignore[attr-defined]
            heard.add(topic)
            digest.update(topic.encode() + data)

        for topic in TOPICS:
            node.subscribe_raw(f"/{topic}", take)
        for _ in range(2):
            digest = hashlib.sha256()
            loaded.step(steps)
            found.append(digest.hexdigest())
            loaded.reset()
        assert heard == {f"/{topic}" for topic in TOPICS}
        loaded.close()
    return found[0], found[1]


def test_same_seed_same_bytes_also_after_a_reset() -> None:
    first, again = digests(3)
    assert first == again == digests(3)[0]
    assert digests(4)[0] != first


def test_same_bytes_in_another_process() -> None:
    code = f"from {__name__} import digests; print(digests(3)[0])"
    result = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        capture_output=True,
        text=True,
        timeout=600,
        check=True,
    )
    assert result.stdout.split() == [digests(3)[0]]
