"""Damaged, huge and hostile worlds: rejected with one sentence in limited time, without a crash.

It loads two hundred damaged worlds; `python -m tests.fuzz.load_worlds` loads any number of them.
"""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics, SdfError
from gz_course.sim.gz.sim.sdf.element import DEEPEST, parse
from gz_course.sim.gz.sim.sdf.reader import read_world
from gz_course.sim.gz.sim.world import World
from gz_course.tests.fuzz.load_worlds import run

MANY = 2000


def test_damaged_worlds_are_read_or_refused_with_a_sentence() -> None:
    assert run(first=0, cases=200) == []


@pytest.mark.parametrize(
    "text",
    [
        "<sdf>" + "<!--" * 500_000,
        "<sdf>" + "<?xml " * 500_000,
        "<sdf>" + "<![CDATA[" * 500_000,
        "<a>" * 500_000,
        "<sdf " + "a='" * 500_000,
        "<sdf version='1.9'>" + "&amp;" * 1_000_000,
        "<!DOCTYPE a [" + "<!ENTITY x 'y'>" * 100_000 + "]><sdf/>",
    ],
    ids=["comments", "declarations", "cdata", "depth", "quotes", "entities", "own entities"],
)
def test_hostile_texts_end_soon(text: str) -> None:
    began = time.process_time()
    with pytest.raises(SdfError, match=r"^f:\d+: "):
        read_world(text, "f", Diagnostics())
    assert time.process_time() - began < 8.0


def test_elements_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.sdf.element.MOST_ELEMENTS", 50_000)
    with pytest.raises(SdfError, match="more than 50000 elements"):
        parse("<sdf>" + "<a/>" * 50_000 + "</sdf>")


def test_depth_is_counted_and_entities_do_not_grow() -> None:
    assert parse("<a>" * DEEPEST + "</a>" * DEEPEST).tag == "a"
    with pytest.raises(SdfError, match=f"more than {DEEPEST} deep"):
        parse("<a>" * (DEEPEST + 1))
    with pytest.raises(SdfError, match="the entity 'b' is declared"):
        parse("<!DOCTYPE x [<!ENTITY b 'bbb'>]><sdf>&b;</sdf>")
    assert parse("<!DOCTYPE sdf><sdf version='1.9'/>").tag == "sdf"
    assert parse("<sdf><![CDATA[ <!-- kept -->]]><a/></sdf>").text == "<!-- kept -->"


@pytest.mark.parametrize("count", [300, pytest.param(2000, marks=pytest.mark.proof)])
def test_a_world_of_thousands_of_models_loads_in_time(count: int) -> None:
    shape = "<geometry><box><size>1 1 1</size></box></geometry>"
    models = "".join(
        f"<model name='m{n}'><pose relative_to='{f'm{n - 1}' if n % 50 else ''}'>2 0 {n % 7} 0 0 0</pose>"
        f"<link name='l'><collision name='c'>{shape}</collision></link></model>"
        for n in range(count)
    )
    began = time.process_time()
    world = World.from_string(f"<sdf version='1.9'><world name='w'>{models}</world></sdf>")
    assert len(world.truth.model_names()) == count and time.process_time() - began < 30.0
    assert world.model.narena < 2 * 1024**3  # MuJoCo's default would be 6 GB


def test_a_long_chain_of_frames_is_no_recursion(tmp_path: Path) -> None:
    frames = "".join(f"<frame name='f{n}'><pose relative_to='f{n + 1}'>1 0 0 0 0 0</pose></frame>" for n in range(MANY))
    text = (
        f"<sdf version='1.9'><world name='w'>{frames}<frame name='f{MANY}'/>"
        "<model name='m'><pose relative_to='f0'/><link name='l'/></model></world></sdf>"
    )
    world = read_world(text, "f", Diagnostics())
    assert world.models[0].pose.position == pytest.approx((MANY, 0, 0))


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<model name='m'><pose>0 nan 0 0 0 0</pose><link name='l'/></model>", "must not be NaN"),
        ("<gravity>0 0 1e300</gravity>", "<gravity> must be finite"),
        ("<physics><max_step_size>inf</max_step_size></physics>", "between 0.000001 and 0.1 seconds, got inf"),
        ("<model name='m'><link name='l'><inertial><mass>1e300</mass></inertial></link></model>", "<mass>"),
        ("<light name='a'/><light name='a'/>", "<light> is called 'a'"),
        ("<light type='point'/>", "needs a name"),
        ("<light name='a'><direction>0 0 0</direction></light>", "no length"),
        ("<light name='a'><pose relative_to='nowhere'/></light>", "no frame 'nowhere'"),
    ],
)
def test_numbers_beyond_physics_are_refused_at_their_line(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=rf"^f:2: .*{sentence}"):
        read_world(f"<sdf version='1.9'><world name='w'>\n{inside}</world></sdf>", "f", Diagnostics())
