"""What cannot be handed over is left out, and the reason goes along: names of files, and no path."""

import os
from pathlib import Path

import pytest

from gz_course.sim.gz.sim.errors import Diagnostics
from gz_course.sim.gz.sim.sdf.assets import Assets
from gz_course.sim.gz.sim.sdf.packing import pack, without_folders
from gz_course.sim.gz.sim.sdf.reader import read_world

WORLD = """<sdf version="1.9"><world name="w"><model name="m"><link name="l"><visual name="v"><geometry>
<mesh><uri>{}</uri></mesh></geometry></visual></link></model></world></sdf>"""


def handed_over(uri, folder):
    """Return the warnings of whoever reads what was packed."""
    packed, assets, told = pack(WORLD.format(uri), str(folder / "world.sdf")), Assets(), Diagnostics(quiet=True)
    for name, data in packed.assets.items():
        assets.add(name, data)
    read_world(assets.text(packed.description), "<world>", told, assets)
    return told.warnings


@pytest.mark.parametrize(
    ("name", "make", "reason"),
    [
        ("wheel_left_of_it.stl", None, "'wheel_left_of_it.stl' was not found, so"),
        ("bodi.stl", None, "'bodi.stl' was not found; did you mean 'body.stl'?"),
        ("pipe.stl", os.mkfifo, "'pipe.stl' is no file but a FIFO (a named pipe), so"),
        ("zero.stl", lambda path: path.symlink_to("/dev/zero"), "'zero.stl' is no file but a device, so"),
        ("torn.stl", lambda path: path.write_bytes(b"solid"), "torn.stl: "),
        ("notes.txt", Path.touch, "notes.txt: "),
    ],
)
def test_the_reason_goes_along_without_a_path(name, make, reason, tmp_path):
    (tmp_path / "body.stl").touch()
    if make is not None:
        make(tmp_path / name)
    (warning,) = [each for each in handed_over(name, tmp_path) if "is left out" in each]
    assert reason in warning, warning
    assert str(tmp_path) not in warning.partition("world.sdf:")[2]


def test_paths_become_names():
    reason = "/a/b/body.stl: it is no mesh, as /c/d e said\x1b"
    assert without_folders(reason, "meshes/body.stl") == "body.stl: it is no mesh, as d e said "
    assert without_folders("'a/b.stl' was not found; it was looked for in /x, /y", "a/b.stl") == "'b.stl' was not found"
