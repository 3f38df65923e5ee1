"""What a process of the submission may ask the grader for when it does not keep to the rules."""

import json
import math
import os
import socket

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from gz_course.grader.kinds.launch.simulated_programs import SimulatedPrograms
from gz_course.grader.run.processes.participant import Participant
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

WORLD = "<sdf version='1.9'><world name='{}'/></sdf>"
WORDS = (
    *("hello", "ros", "waiting", "world", "run", "bridge", "worlds", "call", "stopped", "pid", "group", "command"),
    *("given", "built_in", "path", "paused", "iterations", "node", "entries", "frame_id", "verb", "data", "type"),
)


class Asking:
    """A process that asks."""

    gone = False

    def __init__(self):
        self.answers = []

    def tell(self, message):
        self.answers.append(message["answer"])


@pytest.fixture
def served(tmp_path):
    """SimulatedPrograms programs, with `mine.sdf` handed in and `theirs.sdf` beside that folder."""
    (tmp_path / "files").mkdir()
    (tmp_path / "files" / "mine.sdf").write_text(WORLD.format("mine"))
    (tmp_path / "theirs.sdf").write_text(WORLD.format("theirs"))
    opened = []
    with Node(NodeOptions(scope=Scope.PROCESS, partition=f"served-{os.getpid()}")) as node:
        yield SimulatedPrograms(tmp_path / "files", tmp_path / "shown", 0, node, opened.append, lambda: None)
    for world in opened:
        world.close()


def ask(served, **message):
    asking = Asking()
    served.asked(asking, message)
    return asking.answers[0]


def load(served, path, built_in=""):
    return ask(served, world={"given": str(path), "path": str(path), "built_in": built_in})


def test_a_file_that_was_handed_in(served, tmp_path):
    assert load(served, tmp_path / "shown" / "mine.sdf") == {"name": "mine", "models": []}


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
