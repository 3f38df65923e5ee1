"""Spawn, remove and set_pose in a running world: other entities continue exactly, and invalid input changes nothing."""

from __future__ import annotations

import math
from collections.abc import Callable
from random import Random

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import SdfError, SimError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

Load = Callable[..., World]
GEOMETRY = "<geometry><box><size>0.2 0.2 0.2</size></box></geometry>"


def box(name: str = "box", x: float = 5.0, z: float = 3.0, *, static: bool = False, inside: str = "") -> str:
    return (
        f"<sdf version='1.10'><model name='{name}'><static>{static}</static><pose>{x} 5 {z} 0 0 0.3</pose>"
        f"<link name='link'><collision name='c'>{GEOMETRY}</collision><visual name='v'>{GEOMETRY}</visual></link>"
        f"{inside}</model></sdf>"
    )


def state(world: World) -> np.ndarray:
    """Return everything on which MuJoCo's future states depend."""
    kind = int(mujoco.mjtState.mjSTATE_INTEGRATION)
    values = np.zeros(mujoco.mj_stateSize(world.model, kind))
    mujoco.mj_getState(world.model, world.data, values, kind)
    return values


def driving() -> World:
    world = World.load("lidar_room.sdf")
    drive = next(each for each in world.systems if each.name == "DiffDrive")
    drive.command(0.3, 0.4)
    world.step(700)
    return world


def test_others_do_not_notice_a_model_that_comes_and_goes_elsewhere() -> None:
    world, undisturbed = driving(), driving()
    names = [world.model.joint(number).name for number in range(world.model.njnt)]
    qpos, qvel, warm = (getattr(world.data, name).copy() for name in ("qpos", "qvel", "qacc_warmstart"))
    ctrl, time = world.data.ctrl.copy(), world.data.time
    assert world.editor.spawn(box()) == "box"
    assert [world.model.joint(number).name for number in range(len(names))] == names
    assert (world.data.qpos[: len(qpos)] == qpos).all()
    assert (world.data.qvel[: len(qvel)] == qvel).all()
    assert (world.data.qacc_warmstart[: len(warm)] == warm).all()
    assert (world.data.ctrl == ctrl).all() and world.data.time == time
    for each in (world, undisturbed):
        each.step(500)
    assert (world.data.qpos[: len(qpos)] == undisturbed.data.qpos).all()
    assert world.truth.pose("box").position[2] < 2.5, "it falls"
    world.editor.remove("box")
    assert (state(world) == state(undisturbed)).all()
    for each in (world, undisturbed):
        each.step(500)
    assert (state(world) == state(undisturbed)).all()


def test_a_model_in_the_middle_of_the_file_goes_and_the_later_ones_keep_their_state(load_text: Load) -> None:
    inside = "".join(
        box(name, x).split("'1.10'>")[1].removesuffix("</sdf>") for name, x in (("a", 1), ("b", 2), ("c", 3))
    )
    world = load_text(inside)
    world.data.qvel[:] = np.arange(18) * 0.01
    world.step(50)
    before = world.data.qpos.copy(), world.data.qvel.copy()
    world.editor.remove("b")
    assert (world.data.qpos == np.delete(before[0], slice(7, 14))).all()
    assert (world.data.qvel == np.delete(before[1], slice(6, 12))).all()
    assert world.truth.model_names() == ["a", "c"]
    assert world.entities.number("model", "b") == 0 and world.entities.number("link", "c", "link") > 0


