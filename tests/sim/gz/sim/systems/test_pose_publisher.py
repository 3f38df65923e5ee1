"""PosePublisher: the published poses, their frames, rates and static poses."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from gz_course.sim.gz.msgs.pose_pb2 import Pose
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

PUBLISHER = "<plugin filename='gz-sim-pose-publisher-system' name='gz::sim::systems::PosePublisher'>{}</plugin>"
ROBOT = """
<model name="robot"><pose>1 2 3 0 0 0</pose>
  <link name="base"><visual name="skin"><pose>0 0 0.1 0 0 0</pose><geometry><box/></geometry></visual>
    <collision name="hull"><pose>0 0 0.2 0 0 0</pose><geometry><box/></geometry></collision>
    <sensor name="eye" type="imu"><pose>0 0 0.3 0 0 0</pose></sensor></link>
  <link name="wheel"><pose>0 5 0 0 0 0</pose></link>
  <link name="plate"><pose>0 0 1 0 0 0</pose></link>
  <joint name="axle" type="revolute"><parent>base</parent><child>wheel</child><axis><xyz>0 1 0</xyz></axis></joint>
  <joint name="weld" type="fixed"><parent>base</parent><child>plate</child></joint>
  <model name="arm"><pose>0 0 2 0 0 0</pose><link name="hand"><pose>0 0 0.5 0 0 0</pose></link>{nested}</model>
  <joint name="shoulder" type="{shoulder}"><parent>base</parent><child>arm::hand</child>{axis}</joint>
  {publisher}
