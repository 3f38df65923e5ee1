"""`create` against a real `gz sim`: every source, option and error."""

import math
import signal

import psutil
import pytest

from gz_course.sim.gz.msgs.empty_pb2 import Empty
from gz_course.sim.gz.msgs.stringmsg_v_pb2 import StringMsg_V

GROUND = "<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>"
CUBE = (
    "<sdf version='1.9'><model name='cube'><static>true</static><link name='l'><collision name='c'><geometry><box>"
    "<size>1 1 1</size></box></geometry></collision></link></model></sdf>"
)
URDF = (
    "<robot name='urdf_cube'><link name='l'><inertial><mass value='1'/><inertia {}/></inertial></link></robot>".format(
        "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'"
    )
)


@pytest.fixture(scope="module")
def world(programs):
    programs.gz_sim(GROUND)
    (programs.folder / "cube.sdf").write_text(CUBE)
    (programs.folder / "robot.urdf").write_text(URDF)
    (programs.folder / "robot.urdf.xacro").write_text(
        URDF.replace("<robot ", "<robot xmlns:xacro='http://www.ros.org/wiki/xacro' ").replace(
            "urdf_cube", "xacro_cube"
        )
    )
    (programs.folder / "bad.sdf").write_text("<sdf version='1.9'>\n<model name='bad'>\n<link/></model></sdf>")
    programs.scene()
    return programs


@pytest.fixture
def create(world):
    return lambda *words, **variables: world.finished("gz_course.sim.bridge.ros_gz_sim.create", *words, **variables)


def test_a_file_at_a_pose(create, world):
    words = ["-world", "small", "-file", "cube.sdf", "-name", "posed", "-x", "1", "-y", "-2.5", "--z=1e1"]
    code, said = create(*words, "-R", "0.1", "-P", "0.2", "-Y", "0.3")
    assert (code, "Entity creation successful" in said) == (0, True)
    pose = world.scene()["posed"].pose
    assert (pose.position.x, pose.position.y, pose.position.z) == (1.0, -2.5, 10.0)
    # R = Rz(0.3) Ry(0.2) Rx(0.1): its third row gives roll and pitch, its first column yaw.
    w, x, y, z = pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z
    assert math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)) == pytest.approx(0.1)
    assert math.asin(2 * (w * y - z * x)) == pytest.approx(0.2)
    assert math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)) == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("words", "name"),
    [
        (["-string", CUBE], "cube"),
        (["-file", "robot.urdf"], "urdf_cube"),
        (["-file", "robot.urdf.xacro"], "xacro_cube"),
        (["-file", "model://crate", "-z", "3"], "crate"),
        (["-file", "package://shapes/cube.sdf", "-name", "packed"], "packed"),
        (["-param", "it", "-name", "from_param", "--ros-args", "-p", f"it:={CUBE}"], "from_param"),
        (["--ros-args", "-p", "file:=cube.sdf", "-p", "name:=by_parameters", "-p", "x:=3"], "by_parameters"),
    ],
)
def test_sources(create, world, words, name):
    share = world.folder / "share" / "shapes"
    share.mkdir(parents=True, exist_ok=True)
    (share / "cube.sdf").write_text(CUBE)
    code, said = create(*words, AMENT_PREFIX_PATH=str(world.folder))
    assert code == 0, said
    assert name in world.scene()


def test_a_xacro_file_is_expanded_with_a_warning(create, world):
    code, said = create("-file", "robot.urdf.xacro", "-name", "warned")
    assert (code, said.count("by no `create` of a full installation")) == (0, 1)
    assert "full installation" not in create("-file", "robot.urdf", "-name", "unwarned")[1]


def test_a_text_that_was_published_before(create, world, ros_node):
    from rclpy.qos import DurabilityPolicy, QoSProfile
    from std_msgs.msg import String

    profile = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    ros_node.create_publisher(String, "/robot_one/robot_description", profile).publish(String(data=URDF))
    words = ["-topic", "robot_description", "-name", "told", "--ros-args", "-r", "__ns:=/robot_one"]
    code, said = create(*words)
    assert code == 0, said
    assert "Waiting messages on topic [/robot_one/robot_description]." in said
    assert "told" in world.scene()


