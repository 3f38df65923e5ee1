"""The program `ros2 run ros_gz_sim delete_entity --name box`, which deletes a model or a light by name or id.

It calls Gazebo's service `/world/W/remove/blocking`, without a bridge. `remove` uses `delete`, `set_entity_pose` the
options that choose an entity. Exit codes as for `create`.

Source: ros_gz_sim/src/delete_entity.cpp and ros_gz_interfaces/msg/Entity.msg, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from gz_course.sim.bridge.ros_gz_sim.flags import Flag, read, usage
from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros_program.errors import Failure, UsageError
from gz_course.sim.ros.ros_program.program import run

if TYPE_CHECKING:
    from rclpy.node import Node

    from gz_course.sim.bridge.ros_gz_sim.running_world import RunningWorld

MODEL = 2
TYPES = {"none": 0, "light": 1, "model": MODEL, "link": 3, "visual": 4, "collision": 5, "sensor": 6, "joint": 7}
"""The numbers of `ros_gz_interfaces/msg/Entity` and `gz.msgs.Entity`."""
_ORIGINAL_MODEL = 6  # the type of a model, the default of the original program
WHICH = (
    Flag("world", "World it is in (default: the one that runs)"),
    Flag("name", "Name of the entity"),
    Flag("id", "Number of the entity", "whole"),
    Flag("type", "model or light, or the number of the type (default: model)"),
    Flag("timeout", "Longest wait for the world, in s of wall time (default 10)", "number"),
)
HELP = usage("usage: delete_entity --name NAME | --id N [--type TYPE] [--world W]\n", WHICH)


def main(argv: list[str] | None = None) -> int:
    """Delete one entity and return the exit code."""
    return run("delete_entity", "entity_deleter", _delete, HELP, argv)


def _delete(node: Node, arguments: list[str]) -> int:
    values = read(arguments, WHICH)
    return delete(node, values, which(values))


def which(values: dict[str, Any]) -> dict[str, Any]:
    """Return name or id, and type, as fields of a `gz.msgs.Entity`. Raises UsageError."""
    if bool(values.get("name")) == ("id" in values):
        raise UsageError("say which entity: give --name or --id, one of them")
    word = str(values.get("type", "model")).lower()
    number = TYPES.get(word, int(word) if word.isascii() and word.isdigit() and len(word) < 3 else -1)
    if number not in TYPES.values():
        raise UsageError(f"there is no type '{word}'{did_you_mean(word, TYPES, listing='types are')}")
    if word == str(_ORIGINAL_MODEL):
        number = MODEL
    if number not in (MODEL, TYPES["light"]):
        raise UsageError(f"an entity of type {word} cannot be changed alone; type must be model or light")
    return {"id": values["id"], "type": number} if "id" in values else {"name": values["name"], "type": number}


def delete(node: Node, values: dict[str, Any], entity: dict[str, Any]) -> int:
    """Remove the entity with these fields of a `gz.msgs.Entity`; return 0. Raises Failure if it is not removed."""
    from gz_course.sim.bridge.ros_gz_sim.running_world import DEFAULT_TIMEOUT_S, RunningWorld
    from gz_course.sim.gz.msgs.entity_pb2 import Entity
    from gz_course.sim.gz.transport import Node as GzNode

    logger = node.get_logger()
    with GzNode() as gz_node:
        timeout = values.get("timeout", DEFAULT_TIMEOUT_S)
        world = RunningWorld(gz_node, values.get("world", ""), timeout, logger.warning)
        if not world.call("remove", Entity(**entity)):
            raise Failure(missing(world, entity) or f"world '{world.name}' refused; the output of gz sim says why")
    logger.info(f"Entity removal successful in world '{world.name}': {entity.get('name') or entity['id']}")
    return 0


def missing(world: RunningWorld, entity: dict[str, Any]) -> str:
    """Return the sentence about an entity that the world does not have; empty if it has it."""
    name = entity.get("name", "")
    if not name:
        return f"world '{world.name}' has no model or light with the number {entity['id']}"
    models, lights = world.entities()
    kind, names, others = ("light", lights, models) if entity["type"] == TYPES["light"] else ("model", models, lights)
    if name in names:
        return ""
    if name in others:
        other = "model" if kind == "light" else "light"
        return f"'{name}' in world '{world.name}' is a {other}: use delete_entity --name {name} --type {other}"
    return f"world '{world.name}' has no {kind} '{name}'{did_you_mean(name, names, listing=f'its {kind}s are')}"


if __name__ == "__main__":
    sys.exit(main())
