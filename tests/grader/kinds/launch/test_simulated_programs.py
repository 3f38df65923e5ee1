"""What a process of the submission may ask the grader for when it does not keep to the rules."""

import base64
import json
import math
import os
import socket

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from gz_course.grader.kinds.launch.claims import SimulatorArguments
from gz_course.grader.kinds.launch.simulated_programs import SimulatedPrograms
from gz_course.grader.run.processes.participant import Participant
from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
from gz_course.sim.gz.sim.sdf.assets import LONGEST_TEXT, MOST_BYTES, address
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

WORLD = "<sdf version='1.9'><world name='{}'/></sdf>"
EMPTY = {"warnings": []}
MINE = WORLD.format("mine")
LIDAR = (
    "<sdf version='1.9'><world name='mine'><model name='m'><static>1</static><link name='l'><sensor name='s' "
    "type='lidar'><lidar><scan><horizontal><samples>1000000</samples><resolution>999</resolution></horizontal></scan><range><min>0.1"
    "</min><max>1</max></range></lidar></sensor></link></model>"
    "<plugin name='gz::sim::systems::Sensors' filename='gz-sim-sensors-system'/></world></sdf>"
)
MODEL = "<sdf version='1.9'><model name='m'><static>1</static><link name='l'/></model></sdf>"
WORDS = (
    *("asset", "name", "size", "description"),
    *("hello", "ros", "waiting", "world", "run", "bridge", "worlds", "call", "stopped", "pid", "group", "command"),
    *(
        "given",
        "built_in",
        "path",
        "paused",
        "iterations",
        "node",
        "entries",
        "frame_id",
        "verb",
        "data",
        "type",
        "warnings",
    ),
)


class Asking:
    """A process that asks."""

    gone, alive, number = False, True, 0

    def __init__(self):
        self.answers = []

    def tell(self, message):
        self.answers.append(message["answer"])


@pytest.fixture
def served(tmp_path):
    """Simulated programs, with `mine.sdf` handed in and `theirs.sdf` lying elsewhere."""
    (tmp_path / "theirs.sdf").write_text(WORLD.format("theirs"))
    opened = []
    with Node(NodeOptions(scope=Scope.PROCESS, partition=f"served-{os.getpid()}")) as node:
        ros = lambda: None  # noqa: E731
        anybody = lambda who, message: True  # noqa: E731
        yield SimulatedPrograms(
            {"mine.sdf"}, tmp_path / "shown", 0, node, opened.append, ros, anybody, lambda who: None
        )
    for world in opened:
        world.close()


def ask(served, **message):
    asking = Asking()
    served.asked(asking, message)
    return asking.answers[0]


def hand_over(served, data, kind="sdf", name=None, size=None):
    name = name or address(data, kind)
    part = {"name": name, "size": len(data) if size is None else size, "data": base64.b64encode(data).decode()}
    served.asked(Asking(), {"asset": part})
    return name


def load(served, path, built_in="", text=MINE):
    description = hand_over(served, text.encode())
    return ask(served, world={"given": "w", "path": str(path), "built_in": built_in, "description": description})


def test_a_file_that_was_handed_in(served, tmp_path):
    assert load(served, tmp_path / "shown" / "mine.sdf") == {"name": "mine", "models": []} | EMPTY


def test_what_a_world_includes_is_what_was_handed_over(served, tmp_path):
    model = hand_over(served, b"<sdf version='1.9'><model name='m'><static>1</static></model></sdf>")
    text = WORLD.replace("/></sdf>", f"><include><uri>{model}</uri></include></world></sdf>").format("mine")
    assert load(served, tmp_path / "shown" / "mine.sdf", text=text) == {"name": "mine", "models": ["m"]} | EMPTY