def test_spawned_robots_drive_and_their_topics_go_with_them(node: Node) -> None:
    from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
    from gz_course.sim.gz.msgs.twist_pb2 import Twist

    world = World.load("lidar_room.sdf", node=node)
    world.step(200)
    text = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    name = world.editor.spawn(text, name="second", pose=Pose((2.0, -2.0, 0.0)))
    heard: list[object] = []
    node.subscribe(Odometry, f"/model/{name}/odometry", heard.append)
    command = Twist()
    command.linear.x = 0.3
    node.advertise(f"/model/{name}/cmd_vel", Twist).publish(command)
    world.step(1000)
    assert world.truth.pose(name).position[0] > 2.2
    assert len(heard) == pytest.approx(50, abs=2), "it publishes from its own beginning, without a burst"
    assert {f"/model/{name}/odometry", "/model/robot/odometry"} <= set(node.topic_list())
    world.editor.remove(name)
    world.step(10)
    topics = set(node.topic_list()) - {f"/model/{name}/cmd_vel", f"/model/{name}/odometry"}  # the test's own
    assert not [topic for topic in topics if f"/{name}" in topic]
    assert "/model/robot/odometry" in topics
    assert not node.topic_info(f"/model/{name}/odometry")[0]
    world.close()


def test_static_models_and_lights_come_move_and_go(load_text: Load) -> None:
    world = load_text("")
    world.editor.spawn(box("wall", static=True))
    world.editor.set_pose("wall", Pose((1.0, 2.0, 3.0)))
    assert tuple(world.truth.pose("wall").position) == (1, 2, 3)
    geom = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_GEOM, "wall::link::c")
    assert tuple(world.model.geom_pos[geom]) == (1, 2, 3)
    light = "<sdf version='1.10'><light name='lamp' type='point'><pose>0 0 4 0 0 0</pose></light></sdf>"
    assert world.editor.spawn(light) == "lamp"
    world.editor.set_pose("lamp", Pose((0.0, 1.0, 4.0)))
    assert world.model.nlight == 1 and tuple(world.model.light_pos[0]) == (0, 1, 4)
    world.editor.remove("lamp")
    world.editor.remove("wall")
    assert world.model.nlight == 0 and world.model.ngeom == 0


def test_a_model_is_set_down_with_its_motion_turned_along(load_text: Load) -> None:
    world = load_text("<gravity>0 0 0</gravity>" + box().split("'1.10'>")[1].removesuffix("</sdf>"))
    world.data.qvel[:3] = (1.0, 0.0, 0.0)
    world.step(10)
    old = world.truth.pose("box")
    new = Pose.from_rpy((1.0, 2.0, 3.0), (0.0, 0.0, old.yaw() + math.pi / 2))
    world.editor.set_pose("box", new)
    assert world.truth.pose("box").is_close(new, 1e-12)
    assert tuple(world.truth.velocity("box").linear) == pytest.approx((0, 1, 0), abs=1e-9)
    world.editor.set_pose("box::link", Pose((0.0, 0.0, 9.0)))
    assert tuple(world.truth.link_pose("box", "link").position) == (0, 0, 9)


ARM = """<model name='arm'><pose>1 1 0 0 0 0</pose><link name='base'/><link name='upper'><pose>0 0 1 0 0 0</pose></link>
<joint name='fix' type='fixed'><parent>world</parent><child>base</child></joint>
<joint name='j' type='revolute'><parent>base</parent><child>upper</child><axis><xyz>0 0 1</xyz></axis></joint>
</model>"""


def test_a_model_that_the_world_holds_is_moved_with_its_joints_as_they_are(load_text: Load) -> None:
    world = load_text(ARM)
    world.data.qpos[0] = 0.5
    world.step()
    world.editor.set_pose("arm", Pose((4.0, 0.0, 0.0)))
    assert tuple(world.truth.pose("arm").position) == (4, 0, 0)
    assert tuple(world.truth.link_pose("arm", "upper").position) == (4, 0, 1)
    assert world.data.qpos[0] == pytest.approx(0.5, abs=1e-6)
    with pytest.raises(SimError, match="hangs on a joint"):
        world.editor.set_pose("arm::upper", Pose())


