"""The picture of what a ROS graph and a Gazebo graph hold at this moment.

Gazebo's discovery names processes by a UUID only. The one that publishes a world's statistics is a simulator. Another
one is a bridge if a ROS node has the opposite ends of the same topics: what a bridge takes from Gazebo, it publishes in
ROS. A node whose name contains `bridge` needs one such topic, any other node needs two, and no other ends.

Source: https://github.com/ros-visualization/rqt_graph (rqt_graph/dotcode.py: what is hidden by default)
Source: https://github.com/gazebosim/gz-transport (Publisher.hh: what is known of a publisher)
"""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from gz_course.sim.show.rqt_graph.picture import BRIDGE, GZ_PROCESS, GZ_TOPIC, ROS_NODE, ROS_TOPIC, Picture

QUIET_TOPICS = frozenset({"/rosout", "/parameter_events"})
_OWN = re.compile(r"/world/([^/]+)/stats")
_ANY_TYPE = "google.protobuf.Message"


@dataclass(frozen=True)
class End:
    """One publisher or subscriber: of a ROS node by its full name, or of a Gazebo process by its UUID."""

    topic: str
    owner: str
    type_name: str
    publishes: bool


def picture(nodes: Iterable[str], ros: Sequence[End], gz: Sequence[End], *, everything: bool = False) -> Picture:
    """Return the picture of these ROS nodes and of all ends.

    Without `everything`, topics of ROS's own (`/rosout`) are left out, and topics of Gazebo with one end, unless that
    is a bridge's.
    """
    made = Picture()
    shown = [end for end in ros if everything or end.topic not in QUIET_TOPICS]
    bridges = _bridges(shown, gz)
    for node in nodes:
        made.box(BRIDGE if node in bridges.values() else ROS_NODE, node)
    for end in shown:
        kind = BRIDGE if end.owner in bridges.values() else ROS_NODE
        _connect(made, end, made.box(ROS_TOPIC, end.topic), made.box(kind, end.owner))
    _add_gz(made, gz, bridges, everything)
    _name_faults(made)
    return made


def _connect(made: Picture, end: End, topic: str, owner: str) -> None:
    if end.type_name and end.type_name != _ANY_TYPE:
        made.boxes[topic].types.add(end.type_name)
    made.arrows.add((owner, topic) if end.publishes else (topic, owner))


def _servers(gz: Iterable[End]) -> dict[str, str]:
    """Return the world of each process that simulates one."""
    found = {}
    for end in gz:
        if end.publishes and (match := _OWN.fullmatch(end.topic)):
            found[end.owner] = match[1]
    return found


def _bridges(ros: Iterable[End], gz: Iterable[End]) -> dict[str, str]:
    """Return the ROS node of each Gazebo process that is a bridge."""
    servers = _servers(gz)
    of_topic: dict[tuple[str, bool], set[str]] = defaultdict(set)
    for end in ros:
        of_topic[end.topic, end.publishes].add(end.owner)
    ends_of: dict[str, list[End]] = defaultdict(list)
    for end in gz:
        if end.owner not in servers:
            ends_of[end.owner].append(end)
    candidates = []
    for process, ends in ends_of.items():
        votes = Counter(node for end in ends for node in of_topic[end.topic, not end.publishes])
        for node, count in votes.items():
            named = "bridge" in node
            # `gz topic -e` has one end, which is also that of the ROS node on the other side of a bridge.
            if named or count == len(ends) >= 2:
                candidates.append((not named, -count, process, node))
    found: dict[str, str] = {}
    for _, _, process, node in sorted(candidates):
        if process not in found and node not in found.values():
            found[process] = node
    bridges = sorted({end.owner for end in ros if "bridge" in end.owner})
    if not found and len(bridges) == len(ends_of) == 1:  # all topics are renamed
        found = dict(zip(ends_of, bridges, strict=True))
    return found


def _add_gz(made: Picture, gz: Sequence[End], bridges: dict[str, str], everything: bool) -> None:
    servers = _servers(gz)
    owners: dict[str, set[str]] = defaultdict(set)
    for end in gz:
        owners[end.topic].add(end.owner)
    clients: dict[str, str] = {}
    for end in gz:
        if not everything and len(owners[end.topic]) < 2 and not owners[end.topic] & bridges.keys():
            continue
        if end.owner in bridges:
            owner = made.box(BRIDGE, bridges[end.owner])
        elif end.owner in servers:
            owner = made.box(GZ_PROCESS, end.owner, f"gz sim: world {servers[end.owner]}")
        else:
            number = clients.setdefault(end.owner, f"Gazebo program {len(clients) + 1}")
            owner = made.box(GZ_PROCESS, end.owner, number)
        _connect(made, end, made.box(GZ_TOPIC, end.topic), owner)
    for process, world in servers.items():
        made.box(GZ_PROCESS, process, f"gz sim: world {world}")


def _name_faults(made: Picture) -> None:
    """Mark what is wrong with topics; of Gazebo only those of a bridge, because most sensors have no reader."""
    published = {end for _, end in made.arrows}
    heard = {start for start, _ in made.arrows}
    bridged = {each for arrow in made.arrows for each in arrow if any(made.boxes[end].kind == BRIDGE for end in arrow)}
    for key, box in made.boxes.items():
        if box.kind != ROS_TOPIC and not (box.kind == GZ_TOPIC and key in bridged):
            continue
        if len(box.types) > 1:
            box.fault = f"several types: {', '.join(sorted(box.types))}"
        elif key not in published:
            box.fault = "nobody publishes it"
        elif key not in heard:
            box.fault = "nobody subscribes to it"