@pytest.mark.parametrize("uri", ["theirs.sdf", "file:///etc/passwd", "model://sun", "asset:" + 64 * "0" + ".sdf"])
def test_an_include_of_anything_else_brings_nothing(served, tmp_path, uri):
    for closing in ("</uri>", "</uri >"):
        include = f"<include><uri >{uri if '//' in uri else tmp_path / uri}{closing}</include>"
        text = WORLD.replace("/></sdf>", f">{include}</world></sdf>").format("mine")
        assert load(served, tmp_path / "shown" / "mine.sdf", text=text)["models"] == []


@pytest.mark.parametrize(
    ("data", "name", "says"),
    [
        (b"<sdf/>", "asset:" + 64 * "0" + ".sdf", "not what its address says"),
        (b"<sdf/>", "/etc/passwd", "not what its address says"),
        (b" " * (LONGEST_TEXT + 1), None, "MiB is too large"),
        (b" " * (MOST_BYTES + 1), None, "were passed"),
    ],
)
def test_what_is_not_taken_in_is_said(served, tmp_path, data, name, says):
    name = hand_over(served, data, name=name)
    path = str(tmp_path / "shown" / "mine.sdf")
    answer = ask(served, world={"given": "w", "path": path, "built_in": "", "description": name})
    assert says in answer["error"] and served.world is None


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<!DOCTYPE a [<!ENTITY b 'c'>]><sdf version='1.9'><world name='&b;'/></sdf>", "the entity 'b' is declared"),
        ("<a>" * 5000, "deep inside each other"),
        ("<sdf version='1.9'><world name='w'><gravity>0 0 nan</gravity></world></sdf>", "NaN"),
        (WORLD.replace("/></sdf>", "><a/>" + "<b/>" * 6_000 + "</world></sdf>").format("w"), "more than 5000 elements"),
    ],
)
def test_a_bomb_is_one_sentence(served, tmp_path, monkeypatch, text, says):
    monkeypatch.setattr("gz_course.sim.gz.sim.sdf.element.MOST_ELEMENTS", 5_000)
    assert says in load(served, tmp_path / "shown" / "mine.sdf", text=text)["error"]


def test_a_lidar_of_a_thousand_million_rays_is_left_out_with_a_word(served, tmp_path):
    answer = load(served, tmp_path / "shown" / "mine.sdf", text=LIDAR)
    assert any("beams at most" in each for each in answer["warnings"])


def test_a_model_is_created_from_a_text_and_never_from_a_path(served, tmp_path):
    load(served, "/anywhere", built_in="empty.sdf")
    (tmp_path / "box.sdf").write_text(MODEL)
    for factory in (
        EntityFactory(sdf_filename=str(tmp_path / "box.sdf")),
        EntityFactory(sdf=f"<sdf version='1.9'><include><uri >{tmp_path / 'box.sdf'}</uri ></include></sdf>"),
    ):
        data = base64.b64encode(factory.SerializeToString()).decode()
        assert not ask(served, call={"verb": "create", "type": "gz.msgs.EntityFactory", "data": data})["done"]
    assert served.calls == ["create: refused"] * 2


DRIVE = (
    "<plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'><left_joint>left</left_joint>"
    "</plugin>"
)


def test_why_a_model_is_refused_or_not_taken_whole_is_said(served, tmp_path):
    load(served, tmp_path / "shown" / "mine.sdf")

    def create(text, warnings=None):
        data = base64.b64encode(EntityFactory().SerializeToString()).decode()
        description = hand_over(served, text.encode())
        call = {"verb": "create", "type": "gz.msgs.EntityFactory", "data": data, "description": description}
        return ask(served, call=call if warnings is None else call | {"warnings": warnings})

    mass = "<link name='l'><inertial><mass>1</mass></inertial></link>"
    moving = MODEL.replace("<static>1</static><link name='l'/>", mass + DRIVE)
    taken = create(moving)
    assert taken["done"] and "DiffDrive is left out" in taken["warnings"][0] and "error" not in taken
    refused = create(moving)
    assert not refused["done"] and refused["error"].startswith("world 'mine' already has something called 'm'")
    assert served.facts()["model_warnings"] == taken["warnings"]
    assert list(served.facts()["robots"]) == ["m"]
    other = moving.replace("name='m'", "name='other'")
    tilted, known = "<create>:3: rpy is in radians", taken["warnings"][0].replace("'m'", "'other'")
    assert create(other, [tilted, 7, known])["done"]
    assert served.facts()["model_warnings"][1:] == [known, tilted]
    assert create(other.replace("other", "third"), "nonsense")["done"] and len(served.facts()["model_warnings"]) == 4


