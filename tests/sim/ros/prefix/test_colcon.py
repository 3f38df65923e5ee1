"""A user's package, built by the real colcon, is found by `ros2` (skipped without the extra `colcon`)."""

import os
import subprocess
import sys

import pytest

pytest.importorskip("colcon_core", reason="colcon is not installed: pip install -c constraints.txt -e '.[colcon]'")

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>my_robot</name><version>0.1.0</version><description>A robot of one's own</description>
  <maintainer email="me@example.com">Me</maintainer><license>Apache-2.0</license>
  <exec_depend>rclpy</exec_depend>
  <export><build_type>ament_python</build_type></export>
</package>
"""
SETUP = """\
from setuptools import find_packages, setup
setup(
    name="my_robot", version="0.1.0", packages=find_packages(), zip_safe=True,
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/my_robot"]),
        ("share/my_robot", ["package.xml"]),
        ("share/my_robot/launch", ["launch/hello.launch.py"]),
    ],
    entry_points={"console_scripts": ["hello = my_robot.hello:main"]},
)
"""
PLACES = "[develop]\nscript_dir=$base/lib/my_robot\n[install]\ninstall_scripts=$base/lib/my_robot\n"
HELLO = """\
import sys
import rclpy
def main():
    rclpy.init(args=sys.argv)
    node = rclpy.create_node("hello")
    print("I am", node.get_fully_qualified_name())
    node.destroy_node()
    rclpy.shutdown()
"""
LAUNCH = """\
from launch import LaunchDescription
from launch_ros.actions import Node
def generate_launch_description():
    return LaunchDescription([Node(package="my_robot", executable="hello", name="greeter", output="screen")])
"""
LOOK = """\
. install/setup.{shell}
ros2 pkg prefix my_robot
ros2 pkg executables my_robot
ros2 pkg prefix ros_gz_bridge
ros2 run my_robot hello
ros2 launch my_robot hello.launch.py
"""


@pytest.fixture
def workspace(tmp_path, free_domain):
    """Return a folder with src/my_robot, and the environment of a user who has activated this environment."""
    files = {
        "package.xml": MANIFEST,
        "setup.py": SETUP,
        "setup.cfg": PLACES,
        "resource/my_robot": "",
        "my_robot/__init__.py": "",
        "my_robot/hello.py": HELLO,
        "launch/hello.launch.py": LAUNCH,
    }
    for name, text in files.items():
        path = tmp_path / "src/my_robot" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    environment = {
        "HOME": str(tmp_path),
        "PATH": f"{os.path.dirname(sys.executable)}:/usr/bin:/bin",  # noqa: PTH120
        "ROS_DOMAIN_ID": str(free_domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
    }
    return tmp_path, environment


@pytest.mark.skipif(" " in sys.executable, reason="colcon's setup files do not work where Python's path has blanks")
@pytest.mark.parametrize(
    ("options", "shell"),
    [
        pytest.param((), "sh", marks=pytest.mark.proof),
        pytest.param((), "bash", marks=pytest.mark.proof),
        (("--symlink-install",), "bash"),
    ],
    ids=lambda value: str(value),
)
def test_what_colcon_has_built_is_found_and_runs(workspace, options, shell):
    folder, environment = workspace
    built = subprocess.run(
        [sys.executable, "-m", "colcon", "build", *options],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert built.returncode == 0, built.stdout + built.stderr
    looked = subprocess.run(
        [shell, "-c", LOOK.format(shell=shell)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert (looked.returncode, looked.stderr) == (0, ""), looked.stdout
    lines = looked.stdout.splitlines()
    assert lines[:2] == [str(folder / "install/my_robot"), "my_robot hello"]
    assert lines[2].endswith("/prefix")
    assert lines[3] == "I am /hello"
    assert any(line.endswith("] I am /greeter") for line in lines[4:])
