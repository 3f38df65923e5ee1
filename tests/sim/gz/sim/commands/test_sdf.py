"""`gz sdf`: worlds, models and URDF files that are valid or not, and what is printed of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from gz_course.sim.gz.command import main
from gz_course.sim.gz.sim.world import World

WORLD = """<sdf version="1.10"><world name="w">
<include><uri>part</uri><name>first</name><pose>1 0 0 0 0 0</pose></include>
<model name="outer"><static>1</static><link name="l"/><include merge="true"><uri>part</uri></include></model>
<include><uri>model://nothing_of_this_name</uri></include>
</world></sdf>"""
PART = """<sdf version="1.10"><model name="part"><static>1</static><link name="base"><visual name="v"><geometry><mesh>
<uri>part.obj</uri></mesh></geometry></visual></link></model></sdf>"""


@pytest.fixture
def world(tmp_path: Path) -> Path:
    folder = tmp_path / "part"
    folder.mkdir()
    (folder / "model.sdf").write_text(PART)
    (folder / "part.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    path = tmp_path / "w.sdf"
    path.write_text(WORLD)
    return path


def test_check(world: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sdf", "-k", str(tmp_path / "part" / "model.sdf")]) == 0
    assert capsys.readouterr() == ("Valid.\n", "")
    assert main(["sdf", "--check", str(world)]) == 0
    out, error = capsys.readouterr()
    assert out == "Valid.\n" and error.count("\n") == 1 and "nothing_of_this_name" in error
    world.write_text(
        '<sdf version="1.10"><world name="w">\n<model name="m"><link name="a"/><link name="a"/></model></world></sdf>'
    )
    assert main(["sdf", "-k", str(world)]) == 255
    out, error = capsys.readouterr()
    assert out == "" and error.startswith(f"gz sdf: {world}:2: ")
    assert main(["sdf", "-k", str(tmp_path / "none.sdf")]) == 255
    assert "there is no file" in capsys.readouterr().err


def test_print_replaces_includes(world: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sdf", "-p", str(world)]) == 0
    out, error = capsys.readouterr()
    assert out.startswith('<?xml version="1.0" ?>\n<sdf version="1.10">\n  <world name="w">\n    <model name="first">')
    assert str(tmp_path / "part" / "part.obj") in out and "<pose>1 0 0 0 0 0</pose>" in out
    assert 'merge="true"' in out and "merge" in error  # kept, and told
    printed = World.from_string(out.replace("<uri>part</uri>", f"<uri>{tmp_path / 'part'}</uri>"))
    assert "first" in printed.model_names(static=True)
    printed.close()
    assert main(["sdf", "-p", str(world), "-i"]) == 0
    assert capsys.readouterr().out.count("<include") == 3


def test_print_converts_a_urdf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "robot.urdf"
    path.write_text(
        "<robot name='r'><link name='base'><inertial><mass value='1'/>"
        "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>"
    )
    assert main(["sdf", "-p", str(path)]) == 0
    out = capsys.readouterr().out
    assert '<model name="r">' in out and '<link name="base">' in out


AUTO = """<sdf version="1.11"><model name="m"><pose degrees="true">1 2.5 3 0 0 89.995</pose><link name="a">
<pose>0 0 1 0 0 0</pose><inertial auto="true"/><collision name="c"><density>1000</density><geometry><box>
<size>1 1 1</size></box></geometry></collision></link>
<link name="b"><inertial><mass>1000</mass></inertial></link></model></sdf>"""


def test_angles_digits_and_automatic_inertias(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "model.sdf"
    path.write_text(AUTO)
    assert main(["sdf", "-p", str(path), "--degrees", "--precision", "3"]) == 0
    out = capsys.readouterr().out
    assert '<pose degrees="true">1 2.5 3 0 0 90</pose>' in out and '<inertial auto="true"/>' in out
    assert main(["sdf", "-p", str(path), "--snap-to-degrees", "45"]) == 0
    assert '<pose degrees="true">1 2.5 3 0 0 90</pose>' in capsys.readouterr().out
    assert main(["sdf", "-p", str(path), "--snap-to-degrees", "45", "--snap-tolerance", "0.001"]) == 0
    assert " 89.995" in capsys.readouterr().out
    assert main(["sdf", "-p", str(path), "--expand-auto-inertials"]) == 0
    out = capsys.readouterr().out
    assert "auto" not in out and "<mass>1000.0</mass>" in out and "<ixx>166.66666666666" in out
    assert main(["sdf", "-p", str(path), "--snap-to-degrees", "400"]) == 1
    assert "at most 360" in capsys.readouterr().err


def test_statistics_of_the_inertia(world: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "model.sdf"
    path.write_text(AUTO)
    assert main(["sdf", "--inertial-stats", str(path)]) == 0
    assert capsys.readouterr().out == (
        "Inertial statistics for model: m\n---\nTotal mass of the model: 2000\n---\n"
        "Centre of mass in model frame: \nX: 0\nY: 0\nZ: 0.5\n---\nMoment of inertia matrix: \n"
        "667.667  0        0        \n0        667.667  0        \n0        0        167.667  \n---\n"
    )
    assert main(["sdf", "--inertial-stats", str(world)]) == 255
    assert "is a world file" in capsys.readouterr().err


FRAMES = """<sdf version="1.10"><world name="w">
<model name="a"><joint name="j" type="fixed"><parent>p</parent><child>c</child></joint><link name="c"/><link name="p"/>
<frame name="f" attached_to="n::l"><pose relative_to="j"/></frame>
<model name="n"><pose relative_to="p"/><link name="l"/></model></model>
<frame name="g"><pose relative_to="a::n::l"/></frame></world></sdf>"""
NAMES = ["a", "a::__model__", "a::c", "a::p", "a::j", "a::f", "a::n", "a::n::__model__", "a::n::l", "g"]


@pytest.mark.parametrize(
    ("kind", "before", "edges"),
    [
        ("pose", ["__root__", "world"], "0-1 2-3! 8-9! 9-10 3-4 3-5 4-6 6-7 5-8 1-2 10-11"),
        ("frame", ["world"], "1-2! 7-8! 8-9 5-3 6-9 2-3 10-0"),
    ],
)
def test_graph(kind: str, before: list[str], edges: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "w.sdf"
    path.write_text(FRAMES)
    assert main(["sdf", "-g", kind, str(path)]) == 0
    first, *lines, last = capsys.readouterr().out.splitlines()
    assert (first, last) == ("digraph {", "}")
    names = [*before, *NAMES]
    assert lines[: len(names)] == [f'  {number} [label="{name} ({number})"];' for number, name in enumerate(names)]
    shown = [line.strip().removesuffix(";") for line in lines[len(names) :]]
    assert shown == [
        f"{each.strip('!').replace('-', ' -> ')} [label={0 if each.endswith('!') else 1}]" for each in edges.split()
    ]


def test_graph_of_a_model_with_includes_and_its_faults(
    world: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["sdf", "--graph", "frame", str(tmp_path / "part" / "model.sdf")]) == 0
    assert "  2 -> 3 [label=1];" in capsys.readouterr().out
    assert main(["sdf", "-g", "pose", str(world)]) == 0
    assert '[label="first::base (4)"]' in capsys.readouterr().out
    world.write_text(FRAMES.replace("a::n::l", "a::n::ll"))
    assert main(["sdf", "-g", "pose", str(world)]) == 255
    assert (
        f"{world}:5: <pose> names frame 'a::n::ll', which does not exist; did you mean 'a::n::l'?"
        in capsys.readouterr().err
    )
    assert main(["sdf", "-g", "poses", str(world)]) != 0
    assert "did you mean 'pose'?" in capsys.readouterr().err


def test_describe(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["sdf", "-d"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "<element name='sdf'>" and lines[-1] == "</element>"
    assert "        <attribute name='name'/>" in lines and any("<element name='diffuse'/>" in line for line in lines)
    assert sum(line.strip() == "<element name='link'>" for line in lines) == 1, "each element is described once"
