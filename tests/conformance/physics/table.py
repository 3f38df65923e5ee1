"""The table of all scenes: ours, DART, Gazebo's plugin, the closed form, and the verdict of each measure.

`references.json` holds what the plugin and DART gave, so that our side can be compared where neither is installed.
"""

from __future__ import annotations

import importlib
import json
import pkgutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from gz_course.tests.conformance.physics import dart, ours, plugin, scenes
from gz_course.tests.conformance.physics.differences import reason
from gz_course.tests.conformance.physics.scene import Measure, Scene, Track

REFERENCES = Path(__file__).with_name("references.json")
ENGINES: dict[str, Callable[[Scene], Track]] = {"dart": dart.run, "plugin": plugin.run}
SAME, DIFFERS, WRONG, CURED = "same", "differs, as the README says", "WRONG", "WRONG: it does not differ any more"


def kinds() -> dict[str, tuple[Scene, ...]]:
    """The scenes of each file of `scenes/`."""
    names = sorted(found.name for found in pkgutil.iter_modules(scenes.__path__))
    return {name: importlib.import_module(f"{scenes.__name__}.{name}").SCENES for name in names}


def all_scenes() -> list[Scene]:
    return [scene for of_kind in kinds().values() for scene in of_kind]


def measure(scene: Scene, run: Callable[[Scene], Track]) -> list[float]:
    track = run(scene)
    return [float(each.of(track)) for each in scene.measures]


def recorded() -> dict[str, dict[str, list[float]]]:
    """What each engine gave, by scene: `{"free fall": {"plugin": [4.9]}}`."""
    found: dict[str, dict[str, list[float]]] = json.loads(REFERENCES.read_text())
    return found


@dataclass(frozen=True)
class Row:
    """One measure of one scene; what an engine did not give is None."""

    scene: Scene
    measure: Measure
    ours: float
    dart: float | None
    plugin: float | None

    @property
    def reason(self) -> str:
        """Why it differs from Gazebo; empty if it does not."""
        return reason(self.scene.name, self.measure.name)

    @property
    def reference(self) -> float:
        """What ours is compared with."""
        first = self.measure.closed if self.measure.judge == "closed" and not self.reason else None
        found = next((each for each in (first, self.plugin, self.dart, self.measure.closed) if each is not None), None)
        assert found is not None, f"{self.scene.name}: nothing to compare with"
        return found

    @property
    def verdict(self) -> str:
        agrees = self.measure.agrees(self.ours, self.reference)
        if not self.reason:
            return SAME if agrees else WRONG
        return CURED if agrees else DIFFERS


def rows(scene: Scene, references: dict[str, list[float]]) -> Iterator[Row]:
    for number, (each, value) in enumerate(zip(scene.measures, measure(scene, ours.run), strict=True)):
        beside = {name: values[number] for name, values in references.items()}
        yield Row(scene, each, value, beside.get("dart"), beside.get("plugin"))
