"""`gz model` against a running world in this process."""

from __future__ import annotations

import threading
import uuid
from collections.abc import Iterator

import pytest

from gz_course.sim.gz.command import main
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node


@pytest.fixture(autouse=True)
def partition(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GZ_IP", "127.0.0.1")
    monkeypatch.setenv("GZ_PARTITION", uuid.uuid4().hex)


WORLD = """<sdf version='1.10'><world name='a small world'><model name='arm'><static>1</static>
<pose>1 2 3 0 0 0.5</pose>
<link name='base'><sensor name='eye' type='camera'><pose>0 0 1 0 0 0</pose><update_rate>5</update_rate>
<topic>eye</topic><camera><image><width>64</width><height>48</height></image></camera></sensor>
<sensor name='ear' type='imu'/></link>
<link name='upper'/><joint name='elbow' type='revolute'><parent>base</parent><child>upper</child>
<axis><xyz>0 0 1</xyz></axis></joint></model></world></sdf>"""


@pytest.fixture
def running() -> Iterator[None]:
    stop = threading.Event()
    with Node() as node:
        world = World.from_string(WORLD)
        server = Server(world, node)
        thread = threading.Thread(target=lambda: server.run(stop=stop))
        thread.start()
        yield
        stop.set()
        thread.join(120)
        world.close()


@pytest.mark.usefixtures("running")
def test_list_and_look(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["model", "--list"]) == 0
    request = "\nRequesting state for world [a small world]...\n\n"
    assert capsys.readouterr().out == f"{request}Available models:\n    - arm\n"
    assert main(["model", "-m", "arm", "-p"]) == 0
    out = capsys.readouterr().out
    number = out.partition("Model: [")[2].partition("]")[0]
    assert out == f"{request}Model: [{number}]\n  - Name: arm\n" + (
        "  - Pose [ XYZ (m) ] [ RPY (rad) ]:\n    [1.000000 2.000000 3.000000]\n    [0.000000 0.000000 0.500000]\n"
    )
    assert main(["model", "-m", "arm", "-j", "elbow"]) == 0
    out = capsys.readouterr().out.removeprefix(request)
    lines = ["  - Name: elbow", f"  - Parent: arm [{number}]", "  - Type: revolute"]
    assert out.startswith("- Joint [") and out.splitlines()[1:4] == lines
    assert "  - Parent Link: base [" in out and out.endswith("  - Axis unit vector [ XYZ ]:\n    [0 0 1]\n")
    assert main(["model", "-m", "arm", "-l", "base", "-p"]) == 0
    out = capsys.readouterr().out
    assert "\n  - Link [" in out and "\n    - Mass (kg): 1.000000\n" in out
    assert "\n    - Inertial Matrix (kg.m^2):\n      [1.000000 0.000000 0.000000]\n" in out
    assert main(["model", "-m", "arm"]) == 0
    out = capsys.readouterr().out
    assert "Name: arm" in out and "Name: upper" in out and "Name: elbow" in out and "Type: revolute" in out
    assert "Name: eye" in out and "Name: ear" in out
    assert main(["model", "-m", "arm", "-s", "eye"]) == 0
    out = capsys.readouterr().out
    assert "- Name: eye" in out and "Image width (px): 64" in out and "Update rate (Hz): 5" in out
    assert (
        "[0.000000 0.000000 1.000000]" in out
        and "  - Image noise:\n    - Mean: 0\n" in out
        and "Name: ear" not in out
        and "Link [" not in out
    )
    assert "  - Image noise:\n    - Mean: 0\n" in out
    assert main(["model", "-m", "arm", "-s", "eyes"]) == 1
    assert "did you mean 'eye'" in capsys.readouterr().err
    assert main(["model", "-m", "arn"]) == 1
    assert "did you mean 'arm'" in capsys.readouterr().err


def test_no_world(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    from gz_course.sim.gz.sim.commands import model

    monkeypatch.setattr(model, "_TIMEOUT_MS", 100)
    assert main(["model", "--list"]) == 1
    assert "no running world answers" in capsys.readouterr().err
