"""Observation of the Gazebo graph of the present partition: topics, services, worlds, commands and motion of drives.

It only listens, and asks each world once for its SDF text. It subscribes to no sensor topic, so that no camera starts
to render.
"""

from __future__ import annotations

import functools
import threading
import time
from typing import Any

from gz_course.grader.tools.diagnose.system import Drive, GzSide, GzWorld
from gz_course.grader.tools.diagnose.world_text import WorldText
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.sdf_generator_config_pb2 import SdfGeneratorConfig
from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics
from gz_course.sim.gz.transport import Node, naming, process_network

TEXT_WITHIN_MS = 1000
MOST_WORLDS = 10


def observe(seconds: float, stop: threading.Event) -> GzSide:
    """Query the graph, then listen for `seconds` [s] or until `stop` is set.

    Raises OSError if the network cannot be used.
    """
    with Node() as node:
        side = GzSide(partition=node.options.partition)
        side.publishers, side.subscribers = node.publishers_and_subscribers()
        side.services = node.service_publishers()
        side.worlds = _worlds(side)
        side.elsewhere = _elsewhere(side.partition)
        for world in side.worlds[:MOST_WORLDS]:
            node.subscribe(WorldStatistics, f"/world/{world.name}/stats", world.statistics.append)
        for world in side.worlds[:MOST_WORLDS]:
            _read_text(node, side, world)
            for drive in world.drives:
                node.subscribe(Twist, drive.command_topic, functools.partial(_command, drive))
                node.subscribe(Odometry, drive.odometry_topic, functools.partial(_odometry, drive))
        started = time.monotonic()
        stop.wait(seconds)
        side.seconds = time.monotonic() - started
    return side


def _world_of(topic: str) -> str:
    """Return `W` for `/world/W/clock` and other names that only a server has; else empty."""
    parts = topic.split("/")
    if len(parts) == 4 and parts[:2] == ["", "world"] and parts[3] in ("clock", "stats", "control"):
        return parts[2]
    return ""


def _worlds(side: GzSide) -> list[GzWorld]:
    found: dict[str, GzWorld] = {}
    for end in side.publishers:
        if (name := _world_of(end.topic)) and end.topic.endswith("/stats"):
            found.setdefault(name, GzWorld(name)).servers.add((end.p_uuid, end.n_uuid))
    for service in side.services:
        if (name := _world_of(service.topic)) and name not in found:
            found[name] = GzWorld(name, {(service.p_uuid, service.n_uuid)})
    return [found[name] for name in sorted(found)]


def _elsewhere(partition: str) -> dict[str, set[str]]:
    """Return the worlds of all other partitions: partition -> names."""
    found: dict[str, set[str]] = {}
    for name, _ in process_network.joined().known_elsewhere()[0]:
        other, topic = naming.split(name)
        if other.strip("/") != partition.strip("/") and (world := _world_of(topic)):
            found.setdefault(other.strip("/"), set()).add(world)
    return found


def _read_text(node: Node, side: GzSide, world: GzWorld) -> None:
    service = f"/world/{world.name}/generate_world_sdf"
    if not any(each.topic == service for each in side.services):
        return
    request: Any = SdfGeneratorConfig()
    request.global_entity_gen_config.expand_include_tags.data = True
    answered, response = node.request(service, request, SdfGeneratorConfig, StringMsg, TEXT_WITHIN_MS)
    if not answered:
        return
    try:
        world.text = WorldText.read(response.data)
    except ValueError:
        return
    listened = {end.topic for end in side.subscribers}
    for drive in world.text.drives:
        if drive.command_topic in listened:
            world.drives.append(Drive(drive.model, drive.system, drive.command_topic, drive.odometry_topic))


def _command(drive: Drive, _: Any) -> None:
    drive.commands.append(time.monotonic())


def _odometry(drive: Drive, message: Any) -> None:
    linear = message.twist.linear
    speed = (linear.x**2 + linear.y**2) ** 0.5
    drive.speeds.append((time.monotonic(), speed, abs(message.twist.angular.z)))
