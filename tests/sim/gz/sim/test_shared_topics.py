"""Two users of one topic: the names, places and advice in the warning; intended sharing is not reported."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

import pytest

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope

Load = Callable[..., World]
WHEELS = "".join(
    f"<link name='{side}'><pose>0 {y} 0 0 0 0</pose></link><joint name='{side}_joint' type='revolute'>"
    f"<parent>base</parent><child>{side}</child><axis><xyz>0 1 0</xyz></axis></joint>"
    for side, y in (("left", 0.2), ("right", -0.2))
)
JOINTS = "<left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>"
SENSORS = "<plugin filename='gz-sim-sensors-system' name='gz::sim::systems::Sensors'/>"
LIDAR = (
    "<lidar><scan><horizontal><samples>3</samples></horizontal></scan><range><min>0.1</min><max>5</max></range></lidar>"
)


def plugin(name: str, inside: str = "") -> str:
    return f"<plugin name='gz::sim::systems::{name}' filename=''>{inside}</plugin>"


def drive(topics: str = "") -> str:
    return plugin("DiffDrive", f"{JOINTS}\n{topics}\n")


def robot(name: str, *inside: str, x: float = 0.0) -> str:
    return f"<model name='{name}'><pose>{x} 0 1 0 0 0</pose><link name='base'/>{WHEELS}{''.join(inside)}</model>"


def sensor(name: str, kind: str, topic: str = "", inside: str = "") -> str:
    stated = f"\n<topic>{topic}</topic>" if topic else ""
    joint = f"<joint name='{name}_joint' type='fixed'><parent>base</parent><child>{name}_link</child></joint>"
    return f"<link name='{name}_link'><sensor name='{name}' type='{kind}'>{stated}{inside}</sensor></link>{joint}"


@pytest.fixture
def load(load_text: Load) -> Iterator[Load]:
    """Load a world on a node that is isolated from other worlds."""
    worlds: list[World] = []
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:

        def loaded(inside: str, **options: object) -> World:
            worlds.append(load_text(inside, node=node, **options))
            return worlds[-1]

        yield loaded
        for world in worlds:
            world.close()


def test_two_robots_that_listen_to_one_command_are_both_named(load: Load) -> None:
    topics = "<topic>cmd_vel</topic>"
    (warning,) = load(f"\n{robot('one', drive(topics))}\n{robot('two', drive(topics), x=2)}").warnings
    assert re.fullmatch(
        r"<string>:\d+: DiffDrive of model 'one' and DiffDrive of model 'two' both listen to /cmd_vel, so one command "
        r"moves both; give one of them a <topic> of its own, for example <topic>/model/two/cmd_vel</topic>, or none: "
        r"the default one has the model's name in it",
        warning,
    )


def test_the_line_is_that_of_the_topic_of_the_second(load: Load) -> None:
    text = f"{robot('one', drive('<topic>/go</topic>'))}{robot('two', drive('<topic>/go</topic>'), x=2)}"
    line = text.count("\n", 0, text.rindex("<topic>"))
    (warning,) = load(text).warnings
    first = load_line(load)
    assert int(warning.split(":")[1]) == first + line


def load_line(load: Load) -> int:
    """Return the line on which the text given to `load` begins."""
    world = load("\n<nonsense/>")
    (warning,) = world.warnings
    return int(warning.split(":")[1]) - 1


def test_a_robot_that_comes_twice_is_one_sentence(load: Load) -> None:
    inside = (sensor("eye", "camera", "eye/image"), sensor("beam", "gpu_lidar", "beam", LIDAR))
    (warning,) = load(robot("one", *inside) + robot("two", *inside, x=2)).warnings
    assert "models 'one' and 'two' both publish on /eye/image, " in warning
    assert "and 1 more, so listeners get the two mixed" in warning
    assert "<topic>/model/two/eye/image</topic>, or none:" in warning


def test_a_robot_that_is_spawned_is_looked_at_too_and_only_once(load: Load) -> None:
    world = load(robot("one", drive("<topic>cmd_vel</topic>")))
    assert world.warnings == []
    for number, name in enumerate(("two", "three")):
        world.editor.spawn(f"<sdf version='1.10'>{robot(name, drive('<topic>cmd_vel</topic>'), x=number + 2)}</sdf>")
        assert len(world.warnings) == number + 1
        assert f"DiffDrive of model 'one' and DiffDrive of model '{name}'" in world.warnings[-1]
    world.editor.spawn("<sdf version='1.10'><model name='box'><pose>9 9 9 0 0 0</pose><link name='l'/></model></sdf>")
    assert len(world.warnings) == 2


def test_one_that_went_is_in_nobodys_way(load: Load) -> None:
    world = load(robot("one", drive("<topic>cmd_vel</topic>")))
    world.editor.remove("one")
    world.editor.spawn(f"<sdf version='1.10'>{robot('two', drive('<topic>cmd_vel</topic>'))}</sdf>")
    assert world.warnings == []


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        (
            drive() + plugin("OdometryPublisher"),
            "DiffDrive of model 'm' and OdometryPublisher of model 'm' both publish on /model/m/odometry, so listeners "
            "get the two mixed; give one of them a <odom_topic> of its own, for example "
            "<odom_topic>/model/m/odometry_2</odom_topic>",
        ),
        (
            sensor("a", "gpu_lidar", "scan", LIDAR) + sensor("b", "gpu_lidar", "scan", LIDAR),
            "sensor 'a' of model 'm' and sensor 'b' of model 'm' both publish on /scan, /scan/points, so ",
        ),
        (
            sensor("a", "camera", "eye/left") + sensor("b", "camera", "eye/right"),
            "both publish on /eye/camera_info, so listeners get the two mixed; give one of them a <camera_info_topic>",
        ),
        (
            drive() + plugin("VelocityControl"),
            "DiffDrive of model 'm' and VelocityControl of model 'm' both listen to /model/m/cmd_vel, so one command "
            "goes to both",
        ),
        (
            sensor("a", "gpu_lidar", "see", LIDAR) + sensor("b", "camera", "see"),
            "on /see sensor 'a' of model 'm' publishes gz.msgs.LaserScan, but sensor 'b' of model 'm' publishes "
            "gz.msgs.Image; a topic carries one type; give one of them a <topic> of its own",
        ),
        (
            drive("<topic>go</topic>")
            + plugin(
                "TriggeredPublisher",
                "<input type='gz.msgs.Empty' topic='/a'/><output type='gz.msgs.Double' topic='/go'>data: 1</output>",
            ),
            "on /go TriggeredPublisher of model 'm' publishes gz.msgs.Double, but DiffDrive of model 'm' expects "
            "gz.msgs.Twist",
        ),
    ],
)
def test_what_confuses_in_one_model(load: Load, inside: str, sentence: str) -> None:
    found = [warning for warning in load(robot("m", inside)).warnings if sentence in warning]
    assert len(found) == 1 and found[0].startswith("<string>:")


@pytest.mark.parametrize(
    "inside",
    [
        robot("one", drive("<tf_topic>/tf</tf_topic>")) + robot("two", drive("<tf_topic>/tf</tf_topic>"), x=2),
        robot("one", plugin("PosePublisher")) + robot("two", plugin("PosePublisher"), x=2),
        robot(
            "one",
            *(
                plugin("JointController", f"<joint_name>{side}_joint</joint_name><topic>wheels</topic>")
                for side in ("left", "right")
            ),
        ),
        robot(
            "one",
            *(
                plugin("JointStatePublisher", f"<topic>joints</topic><joint_name>{side}_joint</joint_name>")
                for side in ("left", "right")
            ),
        ),
        robot(
            "one",
            drive("<topic>go</topic>"),
            *(
                plugin(
                    "TriggeredPublisher",
                    f"<input type='gz.msgs.Empty' topic='/{word}'/><output type='gz.msgs.Twist' topic='/go'/>",
                )
                for word in ("start", "stop")
            ),
        ),
        robot(
            "one",
            plugin(
                "TriggeredPublisher",
                "<input type='gz.msgs.Twist' topic='/go'/><output type='gz.msgs.Empty' topic='/went'/>",
            ),
            drive("<topic>go</topic>"),
        ),
    ],
)
def test_sharing_that_is_meant_is_silent(load: Load, inside: str) -> None:
    assert load(inside).warnings == []


def test_a_second_system_for_the_whole_world_is_left_out(load: Load) -> None:
    seen = robot("one", sensor("beam", "gpu_lidar", "beam", LIDAR), SENSORS)
    world = load(seen)
    (warning,) = world.warnings
    assert re.fullmatch(
        r"<string>:\d+: Sensors runs already \(see <string>:3\) and serves the whole world, this second one is "
        r"ignored; remove it",
        warning,
    )
    assert [type(each).__name__ for each in world.systems] == ["Sensors"]


def test_strict_loading_refuses_it(load: Load) -> None:
    text = robot("one", drive("<topic>cmd_vel</topic>")) + robot("two", drive("<topic>cmd_vel</topic>"), x=2)
    with pytest.raises(SdfError, match=r"would be 1 warning:\n  .*both listen to /cmd_vel"):
        load(text, strict=True)


@pytest.mark.parametrize("name", ["empty", "lidar_room", "pendulum", "sensors", "shapes", "two_robots", "warehouse"])
def test_the_built_in_worlds_are_silent(name: str) -> None:
    with Node(NodeOptions(scope=Scope.PROCESS)) as node:
        world = World.load(f"{name}.sdf", node=node)
        assert world.warnings == []
        world.close()