def test_a_model_that_hangs_on_another_is_not_moved_alone(load_text: Load) -> None:
    models = "".join(f"<model name='{name}'><link name='l'/></model>" for name in "ab")
    world = load_text(
        f"{models}<joint name='j' type='revolute'><parent>a::l</parent><child>b::l</child><axis><xyz>0 0 1</xyz></axis>"
        "</joint>"
    )
    with pytest.raises(SimError, match="hangs on a joint of the world"):
        world.editor.set_pose("b", Pose((1.0, 0.0, 0.0)))
    world.editor.set_pose("a", Pose((1.0, 0.0, 0.0)))
    assert world.truth.pose("b").position[0] == pytest.approx(1.0)


def test_names_that_are_taken(load_text: Load) -> None:
    world = load_text("")
    assert world.editor.spawn(box()) == "box"
    with pytest.raises(SimError, match="already has something called 'box'"):
        world.editor.spawn(box())
    assert world.editor.spawn(box(x=6), allow_renaming=True) == "box_0"
    assert world.editor.spawn(box(x=7), allow_renaming=True) == "box_1"
    assert world.editor.spawn(box(x=8), name="crate") == "crate"
    assert world.truth.model_names() == ["box", "box_0", "box_1", "crate"]
    assert world.entities.number("link", "box_1", "link") > world.entities.number("link", "box", "link") > 0


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (
            lambda w: w.editor.spawn("<sdf version='1.9'><model name='x'><link></model></sdf>"),
            "<spawned>:1: .*well-formed",
        ),
        (lambda w: w.editor.spawn("<sdf version='1.9'/>"), "no <model> or <light>"),
        (lambda w: w.editor.spawn("<sdf version='1.9'><model name='x'/></sdf>"), "no link"),
        (lambda w: w.editor.spawn(""), "this is no XML"),
        (lambda w: w.editor.spawn(box("new"), pose=Pose((math.nan, 0, 0))), "not finite"),
        (lambda w: w.editor.spawn(box("new"), pose=Pose((0, 0, 0), (2, 0, 0, 0))), "unit quaternion"),
        (
            lambda w: w.editor.spawn(box("new", inside="<plugin filename='gz-sim-diff-drive-system' name='x'/>")),
            "left_joint",
        ),
        (lambda w: w.editor.remove("bx"), "did you mean 'box'"),
        (lambda w: w.editor.set_pose("bx", Pose()), "did you mean 'box'"),
        (lambda w: w.editor.set_pose("box", Pose((math.inf, 0, 0))), "not finite"),
        (lambda w: w.editor.set_pose("box", Pose((1e300, 0, 0))), "more than 1e.07 m away"),
        (lambda w: w.editor.spawn(box("new"), pose=Pose((0, 0, -1e8))), "more than 1e.07 m away"),
        (lambda w: w.editor.set_pose("box::lnk", Pose()), "did you mean 'link'"),
        (lambda w: w.editor.set_light("sun", on=False), "no light 'sun'"),
        (lambda w: w.editor.set_physics(step_size=math.nan), "max_step_size"),
        (lambda w: w.editor.set_physics(step_size=1e300), "max_step_size"),
        (lambda w: w.editor.set_physics(real_time_factor=-1.0), "real_time_factor"),
    ],
)
def test_nonsense_is_one_sentence_and_changes_nothing(
    load_text: Load, ask: Callable[[World], object], sentence: str
) -> None:
    world = load_text("")
    world.editor.spawn(box())
    world.step(10)
    before, names, count = state(world), world.truth.model_names(static=True), len(world.systems)
    with pytest.raises(SimError, match=sentence) as caught:
        ask(world)
    assert "\n" not in str(caught.value)
    assert (
        (state(world) == before).all() and world.truth.model_names(static=True) == names and len(world.systems) == count
    )
    world.step(10)


def test_a_system_that_makes_no_sense_takes_its_model_away_again(load_text: Load) -> None:
    world = load_text("")
    system = "<plugin filename='gz-sim-diff-drive-system' name='gz::sim::systems::DiffDrive'><left_joint>l</left_joint>"
    with pytest.raises(SdfError, match="joint 'l'"):
        world.editor.spawn(box("bad", inside=f"{system}<right_joint>r</right_joint></plugin>"))
    assert world.truth.model_names() == [] and world.model.nq == 0
    assert world.editor.spawn(box("bad")) == "bad"


