"""A camera on a stand, objects and lights, for the tests of all cameras."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gz_course.sim.gz.sim.rendering.camera_sensor import CameraSensor
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

Load = Callable[..., World]

EYE = """<model name='rig'><static>1</static><pose>0 0 1 0 0 0</pose><link name='l'>{parts}
 <sensor name='eye' type='{kind}'><update_rate>{rate}</update_rate>{topic}<camera><horizontal_fov>{fov}</horizontal_fov>
 <image><width>{width}</width><height>{height}</height><format>{format}</format></image>
 <clip><near>{near}</near><far>{far}</far></clip>{more}</camera></sensor></link></model>"""


def eye(**changes: Any) -> str:
    usual: dict[str, Any] = {
        "parts": "", "kind": "camera", "rate": 10, "topic": "", "fov": 1.2, "width": 64, "height": 48,
        "format": "R8G8B8", "near": 0.1, "far": 50, "more": "",
    }  # fmt: skip
    return EYE.format(**{**usual, **changes})


def thing(name: str, pose: str, geometry: str, colour: str = "1 0 0 1", more: str = "") -> str:
    return (
        f"<model name='{name}'><static>1</static><pose>{pose}</pose><link name='l'><visual name='v'>"
        f"<geometry>{geometry}</geometry><material><diffuse>{colour}</diffuse></material>{more}</visual></link></model>"
    )


WALL = "<box><size>0.2 60 60</size></box>"
SCENE = "<scene><ambient>0.3 0.3 0.3 1</ambient><background>0 0 1 1</background></scene>"


def sun(direction: str, shadows: bool = True) -> str:
    return (
        f"<light name='sun' type='directional'><direction>{direction}</direction><diffuse>0.6 0.6 0.6 1</diffuse>"
        f"<cast_shadows>{str(shadows).lower()}</cast_shadows></light>"
    )


def sensor_of(world: World) -> Any:
    (sensor,) = next(system for system in world.systems if system.name == "Sensors").sensors  # type: ignore[attr-defined]
    assert isinstance(sensor, CameraSensor)
    return sensor


def listen(node: Node, kind: Any, topic: str) -> list[Any]:
    heard: list[Any] = []
    node.subscribe(kind, topic, heard.append)
    return heard
