"""What is drawn: boxes for nodes, topics and Gazebo's processes, and arrows between them."""

from __future__ import annotations

from dataclasses import dataclass, field

ROS_NODE = "ros node"
ROS_TOPIC = "ros topic"
BRIDGE = "bridge"
GZ_PROCESS = "gz process"
GZ_TOPIC = "gz topic"


@dataclass
class Box:
    """One box; `fault` is a sentence on what is wrong with it."""

    kind: str
    label: str
    types: set[str] = field(default_factory=set)
    fault: str = ""


@dataclass
class Picture:
    """Boxes by key, and arrows from key to key."""

    boxes: dict[str, Box] = field(default_factory=dict)
    arrows: set[tuple[str, str]] = field(default_factory=set)

    def box(self, kind: str, name: str, label: str = "") -> str:
        """Add a box unless it is there; return its key."""
        key = f"{kind}:{name}"
        self.boxes.setdefault(key, Box(kind, label or name))
        return key
