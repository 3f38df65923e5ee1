"""The transforms of a URDF against the kinematics of MuJoCo for the same robot."""

import math
import random

import mujoco
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.world import World
from gz_course.sim.ros.robot_state_publisher.kinematics import Kinematics

INERTIA = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"


def link(name):
    return f"<link name='{name}'>{INERTIA}</link>"


def joint(name, kind, parent, child, origin="0 0 0", rpy="0 0 0", inside=""):
    limit = "<limit lower='-3' upper='3' effort='9' velocity='9'/>" if kind in ("revolute", "prismatic") else ""
    return (
        f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='{origin}' rpy='{rpy}'/>{limit}{inside}</joint>"
    )


def axis(xyz):
    return f"<axis xyz='{xyz}'/>"


ARM = "".join(
    [
        "<robot name='arm'>",
        *map(link, ("base", "turret", "upper", "slide", "wheel", "finger")),
        joint("turn", "revolute", "base", "turret", "0.1 0.2 0.3", "0.1 -0.2 0.3", axis("0 0 1")),
        joint("lift", "revolute", "turret", "upper", "0.5 0 0.1", "0.4 0.5 -0.6", axis("1 2 -3")),
        joint("reach", "prismatic", "upper", "slide", "0 0.1 0.2", "-1 0.2 2", axis("0 2 1")),
        joint("spin", "continuous", "slide", "wheel", "0.3 0 0", "1.5 0 0"),  # the axis is x when none is given
        joint("grip", "revolute", "wheel", "finger", "0 0 0.2", "0 0.3 0", axis("0 -1 0")),
        "</robot>",
    ]
)


def chained(transforms, root):
    """Return the pose of every link in the frame of the root."""
    poses = {root: Pose()}
    for each in transforms:
        poses[each.child] = poses[each.parent] * each.pose
    return poses


@pytest.mark.parametrize("seed", range(5))
def test_every_link_is_where_mujoco_has_it(seed):
    chance = random.Random(seed)
    kinematics = Kinematics.from_urdf(ARM)
    positions = {name: chance.uniform(-2.5, 2.5) for name in kinematics.moving}
    world = World.from_string("<sdf version='1.9'><world name='w'/></sdf>")
    world.editor.spawn(ARM)
    for name, position in positions.items():
        number = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_JOINT, f"arm::{name}")
        assert number >= 0
        world.data.qpos[world.model.jnt_qposadr[number]] = position
    mujoco.mj_kinematics(world.model, world.data)
    poses = chained(kinematics.transforms(positions), kinematics.root)
    assert set(poses) == {"base", "turret", "upper", "slide", "wheel", "finger"}

    def body(name):
        number = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_BODY, f"arm::{name}")
        return Pose(world.data.xpos[number], world.data.xquat[number])

    for name, pose in poses.items():
        assert pose.is_close(body("base").inverse() * body(name), 1e-9), name


def test_fixed_joints_are_apart():
    text = f"<robot name='r'>{link('a')}{link('b')}{link('c')}"
    text += joint("stiff", "fixed", "a", "b", "1 2 3", "0 0 1.5") + joint("free", "floating", "a", "c") + "</robot>"
    kinematics = Kinematics.from_urdf(text)
    (fixed,) = kinematics.fixed
    assert (fixed.parent, fixed.child) == ("a", "b")
    assert fixed.pose.is_close(Pose.from_rpy((1, 2, 3), (0, 0, 1.5)))
    assert kinematics.moving == {}
    assert any("joint 'free' is floating" in warning for warning in kinematics.warnings)


MIMIC = (
    f"<robot name='r'>{link('a')}{link('b')}{link('c')}"
    + joint("left", "prismatic", "a", "b", inside=axis("1 0 0"))
    + joint("right", "prismatic", "a", "c", inside=axis("1 0 0") + "<mimic joint='{}' multiplier='-2' offset='0.25'/>")
    + "</robot>"
)


def test_a_joint_that_mimics_follows():
    transforms = Kinematics.from_urdf(MIMIC.format("left")).transforms({"left": 0.5, "right": 9.0, "unknown": 1.0})
    assert {each.child: each.pose.position[0] for each in transforms} == {"b": 0.5, "c": -0.75}


@given(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))
def test_turning_twice_is_turning_by_the_sum(first, second):
    text = f"<robot name='r'>{link('a')}{link('b')}{joint('j', 'continuous', 'a', 'b', inside=axis('1 -2 2'))}</robot>"
    turn = Kinematics.from_urdf(text).moving["j"]
    both = turn.transform(first).pose * turn.transform(second).pose
    assert both.is_close(turn.transform(first + second).pose, 1e-7)
    assert math.isclose(sum(part * part for part in both.quaternion), 1.0, rel_tol=1e-9)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("hello", "<robot_description>:1:"),
        ("<sdf version='1.9'/>", "the outermost element of a URDF must be <robot>, got <sdf>"),
        (MIMIC.format("lef"), "which is no joint that moves; did you mean 'left'?"),
        (MIMIC.format("right"), "joint 'right' mimics 'right', which mimics another"),
        (ARM.replace("1 2 -3", "0 0 0"), "the <axis> of joint 'lift' has no direction"),
        (ARM.replace("<link name='upper'>", "<link name='uper'>"), "did you mean 'uper'?"),
    ],
)
def test_what_is_no_robot(text, sentence):
    with pytest.raises(SdfError) as caught:
        Kinematics.from_urdf(text)
    assert sentence in str(caught.value)
