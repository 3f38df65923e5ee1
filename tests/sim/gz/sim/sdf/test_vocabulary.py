"""The words of SDF: no valid word is reported, and typos in elements and attributes get the right hint."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.plugins.sensor import sensor_types
from gz_course.sim.gz.sim.sdf import vocabulary
from gz_course.sim.gz.sim.sdf.element import parse
from gz_course.sim.gz.sim.sdf.vocabulary import check, known_words

CHILDREN, ATTRIBUTES = known_words()


def warnings(text: str) -> list[str]:
    diagnostics = Diagnostics()
    check(parse(text, "f"), diagnostics)
    return diagnostics.warnings


def test_every_known_word_is_accepted_wherever_it_can_stand() -> None:
    for parent, children in CHILDREN.items():
        attributes = " ".join(f"{name}='x'" for name in ATTRIBUTES.get(parent, ()))
        assert warnings(f"<{parent} {attributes}>{''.join(f'<{child}/>' for child in children)}</{parent}>") == []


def test_parents_are_children_of_something() -> None:
    below = {child for children in CHILDREN.values() for child in children}
    assert set(CHILDREN) - below == {"sdf"}
    assert set(ATTRIBUTES) - below - {"plugin", "sdf"} <= {"normal_map", "angular", "position", "collision_state"}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("<link><colision/></link>", "<link> has no element <colision>, it is ignored; did you mean 'collision'?"),
        ("<pose relativ_to='x'/>", "<pose> has no attribute 'relativ_to', it is ignored; did you mean 'relative_to'?"),
        ("<include marge='1'/>", "did you mean 'merge'?"),
        ("<joint typ='x'/>", "did you mean 'type'?"),
        ("<inertial><mas/></inertial>", "did you mean 'mass'?"),
    ],
)
def test_typos_find_the_word_that_was_meant(text: str, expected: str) -> None:
    found = warnings(text)
    assert len(found) == 1 and found[0].startswith("f:1: ") and expected in found[0]


def test_words_of_others_pass() -> None:
    assert warnings("<world><gz:policies x='1'/><plugin a='1'><b/></plugin><gui c='1'><d/></gui></world>") == []
    assert warnings("<sdf version='1.9' xmlns:gz='http://x'><model name='m' drake:y='1'/></sdf>") == []


def test_ten_thousand_typos_are_a_hundred_warnings() -> None:
    chance = random.Random(1)
    words = "".join(f"<{''.join(chance.choices('abcdefgh', k=8))}/>" for _ in range(10_000))
    found = warnings(f"<world>{words}</world>")
    assert len(found) == 101 and "more than 100 words" in found[-1]


@pytest.fixture
def sensors(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Return the folder of the sensors, a copy that may be changed."""
    monkeypatch.setattr(vocabulary, "SENSORS", Path(shutil.copytree(vocabulary.SENSORS, tmp_path / "sensors")))
    known_words.cache_clear()
    yield vocabulary.SENSORS
    known_words.cache_clear()


def test_the_file_of_a_sensor_brings_its_words(sensors: Path) -> None:
    text = "<sensor><compass><north/></compass></sensor>"
    assert "<sensor> has no element <compass>" in warnings(text)[0]
    (sensors / "compass.py").write_text("SDF_WORDS = {'sensor': 'compass', 'compass': 'north @magnetic'}\n")
    known_words.cache_clear()
    assert warnings(text) == []
    assert warnings("<compass magnetic='1'/>") == []
    assert "did you mean 'north'?" in warnings("<sensor><compass><nort/></compass></sensor>")[0]
    (sensors / "imu.py").unlink()
    known_words.cache_clear()
    assert "<sensor> has no element <imu>" in warnings("<sensor><imu/></sensor>")[0]


@pytest.mark.parametrize("value", ["dict(sensor='x')", "{'sensor': 3}", "['sensor']"])
def test_words_of_a_sensor_that_are_no_literal_name_the_file(sensors: Path, value: str) -> None:
    (sensors / "compass.py").write_text(f"\nSDF_WORDS = {value}\n")
    with pytest.raises(ValueError, match=r"compass.py:2: SDF_WORDS is not a literal dict"):
        known_words()


def test_every_element_that_a_sensor_type_is_named_for_is_known() -> None:
    named = {kind for kind in sensor_types() if kind in CHILDREN}
    assert named <= CHILDREN["sensor"] | {"depth_camera"}  # the latter stands in <camera>