def test_a_world_that_comes_when_the_run_is_over_is_refused(served, tmp_path):
    served.over = True
    assert "the run was over" in load(served, tmp_path / "shown" / "mine.sdf")["error"]


def test_a_built_in_world(served):
    assert load(served, "/anywhere", built_in="shapes.sdf")["name"] == "shapes"


@pytest.mark.parametrize(
    "name", ["shown/../theirs.sdf", "theirs.sdf", "shown/../../theirs.sdf", "files/mine.sdf", "shown"]
)
def test_no_other_file(served, tmp_path, name):
    assert "neither a built-in world nor" in load(served, tmp_path / name)["error"]
    assert served.world is None


@pytest.mark.parametrize("name", ["../../../../etc/passwd", "/etc/passwd", "..", ".", "shapes.sdf/../../scene"])
def test_no_other_file_in_the_place_of_a_built_in_one(served, name):
    assert "error" in load(served, "/anywhere", built_in=name)


def test_a_second_world_is_not_loaded_beside_the_first(served, tmp_path):
    load(served, "/anywhere", built_in="shapes.sdf")
    assert load(served, tmp_path / "shown" / "mine.sdf")["name"] == "shapes"


def test_the_simulator_alone_passes_on_that_its_world_is_to_run_or_to_pause(served):
    simulator, other = Asking(), Asking()
    description = hand_over(served, MINE.encode())
    world = {"given": "w", "path": "", "built_in": "shapes.sdf", "description": description}
    served.asked(simulator, {"world": world})
    served._arguments = lambda who: SimulatorArguments("w", paused=True, iterations=0)
    served.asked(simulator, {"run": {}})
    served.asked(other, {"control": {"pause": False}})
    assert served.simulator.paused
    served.asked(simulator, {"control": {"pause": False}})
    assert not served.simulator.paused
    assert served.facts()["simulators"][0]["paused"], "the recording says how it was started"


@pytest.mark.parametrize("verb", ["control", "state", "scene/info", "../control"])
def test_services_that_are_not_meant_for_it(served, verb):
    load(served, "/anywhere", built_in="shapes.sdf")
    assert ask(served, call={"verb": verb, "type": "gz.msgs.Empty", "data": ""}) == {"done": False}
    assert served.calls == []


def test_a_bridge_of_nonsense_is_refused(served):
    for entries in ([{}], [{"direction": "UP"}], [{"direction": "GZ_TO_ROS", "ros_topic": "/a", "depth": 1}]):
        answer = ask(served, bridge={"entries": entries, "node": "/b", "frame_id": None})
        assert answer["errors"], entries


SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3) | st.just("x" * 5000)
NONSENSE = st.recursive(
    SCALARS, lambda inner: st.lists(inner, max_size=2) | st.dictionaries(st.sampled_from(WORDS), inner, max_size=3)
)


@settings(max_examples=300, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@example({"hello": {"pid": math.inf, "group": 1, "command": []}})
@example({"run": {"paused": False, "iterations": math.inf}})
@example({"world": {"given": "w", "built_in": "x" * 5000, "path": "/"}})
@given(st.dictionaries(st.sampled_from(WORDS), NONSENSE, max_size=3))
def test_nonsense_is_passed_over(served, message):
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours, theirs:
        participant = Participant(ours, 0, served.asked)
        for each in ({"world": {"given": "mine", "built_in": "empty.sdf", "path": "/"}}, message):
            theirs.send(json.dumps(each).encode())
        participant.read()
        assert not participant.gone
        assert "name" in json.loads(theirs.recv(1 << 16))["answer"]
