"""Wrong parameters of plugins: refused where a world is loaded exactly, warnings with the default in `gz sim`."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import pytest

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World

WORLD = """<sdf version="1.10"><world name="w">
<plugin filename="gz-sim-physics-system" name="gz::sim::systems::Physics"/>
<model name="m"><link name="l"/><link name="r"/>
<joint name="j" type="revolute"><parent>l</parent><child>r</child><axis><xyz>0 0 1</xyz></axis></joint>
<plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher">
<joint_name>j</joint_name></plugin>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
{parameters}</plugin></model></world></sdf>"""
JOINTS = "<left_joint>j</left_joint><right_joint>j</right_joint>\n"


def load(path: Path, parameters: str, **options: bool) -> World:
    path.write_text(WORLD.format(parameters=parameters))
    return World.load(path, **options)


@pytest.mark.parametrize(
    ("parameters", "words", "end", "runs"),
    [
        (f"{JOINTS}<wheel_radius>0,1</wheel_radius>", "<wheel_radius> needs a number", "its default is used", True),
        (f"{JOINTS}<wheel_radius>-1</wheel_radius>", "wheel_radius", "its default is used", True),
        ("<left_joint>none</left_joint>", "'none'", "system DiffDrive is left out", False),
        ("", "left_joint", "system DiffDrive is left out", False),
    ],
)
def test_a_wrong_parameter(tmp_path: Path, parameters: str, words: str, end: str, runs: bool) -> None:
    path = tmp_path / "w.sdf"
    with closing(load(path, parameters, lenient=True)) as world:
        (warning,) = [text for text in world.warnings if text.endswith(f"; {end}")]
        assert words in warning and "\n" not in warning
        assert ("DiffDrive" in {each.name for each in world.systems}) is runs
        assert "JointStatePublisher" in {each.name for each in world.systems}
        assert bool(world.systems.servos["m"]) is runs
        world.step(2)
    for options in ({}, {"strict": True}, {"strict": True, "lenient": True}):
        with pytest.raises(SdfError, match=words):
            load(path, parameters, **options)