def test_a_taken_name(create, world):
    words = ["-string", CUBE, "-name", "twin"]
    assert create(*words)[0] == 0
    code, said = create(*words)
    assert code == 1
    assert "create: world 'small' already has something called 'twin'; choose another -name" in said
    assert create(*words, "-allow_renaming")[0] == 0
    assert {"twin", "twin_0"} <= set(world.scene())


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        ([], 2, "Must specify either -file, -param, -string or -topic"),
        (["-file", "cube.sdf", "-string", CUBE], 2, "-file and -string are both given"),
        (["-topic", "/a", "--ros-args", "-p", "file:=cube.sdf"], 2, "-file and -topic are both given"),
        (["-file", "cube.sdf", "-x", "nan"], 2, "-x must be a finite number, got 'nan'"),
        (["-file", "cube.sdf", "--ros-args", "-p", "z:=.inf"], 2, "the parameter z must be a finite number, got 'inf'"),
        (["-file", "cube.sdf", "-timeout", "0"], 2, "-timeout must be above 0"),
        (["-param", "x_y"], 2, "-param names the parameter 'x_y', which this node does not have as a text"),
        (["-topic", "//"], 2, "-topic cannot be '//'"),
        (["-file", "cub.sdf"], 1, "model 'cub.sdf' was not found"),
        (["-file", "model://crat"], 1, "did you mean 'crate'?"),
        (["-file", "bad.sdf"], 1, "bad.sdf:3:"),
        (["-string", "no xml"], 1, "the entity was not created: <string>:1:"),
        (["-string", "<robot name='r'/>"], 1, "robot 'r' has no <link>"),
        (["-topic", "/nobody", "-timeout", "0.5"], 1, "no message came on the topic '/nobody' within 0.5 s: nobody"),
        (
            ["-file", "cube.sdf", "-world", "smal", "-timeout", "1"],
            1,
            "no world 'smal' appeared within 1 s; worlds that",
        ),
    ],
)
def test_what_goes_wrong(world, call, words, code, sentence):
    ended, said = call("gz_course.sim.bridge.ros_gz_sim.create", *words)
    assert (ended, sentence in said) == (code, True), said


def test_another_world_is_told_at_once_with_the_nearest_name(world, call):
    said = call("gz_course.sim.bridge.ros_gz_sim.create", "-file", "cube.sdf", "-world", "smal", "-timeout", "0.5")[1]
    assert "Waiting for world 'smal': worlds that run are: small; did you mean 'small'?" in said


def test_no_simulator(create):
    code, said = create("-string", CUBE, "-timeout", "0.5", GZ_PARTITION="nobody_is_here")
    assert code == 1
    assert "create: no simulator answered within 0.5 s; start gz sim with the same GZ_PARTITION as here" in said


def test_a_world_without_user_commands(programs, create):
    world = "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>"
    partition = f"{programs.partition}-bare"
    path = programs.folder / "bare.sdf"
    path.write_text(f"<sdf version='1.9'><world name='bare'>{world}</world></sdf>")
    programs.module("gz_course.sim.bridge.ros_gz_sim.gzserver", "-world_sdf_file", path, GZ_PARTITION=partition)
    with programs.gz_node(partition) as node:
        assert node.request("/gazebo/worlds", None, Empty, StringMsg_V, 60_000)[0], "the server runs"
    code, said = create("-string", CUBE, "-timeout", "5", GZ_PARTITION=partition)
    assert code == 1
    assert "world 'bare' runs but offers no service" in said
    assert "gz-sim-user-commands-system" in said


def test_the_simulator_may_start_later(programs, create, free_domain):
    partition = f"{programs.partition}-late"
    early = programs.module(
        "gz_course.sim.bridge.ros_gz_sim.create", "-topic", "/late_text", "-timeout", "25", GZ_PARTITION=partition
    )
    text = programs.module(
        "gz_course.sim.bridge.ros_gz_sim.create",
        "-string",
        CUBE,
        "-world",
        "late",
        "-timeout",
        "25",
        GZ_PARTITION=partition,
    )
    early.wait_for("Waiting messages on topic [/late_text].")
    programs.module(
        "gz_course.sim.bridge.ros_gz_sim.gzserver",
        "-world_sdf_string",
        f"<sdf version='1.9'><world name='late'>{GROUND}</world></sdf>",
        GZ_PARTITION=partition,
    )
    assert text.wait() == 0, text.said
    assert early.stop() == 130


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_ends_the_wait(programs, world, number):
    waiting = programs.module(
        "gz_course.sim.bridge.ros_gz_sim.create", "-file", "cube.sdf", "-world", "nowhere", "-timeout", "600"
    )
    waiting.wait_for("Waiting for world 'nowhere'")
    assert waiting.stop(number) == 130
    assert "create: interrupted" in waiting.said


@pytest.mark.parametrize("to_all", [True, False], ids=["ctrl-c", "only the launch"])
def test_a_launch_whose_create_waits_ends_at_once(programs, world, to_all):
    """Ctrl-C in a terminal reaches launch and create at the same time; `kill` reaches only the launch."""
    file = programs.folder / "waits.launch.py"
    file.write_text(
        "from launch import LaunchDescription\n"
        "from launch_ros.actions import Node\n"
        "def generate_launch_description():\n"
        "    words = ['-file', 'cube.sdf', '-world', 'nowhere', '-timeout', '600']\n"
        "    return LaunchDescription([Node(package='ros_gz_sim', executable='create', arguments=words)])\n"
    )
    launch = programs.ros2("launch", file)
    launch.wait_for("Waiting for world 'nowhere'")
    family = psutil.Process(launch.process.pid).children(recursive=True)
    assert family
    for process in family if to_all else []:
        process.send_signal(signal.SIGINT)
    launch.stop()
    assert "create: interrupted" in launch.said
    assert "sending signal 'SIGTERM'" not in launch.said, "it had to be asked twice"
    assert not [process for process in family if process.is_running()]
