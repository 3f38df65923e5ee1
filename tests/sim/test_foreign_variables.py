"""Variables of other installations: each command works, and says in one sentence what it ignores."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.sim.foreign_variables import removed

BIN = Path(sys.executable).parent


def test_what_cannot_hold_is_removed_and_told():
    environment = {
        "RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp",
        "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": "cpp",
        "A": "b",
    }
    assert removed(environment) == [
        "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp is ignored: the wheels of ROS bring rmw_fastrtps_cpp only",
        "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION=cpp is ignored: protobuf has python and upb here",
    ]
    assert environment == {"A": "b"}
    assert removed(environment) == []


@pytest.mark.parametrize("value", ["", "egl", "GLFW", "osmesa", "disable", "0"])
def test_what_mujoco_knows_is_left_alone(value):
    environment = {"MUJOCO_GL": value}
    assert removed(environment) == []
    assert environment == {"MUJOCO_GL": value}


def test_what_would_end_rerun_at_its_import_is_removed():
    environment = {"RERUN_STRICT": "nonsense", "RERUN": "perhaps"}
    assert len(removed(environment)) == 2 and environment == {}
    assert removed({"RERUN_STRICT": "Yes", "RERUN": "on"}) == []


def test_the_middleware_of_a_sourced_ros_is_left_alone(tmp_path):
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "librmw_cyclonedds_cpp.so").touch()
    environment = {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp", "AMENT_PREFIX_PATH": f"/nowhere:{tmp_path}"}
    assert removed(environment) == []


@pytest.mark.parametrize("value", ["python", "upb", "cpp", "nonsense"])
def test_messages_of_gazebo_with_every_implementation_of_protobuf(value):
    code = (
        "from gz_course.sim.foreign_variables import set_aside; set_aside('test')\n"
        "from gz_course.sim.gz.msgs import message_class\n"
        "from gz.msgs.discovery_pb2 import Discovery\n"
        "P = Discovery.Publisher\n"
        "one = Discovery(version=3, pub=P(topic='/a', msg_pub=P.MessagePublisher(ctrl='b')))\n"
        "assert message_class('gz.msgs.Discovery').FromString(one.SerializeToString()) == one\n"
        "print(one.pub.msg_pub.ctrl)"
    )
    environment = os.environ | {"PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": value}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment)
    assert done.stdout == "b\n", done.stderr
    assert ("is ignored" in done.stderr) == (value in ("cpp", "nonsense"))


@pytest.mark.parametrize("command", [["gz", "msg", "-l"], ["ros2", "pkg", "list"], ["course", "list"]])
def test_commands_start_whatever_the_variables_say(command):
    strange = {"RMW_IMPLEMENTATION": "rmw_zenoh_cpp", "PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": "nonsense"}
    done = subprocess.run(
        [str(BIN / command[0]), *command[1:]], capture_output=True, text=True, env=os.environ | strange, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr.count("is ignored") == (1 if command[0] == "gz" else 2)