def test_a_model_inside_another_is_said_and_pushed_out_gently(load_text: Load) -> None:
    world = load_text(box("first").split("'1.10'>")[1].removesuffix("</sdf>"))
    world.editor.spawn(box("second", x=5.05))
    assert any("'second::" in warning and "m inside each other" in warning for warning in world.warnings)
    world.step(200)
    assert abs(world.truth.velocity("second").linear[0]) < 1.0


def test_the_world_is_not_changed_in_the_middle_of_a_step(load_text: Load) -> None:
    world = load_text("<plugin filename='gz-sim-sensors-system' name='gz::sim::systems::Sensors'/>")
    caught: list[str] = []

    def meddle(_: object) -> None:
        with pytest.raises(SimError) as error:
            world.editor.spawn(box())
        caught.append(str(error.value))
        world.requests.put(lambda: world.editor.spawn(box()))

    world.systems.post_updates.append(meddle)
    world.step()
    assert "middle of a step" in caught[0]
    assert world.truth.model_names() == []
    world.systems.post_updates.remove(meddle)
    world.step()
    assert world.truth.model_names() == ["box"]


def test_a_longer_step_goes_on_from_the_same_time(load_text: Load) -> None:
    world = load_text("")
    world.step(100)
    world.editor.set_physics(step_size=0.004)
    assert world.sim_time_ns == 100_000_000
    world.step()
    assert world.sim_time_ns == 104_000_000 and world.model.opt.timestep == 0.004


def test_lights_colours_and_collisions_change(load_text: Load) -> None:
    light = "<light name='sun' type='directional'><diffuse>1 1 1 1</diffuse></light>"
    world = load_text(light + box(z=0.1, static=True).split("'1.10'>")[1].removesuffix("</sdf>"))
    world.editor.set_light("sun", diffuse=(0.5, 0.25, 0.0))
    assert tuple(world.description.lights[0].diffuse) == (0.5, 0.25, 0.0)
    link = world.description.models[0].links[0]
    world.editor.set_colour(link.visuals[0], (1.0, 0.0, 0.0, 1.0))
    visual = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_GEOM, "box::link::v#visual")
    assert tuple(world.model.geom_rgba[visual]) == (1, 0, 0, 1)
    geom = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_GEOM, "box::link::c")
    world.editor.enable_collisions(link.collisions, False)
    assert world.model.geom_contype[geom] == 0
    world.editor.enable_collisions(link.collisions, True)
    assert world.model.geom_contype[geom] == 0xFF
    world.reset()
    assert tuple(world.description.lights[0].diffuse) == (1, 1, 1)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(["spawn", "remove", "move", "step", "reset"]), max_size=12), st.randoms())
def test_any_order_of_changes_keeps_names_numbers_and_bodies_together(changes: list[str], random: Random) -> None:
    world = World.from_string("<sdf version='1.10'><world name='w'>" + ARM + "</world></sdf>")
    expected = {"arm"}
    for number, change in enumerate(changes):
        chosen = sorted(expected)[random.randrange(len(expected))] if expected else ""
        if change == "spawn":
            expected.add(world.editor.spawn(box(f"m{number}", x=3.0 * number)))
        elif change == "remove" and chosen:
            world.editor.remove(chosen)
            expected.discard(chosen)
        elif change == "move" and chosen:
            world.editor.set_pose(chosen, Pose((1.0, number, 2.0)))
            assert tuple(world.truth.pose(chosen).position) == pytest.approx((1, number, 2), abs=1e-9)
        elif change == "reset":
            world.reset()
            expected = {"arm"}
        else:
            world.step(3)
        assert set(world.truth.model_names(static=True)) == expected
        assert {each.name for each in world.entities if each.kind == "model"} == expected
        bodies = {world.model.body(body).name.split("::")[0] for body in range(1, world.model.nbody)}
        assert bodies == expected
