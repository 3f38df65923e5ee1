"""The ROS parameters of the bridge's node.

`parameter_bridge` calls `read_parameters` once, at the start. The bridge does not change while it runs, so
later changes of parameters are refused.

Source: README.md and src/ros_gz_bridge.cpp of ros_gz_bridge, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from gz_course.sim.bridge.ros_gz_bridge import bridged_topics
from gz_course.sim.bridge.ros_gz_bridge.config import Config
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
from gz_course.sim.bridge.ros_gz_bridge.entry_reader import KEYS, SERVICE_KEYS, EntryReader, Value, unknown_key
from gz_course.sim.bridge.ros_gz_bridge.finding import Finding
from gz_course.sim.bridge.ros_gz_bridge.qos_profile import PUBLISHER_POLICIES
from gz_course.sim.did_you_mean import did_you_mean, nearest_name
from gz_course.sim.ros.ros_program.parameters import OF_EVERY_NODE, TYPE_WORDS

if TYPE_CHECKING:
    from rclpy.node import Node

DEFAULTS: dict[str, Any] = {
    "config_file": "",
    "lazy": False,
    "subscription_heartbeat": 1000,
    "expand_gz_topic_names": False,
    "override_frame_id": "",
    "override_timestamps_with_wall_time": False,
}
"""The parameters of every bridge, with their defaults; `subscription_heartbeat` in [ms]."""
_SUBSCRIPTION_POLICIES = ("depth", "history", "reliability")


@dataclass
class Parameters:
    """The values of the parameters; `config` holds the bridges of `bridge_names`, and all faults."""

    values: dict[str, Any] = field(default_factory=lambda: dict(DEFAULTS))
    config: Config = field(default_factory=Config)


def read_parameters(node: Node) -> Parameters:
    """Return the parameters with which `node` was started (declared from its overrides); faults raise no exception."""
    given = {name: parameter.value for name, parameter in node.get_parameters_by_prefix("").items()}
    read = Parameters()
    for name, default in DEFAULTS.items():
        if name not in given:
            continue
        value = given[name]
        if type(value) is not type(default):
            sentence = f"the parameter {name} must be {TYPE_WORDS[type(default)]}, not {value!r}"
            read.config.findings.append(Finding("", sentence, fatal=True))
        elif name == "subscription_heartbeat" and not 1 <= value <= 3_600_000:
            sentence = f"the parameter {name} must be a number of ms above 0 and up to an hour, not {value}"
            read.config.findings.append(Finding("", sentence, fatal=True))
        else:
            read.values[name] = value
    _read_bridges(given, read)
    return read


def _read_bridges(given: dict[str, Any], read: Parameters) -> None:
    """Add the bridges of `bridge_names` and `bridges.<name>.<key>` to `read.config`."""
    findings = read.config.findings
    names = given.get("bridge_names", [])
    if not isinstance(names, Sequence) or isinstance(names, str) or not all(isinstance(name, str) for name in names):
        findings.append(Finding("", f"the parameter bridge_names must be a list of texts, not {names!r}", fatal=True))
        return
    for name in sorted({name for name in names if list(names).count(name) > 1}):
        findings.append(Finding("", f"the parameter bridge_names holds {name} twice", tolerated=True))
    for name in dict.fromkeys(names):
        place = f"parameter bridges.{name}"
        values: dict[str, Value] = {}
        for parameter, value in given.items():
            if not parameter.startswith(f"bridges.{name}."):
                continue
            key = parameter.removeprefix(f"bridges.{name}.")
            if key in (*KEYS, *SERVICE_KEYS):
                values[key] = _value(f"parameter {parameter}", value)
            elif not any(other.startswith(f"{name}.") and key.startswith(other[len(name) + 1 :]) for other in names):
                findings.append(Finding(f"parameter {parameter}", unknown_key(key), tolerated=True))
        if not values:
            findings.append(Finding(place, "bridge_names has this name, but there are no parameters of it"))
            continue
        read.config.add(EntryReader(place, values, findings, read.values["lazy"]).read())
    for parameter in given:
        if parameter.startswith("bridges.") and not any(parameter.startswith(f"bridges.{name}.") for name in names):
            name = parameter.split(".")[1]
            sentence = f"{name} is not in bridge_names, so it is not bridged{did_you_mean(name, names)}"
            findings.append(Finding(f"parameter {parameter}", sentence, tolerated=True))


def _value(place: str, value: Any) -> Value:
    kind = {str: "text", bool: "bool", int: "int", float: "float", type(None): "null"}.get(type(value), "structure")
    text = "" if kind in ("structure", "null") else str(value).lower() if kind == "bool" else str(value)
    shown = "a list" if kind == "structure" else "nothing" if not text else f"the text '{text[:60]}'"
    return Value(place, kind, text, shown)


def advice(node: Node, entries: Iterable[BridgeEntry]) -> Iterator[str]:
    """Yield warnings of parameters without effect: unknown ones, and QoS overrides of endpoints that do not exist."""
    endpoints: dict[str, tuple[str, ...]] = {}
    for entry in entries:
        topic = node.resolve_topic_name(entry.ros_topic)
        if entry.direction.to_ros:
            endpoints[f"qos_overrides.{topic}.publisher."] = PUBLISHER_POLICIES
        if entry.direction.to_gz:
            endpoints[f"qos_overrides.{topic}.subscription."] = _SUBSCRIPTION_POLICIES
    known = {*DEFAULTS, *OF_EVERY_NODE, "bridge_names", bridged_topics.PARAMETER}
    for name in sorted(node.get_parameters_by_prefix("")):
        if name.startswith("qos_overrides."):
            yield from _qos_advice(name, endpoints)
        elif name not in known and not name.startswith("bridges."):
            hint = did_you_mean(name, [*DEFAULTS, "bridge_names"])
            yield f"the parameter {name} is not known here and changes nothing{hint}"


def _qos_advice(name: str, endpoints: dict[str, tuple[str, ...]]) -> Iterator[str]:
    own = next((endpoint for endpoint in endpoints if name.startswith(endpoint)), None)
    policy = name.rpartition(".")[2]
    if own is None:
        words = re.sub(r"\.(subscriber|sub)\.", ".subscription.", re.sub(r"\.pub\.", ".publisher.", name))
        close = nearest_name(words, endpoints, cutoff=0.0)
        hint = f"; did you mean '{close}{policy}'?" if close else ""
        yield f"the parameter {name} names no endpoint of this bridge and changes nothing{hint}"
    elif name.removeprefix(own) not in endpoints[own]:
        hint = did_you_mean(policy, endpoints[own]) or f"; it may be {', '.join(endpoints[own])}"
        yield f"the parameter {name} names no QoS policy that can be set there and changes nothing{hint}"


def declare(node: Node) -> None:
    """Declare the missing parameters, so that `ros2 param` shows them, and refuse changes from now on."""
    from rcl_interfaces.msg import SetParametersResult
    from rclpy.parameter import Parameter

    for name, default in DEFAULTS.items():
        if not node.has_parameter(name):
            node.declare_parameter(name, default)
    fixed = {*DEFAULTS, "bridge_names", bridged_topics.PARAMETER}

    def refuse(parameters: list[Parameter]) -> SetParametersResult:
        for parameter in parameters:
            if parameter.name in fixed or parameter.name.startswith("bridges."):
                reason = f"{parameter.name} is read when the bridge starts; stop it and start it with the new value"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(refuse)


def creation_lines(config: Config) -> Iterator[str]:
    """Yield the log lines of ros_gz_bridge, one for each direction of a bridge."""
    for entry in config.topics:
        gz, ros = f"{entry.gz_topic} ({entry.gz_type})", f"{entry.ros_topic} ({entry.ros_type})"
        if entry.direction is not Direction.ROS_TO_GZ:
            yield f"Creating GZ->ROS Bridge: [{gz} -> {ros}] (Lazy {int(entry.lazy)})"
        if entry.direction is not Direction.GZ_TO_ROS:
            yield f"Creating ROS->GZ Bridge: [{ros} -> {gz}] (Lazy {int(entry.lazy)})"
    for service in config.services:
        types = f"{service.gz_request_type} -> {service.gz_reply_type}"
        yield f"Creating ROS->GZ service bridge [{service.name} ({service.ros_type} -> {types})]"
