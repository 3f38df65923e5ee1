"""The services of UserCommands: called from the stepping thread, from another thread, and with invalid requests."""

from __future__ import annotations

import logging
import math
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from google.protobuf import text_format

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.entity_factory_pb2 import EntityFactory
from gz_course.sim.gz.msgs.entity_factory_v_pb2 import EntityFactory_V
from gz_course.sim.gz.msgs.entity_pb2 import Entity
from gz_course.sim.gz.msgs.light_pb2 import Light
from gz_course.sim.gz.msgs.material_color_pb2 import MaterialColor
from gz_course.sim.gz.msgs.physics_pb2 import Physics
from gz_course.sim.gz.msgs.pose_pb2 import Pose as PoseMessage
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.msgs.spherical_coordinates_pb2 import SphericalCoordinates
from gz_course.sim.gz.msgs.visual_pb2 import Visual
from gz_course.sim.gz.msgs.wheel_slip_parameters_cmd_pb2 import WheelSlipParametersCmd
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

GEOMETRY = "<geometry><box><size>0.2 0.2 0.2</size></box></geometry>"
BOX = (
    "<sdf version='1.10'><model name='box'><pose>1 2 3 0 0 0</pose><link name='link'>"
    f"<collision name='c'>{GEOMETRY}</collision><visual name='v'>{GEOMETRY}</visual></link></model></sdf>"
)
WORLD = (
    "<sdf version='1.10'><world name='w'><gravity>0 0 0</gravity>"
    "<spherical_coordinates><latitude_deg>47</latitude_deg><longitude_deg>8</longitude_deg></spherical_coordinates>"
    "<light name='sun' type='directional'/></world></sdf>"
)
TYPES = {
    "create": EntityFactory,
    "create_multiple": EntityFactory_V,
    "remove": Entity,
    "set_pose": PoseMessage,
    "set_pose_vector": Pose_V,
    "light_config": Light,
    "visual_config": Visual,
    "set_physics": Physics,
    "set_spherical_coordinates": SphericalCoordinates,
    "enable_collision": Entity,
    "disable_collision": Entity,
    "wheel_slip": WheelSlipParametersCmd,
}
Ask = Callable[..., bool]


@pytest.fixture
def world(node: Node) -> Iterator[World]:
    """Return a world without plugins, which has UserCommands as in Gazebo."""
    made = World.from_string(WORLD, node=node)
    yield made
    made.close()


@pytest.fixture
def ask(world: World, node: Node) -> Ask:
    def call(service: str, request: Any, *, timeout_ms: int = 20_000) -> bool:
        kind = TYPES[service.removesuffix("/blocking")]
        message = text_format.Parse(request, kind()) if isinstance(request, str) else request
        executed, answer = node.request(f"/world/w/{service}", message, kind, Boolean, timeout_ms)
        assert executed, "every request is answered"
        return bool(answer.data)

    return call


@pytest.fixture(autouse=True)
def said(caplog: pytest.LogCaptureFixture) -> pytest.LogCaptureFixture:
    caplog.set_level(logging.ERROR, "gz.sim")
    return caplog


@pytest.mark.parametrize("form", ["", "/blocking"])
def test_create_and_remove(world: World, ask: Ask, form: str) -> None:
    request = EntityFactory(sdf=BOX, name="crate")
    request.pose.position.z = 0.5
    assert ask("create" + form, request)
    assert tuple(world.truth.pose("crate").position) == (0, 0, 0.5)
    assert ask("remove" + form, "name: 'crate', type: MODEL")
    assert world.truth.model_names() == []
    assert ask("create" + form, EntityFactory(sdf=BOX))
    assert tuple(world.truth.pose("box").position) == (1, 2, 3)
    assert ask("remove" + form, Entity(id=world.entities.number("model", "box")))
    assert world.truth.model_names() == []


