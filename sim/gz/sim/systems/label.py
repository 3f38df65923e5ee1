"""Label: gives a model or a visual a class from 0 to 255 for segmentation cameras.

`<plugin filename="gz-sim-label-system" name="gz::sim::systems::Label"><label>10</label></plugin>` inside a `<visual>`
or a `<model>`; the label of a visual takes precedence over its model's, that of an inner model over the outer one's.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/label/Label.cc
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from gz_course.sim.gz.sim.plugins.system import System, system, system_name
from gz_course.sim.gz.sim.sdf.description import Collision, Link, Model, Plugin, Visual
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess


@system("Label", "gz-sim-label-system")
class Label(System):
    """Checks the label; segmentation cameras read it with `label_of`."""

    parameters = frozenset(("label",))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the label. Raises SdfError if it is invalid."""
        if model is None:
            raise plugin.element.error("Label belongs inside a <visual> or a <model>, not directly in the <world>")
        _read(plugin.element)


def label_of(model: Model, link: Link, part: Visual | Collision) -> int:
    """Return the label of a visual, 0 if it has none."""
    for element in part.element.all("plugin"):
        if system_name(Plugin(element.name, element.attributes.get("filename", ""), element)) == "Label":
            return _read(element)
    found = (-1, 0)
    for plugin in model.plugins:
        scope = plugin.scope
        if system_name(plugin) == "Label" and (not scope or link.name.startswith(f"{scope}::")):
            found = max(found, (len(scope), _read(plugin.element)))
    return found[1]


def _read(element: Element) -> int:
    label = element.integer("label", -1)
    if not 0 <= label <= 255:
        raise element.error(f"Label needs <label> with a whole number from 0 to 255, got '{element.text_of('label')}'")
    return label