</model>
"""
ALL = "".join(
    f"<publish_{kind}_pose>true</publish_{kind}_pose>" for kind in ("visual", "collision", "sensor", "nested_model")
)
VECTOR = "<use_pose_vector_msg>true</use_pose_vector_msg>"


@pytest.fixture
def publish(load_text: Callable[..., World], node: Node) -> Callable[..., Any]:
    """Run the robot with a PosePublisher for some steps; return the world and the messages by topic."""

    def run(
        parameters: str = "",
        steps: int = 1,
        kind: Any = Pose,
        shoulder: str = "fixed",
        topics: tuple[str, ...] = ("/model/robot/pose", "/model/robot/pose_static"),
        nested: str = "",
    ) -> tuple[World, dict[str, list[Any]]]:
        axis = "" if shoulder == "fixed" else "<axis><xyz>0 1 0</xyz></axis>"
        own = "" if nested else PUBLISHER.format(parameters)
        text = ROBOT.format(publisher=own, shoulder=shoulder, axis=axis, nested=nested)
        world = load_text(f"<gravity>0 0 0</gravity>{text}")
        heard: dict[str, list[Any]] = {topic: [] for topic in topics}
        for topic in topics:
            node.subscribe(kind, topic, heard[topic].append)
        world.attach(node)
        world.data.qvel[:] = 1.0
        world.step(steps)
        world.close()
        return world, heard

    return run


def header(pose: Any) -> dict[str, str]:
    return {entry.key: entry.value[0] for entry in pose.header.data}


def frames(poses: list[Any]) -> dict[str, str]:
    """Return the frame of each child frame."""
    return {header(pose)["child_frame_id"]: header(pose)["frame_id"] for pose in poses}


def test_links_are_published_by_default_one_message_each_at_every_step(publish: Callable[..., Any]) -> None:
    _, heard = publish(steps=3)
    poses = heard["/model/robot/pose"]
    assert len(poses) == 3 * 4
    assert frames(poses) == {
        "robot::base": "robot",
        "robot::wheel": "robot",
        "robot::plate": "robot",
        "robot::arm::hand": "robot::arm",
    }
    assert all(pose.name == header(pose)["child_frame_id"] for pose in poses)
    assert [pose.header.stamp.nsec for pose in poses[::4]] == [1_000_000, 2_000_000, 3_000_000]
    assert heard["/model/robot/pose_static"] == []


def test_everything_that_can_be_asked_for(publish: Callable[..., Any]) -> None:
    _, heard = publish(ALL)
    found = frames(heard["/model/robot/pose"])
    assert found == {
        "robot": "w",
        "robot::arm": "robot",
        "robot::arm::hand": "robot::arm",
        "robot::base": "robot",
        "robot::base::skin": "robot::base",
        "robot::base::hull": "robot::base",
        "robot::base::eye": "robot::base",
        "robot::wheel": "robot",
        "robot::plate": "robot",
    }
    at = {pose.name: pose.position.z for pose in heard["/model/robot/pose"]}
    assert (at["robot::base::skin"], at["robot::base::hull"], at["robot::base::eye"]) == (0.1, 0.2, 0.3)


@pytest.mark.parametrize(
    ("parameters", "models"),
    [
        ("", set()),
        ("<publish_nested_model_pose>true</publish_nested_model_pose>", {"robot", "robot::arm"}),
        (
            "<publish_nested_model_pose>true</publish_nested_model_pose><publish_model_pose>false</publish_model_pose>",
            {"robot::arm"},
        ),
        ("<publish_model_pose>true</publish_model_pose>", set()),
    ],
)
def test_which_models_are_published(publish: Callable[..., Any], parameters: str, models: set[str]) -> None:
    _, heard = publish(f"<publish_link_pose>false</publish_link_pose>{parameters}")
    assert {pose.name for pose in heard["/model/robot/pose"]} == models


def test_poses_lead_from_the_parent_to_the_entity(publish: Callable[..., Any]) -> None:
    world, heard = publish(ALL, steps=300)
    last = {pose.name: pose for pose in heard["/model/robot/pose"]}
    truth = world.truth.pose("robot")
    assert last["robot"].position.x == pytest.approx(truth.position[0], abs=1e-9)
    wheel = (world.truth.pose("robot").inverse() * world.truth.link_pose("robot", "wheel")).quaternion
    assert abs(wheel[2]) > 0.01
    at = last["robot::wheel"].orientation
    assert (at.w, at.x, at.y, at.z) == pytest.approx(tuple(wheel), abs=1e-9)


def test_one_message_of_all(publish: Callable[..., Any]) -> None:
    _, heard = publish(VECTOR, steps=2, kind=Pose_V)
    first, _ = heard["/model/robot/pose"]
    assert [pose.name for pose in first.pose] == ["robot::arm::hand", "robot::base", "robot::wheel", "robot::plate"]


def test_the_frequency_is_of_simulated_time(publish: Callable[..., Any]) -> None:
    _, heard = publish(f"{VECTOR}<update_frequency>50</update_frequency>", steps=1000, kind=Pose_V)
    stamps = [message.pose[0].header.stamp.nsec for message in heard["/model/robot/pose"]]
    assert stamps[:3] == [20_000_000, 40_000_000, 60_000_000]
    assert len(stamps) == 50


def test_what_no_joint_moves_is_static(publish: Callable[..., Any]) -> None:
    rates = "<update_frequency>100</update_frequency><static_update_frequency>10</static_update_frequency>"
    _, heard = publish(f"{VECTOR}<static_publisher>true</static_publisher>{rates}", steps=200, kind=Pose_V)
    moving, static = heard["/model/robot/pose"], heard["/model/robot/pose_static"]
    assert [pose.name for pose in moving[0].pose] == ["robot::wheel"]
    assert {pose.name for pose in static[0].pose} == {"robot::base", "robot::plate", "robot::arm::hand"}
    assert (len(moving), len(static)) == (20, 2)


def test_static_poses_come_as_often_as_the_others_by_default(publish: Callable[..., Any]) -> None:
    _, heard = publish(
        f"{VECTOR}<static_publisher>true</static_publisher><update_frequency>100</update_frequency>", 100, Pose_V
    )
    assert [len(messages) for messages in heard.values()] == [10, 10]


def test_a_joint_to_a_nested_model_moves_the_model(publish: Callable[..., Any]) -> None:
    _, heard = publish(f"{ALL}{VECTOR}<static_publisher>true</static_publisher>", 1, Pose_V, shoulder="revolute")
    moving, static = ({pose.name for pose in messages[0].pose} for messages in heard.values())
    assert moving == {"robot::wheel", "robot::arm"}
    assert "robot::arm::hand" in static


def test_a_nested_model_may_have_its_own(publish: Callable[..., Any]) -> None:
    topic = "/model/robot/model/arm/pose"
    _, heard = publish(nested=PUBLISHER.format(""), topics=(topic,))
    assert frames(heard[topic]) == {"robot::arm::hand": "robot::arm"}


def test_two_runs_send_the_same_bytes(publish: Callable[..., Any]) -> None:
    _, heard = publish(ALL, steps=20)
    publish(ALL, steps=20)  # the same node hears both
    sent = [pose.SerializeToString() for pose in heard["/model/robot/pose"]]
    assert len(sent) == 2 * 20 * 9
    assert sent[: len(sent) // 2] == sent[len(sent) // 2 :]


def test_it_goes_on_after_the_world_was_built_anew(load_text: Callable[..., World], node: Node) -> None:
    text = ROBOT.format(publisher=PUBLISHER.format(VECTOR), shoulder="fixed", axis="", nested="")
    world = load_text(f"<gravity>0 0 0</gravity><model name='other'><link name='l'/></model>{text}")
    heard: list[Any] = []
    node.subscribe(Pose_V, "/model/robot/pose", heard.append)
    world.attach(node)
    world.data.qvel[:] = 1.0
    world.step(10)
    world.editor.remove("other")  # every body has another id now
    world.step(1)
    wheel = (world.truth.pose("robot").inverse() * world.truth.link_pose("robot", "wheel")).quaternion
    pose = next(each for each in heard[-1].pose if each.name == "robot::wheel")
    assert pose.orientation.y == pytest.approx(wheel[2], abs=1e-9)
    world.close()


def test_it_belongs_into_a_model(load_text: Callable[..., World]) -> None:
    with pytest.raises(SdfError, match="belongs inside a <model>"):
        load_text(PUBLISHER.format(""))
