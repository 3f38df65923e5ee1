"""Thermal and ThermalSensor: the temperature of a visual, and the range and resolution of a thermal camera.

`<plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal"><temperature>310</temperature></plugin>`
[K] inside a `<visual>`; everything else has the temperature of the world's `<atmosphere>`. A `<heat_signature>` is a
texture in Gazebo; here its visual has the mean of `<min_temp>` and `<max_temp>` everywhere. The plugin
`ThermalSensor` inside the `<sensor>` states `<min_temp>`, `<max_temp>` [K] and `<resolution>` [K] of one unit of a
pixel.

Source: https://github.com/gazebosim/gz-sim/tree/gz-sim8/src/systems/thermal
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.plugins.system import System, system, system_name
from gz_course.sim.gz.sim.sdf.description import Collision, Model, Plugin, Visual
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

STANDARD = 288.15
"""Temperature [K] of an `<atmosphere>` that states none."""


@system("Thermal", "gz-sim-thermal-system")
class Thermal(System):
    """Thermal cameras read the temperature of a visual with `temperature_of`."""

    parameters = frozenset(("temperature", "heat_signature", "min_temp", "max_temp"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        world.diagnostics.warn(plugin.element.where, "Thermal has no effect here, it belongs inside a <visual>")


@system("ThermalSensor", "gz-sim-thermal-sensor-system")
class ThermalSensor(System):
    """Thermal cameras read their range and resolution with `parameters_of`."""

    parameters = frozenset(("min_temp", "max_temp", "resolution"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        world.diagnostics.warn(plugin.element.where, "ThermalSensor has no effect here, it belongs inside a <sensor>")


def ambient_temperature(world: Element) -> float:
    """Return the temperature [K] of the atmosphere of a `<world>`."""
    atmosphere = world.find("atmosphere")
    return _kelvin(atmosphere, "temperature", STANDARD) if atmosphere is not None else STANDARD


def temperature_of(part: Visual | Collision, ambient: float, diagnostics: Diagnostics) -> float:
    """Return the temperature [K] of a visual; `ambient` [K] is that of the air."""
    found = _plugin(part.element, "Thermal")
    if found is None:
        return ambient
    if found.find("heat_signature") is not None:
        text = "<heat_signature> is not read; its visual has the mean of <min_temp> and <max_temp>"
        diagnostics.warn(found.where, text)
        return (_kelvin(found, "min_temp", ambient) + _kelvin(found, "max_temp", ambient)) / 2.0
    if found.find("temperature") is None:
        diagnostics.warn(found.where, "Thermal needs a <temperature>, none was found")
    return _kelvin(found, "temperature", ambient)


def parameters_of(sensor: Element) -> tuple[float, float, float | None]:
    """Return minimum and maximum [K] of a thermal camera, and its resolution [K] if it is stated."""
    found = _plugin(sensor, "ThermalSensor")
    if found is None:
        return 0.0, math.inf, None
    low, high = found.number("min_temp", 0.0), found.number("max_temp", math.inf)
    resolution = found.number("resolution", 0.0) if found.find("resolution") is not None else None
    if not 0.0 <= low <= high or (resolution is not None and not 0.0 < resolution < math.inf):
        raise found.error("ThermalSensor needs 0 <= <min_temp> <= <max_temp> and a <resolution> greater than zero")
    return low, high, resolution


def _plugin(element: Element, name: str) -> Element | None:
    plugins = (Plugin(each.name, each.attributes.get("filename", ""), each) for each in element.all("plugin"))
    return next((plugin.element for plugin in plugins if system_name(plugin) == name), None)


def _kelvin(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if not 0.0 <= value < math.inf:
        raise element.error(f"<{tag}> must be a temperature in kelvin, 0 or more, got {value:g}")
    return value