def test_create_from_a_file_a_clone_a_light_and_beside_another(world: World, ask: Ask, tmp_path: Any) -> None:
    file = tmp_path / "box.sdf"
    file.write_text(BOX)
    assert ask("create/blocking", f"sdf_filename: '{file}'")
    assert ask("create/blocking", "clone_name: 'box', name: 'twin', pose: {position: {x: -1}}")
    assert ask("create/blocking", "clone_name: 'box'")
    assert world.truth.model_names() == ["box", "twin", "box_0"]
    assert ask("create/blocking", EntityFactory(sdf=BOX, name="near", relative_to="box", pose=PoseMessage()))
    assert tuple(world.truth.pose("near").position) == (1, 2, 3)
    assert ask("create/blocking", "light: {name: 'lamp', type: POINT, diffuse: {r: 1}, pose: {position: {z: 4}}}")
    assert [(light.name, light.diffuse) for light in world.description.lights][1:] == [("lamp", (1.0, 0.0, 0.0))]
    assert ask("remove/blocking", "name: 'lamp', type: LIGHT")


def test_create_multiple_and_set_pose_vector(world: World, ask: Ask, said: pytest.LogCaptureFixture) -> None:
    many = EntityFactory_V(data=[EntityFactory(sdf=BOX, name=name) for name in ("a", "b", "a", "c")])
    assert ask("create_multiple", many)
    assert world.truth.model_names() == ["a", "b", "c"], "the one that fails does not keep the others out"
    assert [record.getMessage() for record in said.records] == [
        "/world/w/create_multiple: world 'w' already has something called 'a'; choose another name or allow renaming"
    ]
    assert ask("set_pose_vector", "pose {name: 'a', position {x: 1}} pose {name: 'b', position {x: 2}}")
    assert [world.truth.pose(name).position[0] for name in "ab"] == [1, 2]
    assert ask("set_pose/blocking", f"id: {world.entities.number('model', 'c')}, position: {{y: 4}}")
    assert world.truth.pose("c").position[1] == 4


def test_properties(world: World, ask: Ask, node: Node) -> None:
    assert ask("create/blocking", EntityFactory(sdf=BOX))
    assert ask("light_config", "name: 'sun', diffuse: {r: 0.5}, is_light_off: true")
    assert world.description.lights[0].diffuse == (0.5, 0.0, 0.0) and not world.description.lights[0].on
    link = world.description.models[0].links[0]
    assert ask("visual_config/blocking", "name: 'v', parent_name: 'link', material: {diffuse: {g: 1, a: 1}}")
    assert link.visuals[0].rgba == (0, 1, 0, 1)
    publisher = node.advertise("/world/w/material_color", MaterialColor)
    publisher.publish(text_format.Parse("entity {name: 'v'} diffuse {b: 1 a: 1}", MaterialColor()))
    world.step()
    assert link.visuals[0].rgba == (0, 0, 1, 1)
    assert ask("disable_collision", "name: 'box::link::c', type: COLLISION") and link.collisions[0].bitmask == 0
    assert ask("enable_collision", "name: 'box'") and link.collisions[0].bitmask == 0xFF
    assert ask("set_physics", "max_step_size: 0.002, real_time_factor: 3")
    assert (world.step_size_ns, world.description.real_time_factor) == (2_000_000, 3.0)
    assert ask("set_spherical_coordinates", "latitude_deg: 10")
    assert ask("set_spherical_coordinates", "entity: {name: 'box'}, latitude_deg: 10, longitude_deg: 0.001")
    assert world.truth.pose("box").position[0] == pytest.approx(109.6, abs=0.2), (
        "a thousandth of a degree at 10 degrees north"
    )


NONSENSE = [
    ("create", "", "there is nothing to create"),
    (
        "create",
        'sdf: \'<sdf version="1.9"><model name="x"><link></model></sdf>\'',
        "<create>:1: this is not well-formed",
    ),
    ("create", "sdf: 'hello'", "this is no XML"),
    ("create", EntityFactory(sdf=BOX, pose=PoseMessage(position={"x": math.nan})), "not finite"),  # type: ignore[arg-type]
    ("create", EntityFactory(sdf=BOX, relative_to="tabel"), "no model 'tabel'"),
    ("create", "sdf_filename: 'ground_plne'", "did you mean 'ground_plane'"),
    ("create", "clone_name: 'nothing'", "no model 'nothing'"),
    ("create", "model: {name: 'x'}", "from sdf"),
    ("create", "light: {type: POINT}", "a light needs a name"),
    ("remove", "", "names no entity"),
    ("remove", "name: 'boxx', type: MODEL", "did you mean 'box'"),
    ("remove", "name: 'box', type: LINK", "only models and lights"),
    ("remove", "id: 999", "no entity 999"),
    ("remove", "id: 1, type: MODEL", "not a model"),
    ("set_pose", "name: 'bx'", "did you mean 'box'"),
    ("set_pose", "name: 'box', position: {x: nan}", "not finite"),
    ("set_pose", "position: {x: 1}", "names no entity"),
    ("set_pose", "name: 'box', orientation: {w: inf}", "not finite"),
    ("set_pose", "name: 'box', position: {z: 1e200}", "more than 1e"),
    ("light_config", "name: 'sin'", "did you mean 'sun'"),
    ("light_config", "name: 'sun', range: -1", "range of a light must be"),
    ("visual_config", "name: 'v'", "has none"),
    ("visual_config", "name: 'w', material: {diffuse: {r: 1}}", "no visual 'w'"),
    ("set_physics", "max_step_size: 7", "max_step_size must be"),
    ("set_spherical_coordinates", "latitude_deg: nan", "must be finite"),
    ("enable_collision", "name: 'box::lnk'", "did you mean 'box::link"),
    ("wheel_slip", "", "not simulated"),
]


