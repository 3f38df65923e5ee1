"""Scenes here beside what Gazebo's own physics and DART gave, and these beside what they give now."""

import re
from pathlib import Path

import pytest

from gz_course.sim.gz.sim import world as simulator
from gz_course.tests.conformance.physics import dart, plugin
from gz_course.tests.conformance.physics.differences import DIFFERENCES, reason
from gz_course.tests.conformance.physics.table import DIFFERS, ENGINES, SAME, all_scenes, measure, recorded, rows

NEEDS_CLIENT = False
SCENES = {scene.name: scene for scene in all_scenes()}
SHORT = [name for name, scene in SCENES.items() if scene.short]
LONG = [name for name, scene in SCENES.items() if not scene.short]
ABSENT = {"dart": dart.why_absent(), "plugin": plugin.why_absent()}
BY_HAND = ["free fall", "a box slides, mu 0.6 on 10", "a servo lifts an arm", "caster of mu 1, sphere tyres: ahead"]
README = Path(simulator.__file__).with_name("README.md")


def judge(name):
    seen = [(row.measure.name, row.ours, row.reference, row.verdict) for row in rows(SCENES[name], recorded()[name])]
    assert [each for each in seen if each[3] not in (SAME, DIFFERS)] == []


@pytest.mark.parametrize("name", SHORT)
def test_it_moves_as_in_gazebo(name):
    judge(name)


@pytest.mark.proof
@pytest.mark.parametrize("name", LONG)
def test_it_moves_as_in_gazebo_for_longer(name):
    judge(name)


def again(engine, name):
    """Run a scene again in an engine: what it gave is recorded."""
    if ABSENT[engine]:
        pytest.skip(ABSENT[engine])
    scene = SCENES[name]
    now = measure(scene, ENGINES[engine])
    for each, value, before in zip(scene.measures, now, recorded()[name][engine], strict=True):
        assert value == pytest.approx(before, rel=1e-3, abs=1e-3), each.name


@pytest.mark.parametrize("name", BY_HAND)
def test_dart_gives_what_is_recorded(name):
    again("dart", name)


@pytest.mark.proof
@pytest.mark.parametrize(
    ("engine", "name"), [(engine, name) for name, scene in SCENES.items() for engine in sorted(scene.engines)]
)
def test_an_engine_gives_what_is_recorded(engine, name):
    again(engine, name)


def test_the_table_is_complete():
    assert len(SCENES) == len(all_scenes()) >= 60
    assert {name: set(given) for name, given in recorded().items()} == {
        name: set(scene.engines) for name, scene in SCENES.items()
    }


def test_the_readme_says_each_difference_that_stays():
    section = README.read_text().partition("### Measured beside Gazebo's physics\n")[2].partition("\n## ")[0]
    said = {" ".join(each.split()) for each in re.split(r"^- ", section, flags=re.MULTILINE)[1:]}
    found = {(scene.name, each.name) for scene in SCENES.values() for each in scene.measures}
    assert said == set(DIFFERENCES) == {text for row in found if (text := reason(*row))}
