"""Packages that pip does not provide: after they are built, their services and transforms are bridged over DDS."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

GROUND = "<include><uri>model://ground_plane</uri></include>"
CUBE = "<sdf version='1.9'><model name='cube'><static>true</static><link name='l'/></model></sdf>"
ROOT = Path(__file__).parents[3]
KINDS = {
    "control": "ControlWorld",
    "create": "SpawnEntity",
    "set_pose": "SetEntityPose",
    "remove": "DeleteEntity",
}

pytestmark = [
    pytest.mark.proof,  # compiling takes most of a minute
    pytest.mark.skipif(not (shutil.which("gcc") and shutil.which("g++")), reason="needs gcc and g++"),
]


@pytest.fixture(scope="module")
def python_path(tmp_path_factory):
    """Return a folder with the built packages."""
    folder = tmp_path_factory.mktemp("built")
    words = [sys.executable, "-m", "gz_course.tests.sim.ros_gz_bridge.built_interfaces", str(folder)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr
    return {"PYTHONPATH": os.pathsep.join(filter(None, [str(folder / "python"), os.environ.get("PYTHONPATH")]))}


@pytest.fixture(scope="module")
def bridge(programs, python_path):
    """Return a bridge of four services and of transforms beside a running world `small`."""
    programs.gz_sim(GROUND)
    services = [f"/world/small/{name}@ros_gz_interfaces/srv/{kind}" for name, kind in KINDS.items()]
    transforms = "/model/robot/tf@tf2_msgs/msg/TFMessage[gz.msgs.Pose_V"
    bridge = programs.ros2("run", "ros_gz_bridge", "parameter_bridge", *services, transforms, **python_path)
    bridge.wait_for("ready: 5 bridges")
    programs.scene()  # the world is running
    yield bridge
    assert bridge.stop() == 0


@pytest.fixture
def call(programs, python_path, bridge):
    def call(name, request):
        words = ["service", "call", f"/world/small/{name}", f"ros_gz_interfaces/srv/{KINDS[name]}", request]
        program = programs.ros2(*words, **python_path)
        assert program.wait() == 0, program.said
        return program.said

    return call


def test_the_four_services_of_a_world(programs, call):
    said = call("create", f'{{entity_factory: {{name: box, sdf: "{CUBE}", pose: {{position: {{x: 2.0}}}}}}}}')
    assert "success=True" in said
    assert programs.scene()["box"].pose.position.x == 2.0
    said = call("set_pose", "{entity: {name: box}, pose: {position: {y: 3.0}, orientation: {w: 1.0}}}")
    assert "success=True" in said
    assert "success=True" in call("control", "{world_control: {pause: true, multi_step: 5}}")
    moved = programs.scene()["box"].pose.position
    assert (moved.x, moved.y) == (0.0, 3.0)
    assert "success=True" in call("remove", "{entity: {name: box, type: 2}}")
    assert "box" not in programs.scene()


def test_what_cannot_be_done_is_said(bridge, call):
    assert "success=False" in call("create", "{entity_factory: {name: nothing}}")
    bridge.wait_for("there is nothing to spawn: none of sdf, sdf_filename, clone_name is given")
    assert "success=False" in call("create", f'{{entity_factory: {{sdf: "{CUBE}", pose: {{position: {{z: .nan}}}}}}}}')
    bridge.wait_for("entity_factory.pose.position.z is nan")


def test_transforms_arrive(programs, python_path, bridge):
    from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

    poses = Pose_V()
    pose = poses.pose.add()
    for key, value in (("frame_id", "robot::odom"), ("child_frame_id", "robot::base")):
        pose.header.data.add(key=key).value.append(value)
    pose.position.x = 1.5
    echo = programs.ros2("topic", "echo", "--once", "/model/robot/tf", "tf2_msgs/msg/TFMessage", **python_path)
    with programs.gz_node() as node:
        publisher = node.advertise("/model/robot/tf", Pose_V)
        assert publisher.wait_for_subscribers(timeout=120)
        while echo.process.poll() is None:
            publisher.publish(poses)
            try:
                echo.process.wait(0.1)
            except subprocess.TimeoutExpired:
                continue
    assert echo.wait() == 0
    for words in ("frame_id: robot/odom", "child_frame_id: robot/base", "x: 1.5"):
        assert words in echo.said