@pytest.mark.parametrize(("service", "request_text", "sentence"), NONSENSE)
def test_nonsense_is_refused_in_one_sentence_and_the_world_lives_on(
    world: World, ask: Ask, said: pytest.LogCaptureFixture, service: str, request_text: Any, sentence: str
) -> None:
    assert ask("create/blocking", EntityFactory(sdf=BOX))
    assert ask(service + "/blocking", request_text) is False
    assert ask(service, request_text) is True  # as in Gazebo: it is in the queue
    spoken = [record.getMessage() for record in said.records]
    assert len(spoken) == 2 and all(sentence in text and "\n" not in text for text in spoken)
    assert spoken[0].startswith(f"/world/w/{service}/blocking: ") and spoken[1].startswith(f"/world/w/{service}: ")
    world.step()
    assert world.truth.model_names() == ["box"]


def test_a_request_of_another_thread_waits_for_the_end_of_a_step(world: World, ask: Ask) -> None:
    answers: list[bool] = []
    thread = threading.Thread(target=lambda: answers.append(ask("create/blocking", EntityFactory(sdf=BOX))))
    thread.start()
    while thread.is_alive():
        world.step()
        world.requests.wait(0.01)
    thread.join()
    assert answers == [True] and world.truth.model_names() == ["box"]


def test_a_blocking_request_that_nobody_serves_is_given_up_and_never_done(
    world: World, ask: Ask, said: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gz_course.sim.gz.sim.requests.Requests.call.__defaults__", (0.05,))
    answers: list[bool] = []
    thread = threading.Thread(target=lambda: answers.append(ask("create/blocking", EntityFactory(sdf=BOX))))
    thread.start()
    thread.join(120)
    assert answers == [False] and "was not stepped" in said.records[0].getMessage()
    world.step()
    assert world.truth.model_names() == []


def test_a_plain_request_is_answered_at_once_and_done_at_the_next_step(world: World, ask: Ask) -> None:
    answers: list[bool] = []
    thread = threading.Thread(target=lambda: answers.append(ask("create", EntityFactory(sdf=BOX))))
    thread.start()
    thread.join(120)
    assert answers == [True] and world.truth.model_names() == []
    world.step()
    assert world.truth.model_names() == ["box"]


def test_ten_megabytes_of_sdf(world: World, ask: Ask) -> None:
    visuals = "".join(f"<visual name='v{n}'>{GEOMETRY}</visual><!--{'x' * 9_500}-->" for n in range(1000))
    text = f"<sdf version='1.10'><model name='big'><link name='l'>{visuals}</link></model></sdf>"
    assert len(text) > 9_500_000
    assert ask("create/blocking", EntityFactory(sdf=text))
    assert world.truth.model_names() == ["big"] and world.model.ngeom == 1000


def test_quaternions_of_any_length_say_a_direction() -> None:
    from gz_course.sim.gz.sim.editing.entity_commands import pose_of

    for length in (1e-8, 1.0, 1e300):
        turned = pose_of(PoseMessage(orientation={"z": length, "w": length}), "box")
        assert turned.quaternion == pytest.approx((0.5**0.5, 0.0, 0.0, 0.5**0.5))
    assert pose_of(PoseMessage(), "box").quaternion.tolist() == [1.0, 0.0, 0.0, 0.0]
