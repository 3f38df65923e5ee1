"""The bridges of a command line, written as `NAME@ROS_TYPE@GZ_TYPE` and similar, for `parameter_bridge` and `lint`.

The name is used on both sides; ROS remapping changes that of the ROS side.

Source: ros_gz_bridge/src/parameter_bridge.cpp (its usage text), https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from gz_course.sim.bridge.ros_gz_bridge.checks import check
from gz_course.sim.bridge.ros_gz_bridge.config import Config
from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction, ServiceEntry
from gz_course.sim.bridge.ros_gz_bridge.entry_reader import old_type_warning, service_type_faults, type_faults
from gz_course.sim.bridge.ros_gz_bridge.finding import Finding
from gz_course.sim.bridge.ros_gz_bridge.names import gz_name_fault, ros_name_fault
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import UnknownPairError, canonical_gz_type, find_service, pairs

MARKS = {"@": Direction.BIDIRECTIONAL, "[": Direction.GZ_TO_ROS, "]": Direction.ROS_TO_GZ}
MARK_OF = {direction: mark for mark, direction in MARKS.items()}
_SYNTAX = "TOPIC@ROS_TYPE@GZ_TYPE, with [ (Gazebo to ROS) or ] (ROS to Gazebo) in place of the second @"
_SERVICE_SYNTAX = "SERVICE@ROS_TYPE or SERVICE@ROS_TYPE@GZ_REQUEST_TYPE@GZ_REPLY_TYPE"


def read_arguments(texts: Iterable[str], *, lazy: bool = False) -> Config:
    """Return the entries and the faults of several arguments; faults raise no exception."""
    config = Config()
    order: dict[str, int] = {}
    for text in texts:
        order.setdefault(_place(text), len(order))
        config.add(_read(text, config.findings, lazy))
    config.findings.extend(check(config.topics, config.services))
    config.findings.sort(key=lambda finding: order[finding.place])
    return config


def _place(text: str) -> str:
    return f"argument '{text}'" if len(text) <= 200 else f"argument '{text[:200]}...'"


def _read(text: str, findings: list[Finding], lazy: bool = False) -> BridgeEntry | ServiceEntry | None:
    where = _place(text)
    if re.search(r"@[^@\[\]]*/srv/", text):
        entry, faults = _service(text, where)
        findings.extend(faults)
        return None if faults else entry
    match = re.fullmatch(r"([^@]*)@([^@\[\]]*)(?:([@\[\]])(.*))?", text, re.DOTALL)
    if match is None:
        findings.append(Finding(where, f"has no '@'; expected {_SYNTAX}", fatal=True))
        return None
    topic, ros_type, mark, gz_type = match.groups()
    faults = _name_faults(where, topic, f"the topic name before the first '@' is missing; expected {_SYNTAX}")
    if mark is None:
        example = f"{topic}@{ros_type}@{_partner(ros_type)}"
        sentence = f"has no direction and no Gazebo type; expected {_SYNTAX}, for instance {example}"
        faults.append(Finding(where, sentence))
    else:
        malformed = not gz_type or "@" in gz_type
        faults.extend(Finding(where, fault, fatal=malformed) for fault in type_faults(ros_type, gz_type))
    findings.extend(faults)
    if faults or mark is None:
        return None
    if warning := old_type_warning(gz_type):
        findings.append(Finding(where, warning, warning=True))
    return BridgeEntry(topic, topic, ros_type, canonical_gz_type(gz_type), MARKS[mark], lazy=lazy, source=where)


def _service(text: str, where: str) -> tuple[ServiceEntry | None, list[Finding]]:
    match = re.fullmatch(r"([^@]*)@([^@\[\]]*)(?:@([^@\[\]]+)@([^@\[\]]+))?", text, re.DOTALL)
    if match is None:
        sentence = f"is not a service bridge; expected {_SERVICE_SYNTAX} (Gazebo's service is offered to ROS)"
        return None, [Finding(where, sentence, fatal=True)]
    name, ros_type, request, reply = (part or "" for part in match.groups())
    faults = _name_faults(where, name, f"the service name before the first '@' is missing; expected {_SERVICE_SYNTAX}")
    faults.extend(Finding(where, fault) for fault in service_type_faults(ros_type, request, reply))
    if not faults:
        try:
            types = find_service(ros_type, request, reply)
            request, reply = types.gz_request_type, types.gz_reply_type
        except UnknownPairError as error:
            faults.append(Finding(where, str(error)))
    return ServiceEntry(name, ros_type, request, reply, where), faults


def _name_faults(where: str, name: str, missing: str) -> list[Finding]:
    if not name:
        return [Finding(where, missing, fatal=True)]
    if fault := ros_name_fault(name):
        return [Finding(where, fault, fatal=True)]
    fault = gz_name_fault(name)
    return [Finding(where, fault)] if fault else []


def _partner(ros_type: str) -> str:
    """Return the first Gazebo type that pairs with `ros_type`, for an example in a sentence."""
    return next((pair.gz_type for pair in pairs() if pair.ros_type == ros_type), "gz.msgs.StringMsg")
