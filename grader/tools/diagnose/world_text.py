"""The contents of a running world's SDF text: its systems, sensors and drives.

`gz_side` asks the world for the text (`/world/W/generate_world_sdf`); files in `looks/` compare it with the graph.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass

DRIVES = {
    "DiffDrive": "gz-sim-diff-drive-system",
    "AckermannSteering": "gz-sim-ackermann-steering-system",
    "MecanumDrive": "gz-sim-mecanum-drive-system",
}
"""Systems that turn a Twist into motion and report odometry, with their files."""

DEFAULT_SYSTEMS = frozenset({"Physics", "UserCommands", "SceneBroadcaster"})
"""Systems that Gazebo runs in a world without plugins."""


@dataclass(frozen=True)
class SensorText:
    """A `<sensor>`: its type, its name as `model/link/sensor`, and its element."""

    name: str
    type: str
    element: ET.Element

    def text(self, *paths: str) -> str:
        """Return the text of the first of these children that has one; else empty."""
        return next((found for path in paths if (found := (self.element.findtext(path) or "").strip())), "")


@dataclass(frozen=True)
class DriveText:
    """A drive system of a model with its topics."""

    model: str
    system: str
    command_topic: str
    odometry_topic: str


@dataclass(frozen=True)
class WorldText:
    """A world as in its SDF text; `systems` are those of the world itself, without those of models."""

    systems: frozenset[str]
    sensors: tuple[SensorText, ...]
    drives: tuple[DriveText, ...]

    @classmethod
    def read(cls, text: str) -> WorldText:
        """Read the SDF text of a world. Raises ValueError if it is not XML with a `<world>`."""
        try:
            root = ET.fromstring(text)
        except ET.ParseError as error:
            raise ValueError(f"the world's SDF is not XML: {error}") from None
        world = root.find("world")
        if world is None:
            raise ValueError("the SDF has no <world>")
        sensors: list[SensorText] = []
        drives: list[DriveText] = []
        for model in world.findall("model"):
            _read_model(model, model.get("name", ""), sensors, drives)
        named = frozenset(_system(plugin) for plugin in world.findall("plugin"))
        return cls(named or DEFAULT_SYSTEMS, tuple(sensors), tuple(drives))


def _read_model(model: ET.Element, name: str, sensors: list[SensorText], drives: list[DriveText]) -> None:
    for holder in [*model.findall("link"), *model.findall("joint")]:
        for sensor in holder.findall("sensor"):
            scoped = f"{name}/{holder.get('name', '')}/{sensor.get('name', '')}"
            sensors.append(SensorText(scoped, sensor.get("type", ""), sensor))
    for plugin in model.findall("plugin"):
        system = _system(plugin)
        if system in DRIVES:
            command = _topic(plugin, "topic") or f"/model/{name}/cmd_vel"
            drives.append(DriveText(name, system, command, _topic(plugin, "odom_topic") or f"/model/{name}/odometry"))
    for nested in model.findall("model"):
        _read_model(nested, f"{name}/{nested.get('name', '')}", sensors, drives)


def _system(plugin: ET.Element) -> str:
    """Return `DiffDrive` for a plugin of that name, or of that file only."""
    last = plugin.get("name", "").rpartition("::")[2]
    file = plugin.get("filename", "").rpartition("/")[2].removeprefix("lib").removesuffix(".so")
    by_file = "".join(part.capitalize() for part in file.removeprefix("gz-sim").removesuffix("-system").split("-"))
    return last or by_file


def _topic(plugin: ET.Element, tag: str) -> str:
    text = (plugin.findtext(tag) or "").strip().strip("/")
    return f"/{text}" if text else ""
