"""`colcon build` takes interface packages and those that use them (skipped without the extra `colcon`)."""

import os
import subprocess
import sys

import pytest

pytest.importorskip("colcon_core", reason="colcon is not installed: pip install -c constraints.txt -e '.[colcon]'")

MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>0.1.0</version><description>A package</description>
  <maintainer email="me@example.com">Me</maintainer><license>Apache-2.0</license>
  <depend>{needs}</depend>
  {group}
  <export><build_type>{kind}</build_type></export>
</package>
"""
GROUP = "<member_of_group>rosidl_interface_packages</member_of_group>"
LISTS = """\
cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
find_package({needs} REQUIRED)
rosidl_generate_interfaces(${{PROJECT_NAME}} "msg/{message}.msg" DEPENDENCIES {needs})
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  ament_lint_auto_find_test_dependencies()
endif()
ament_package()
"""
SETUP = """\
from setuptools import find_packages, setup
setup(
    name="arm_user", version="0.1.0", packages=find_packages(),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arm_user"]),
        ("share/arm_user", ["package.xml"]),
    ],
    entry_points={"console_scripts": ["loop = arm_user.loop:main"]},
)
"""
LOOP = """\
import rclpy
from arm_msgs.msg import Arm
from joint_msgs.msg import Joint
def main():
    rclpy.init()
    node = rclpy.create_node("loop")
    got = rclpy.task.Future()
    node.create_subscription(Arm, "arm", got.set_result, 1)
    publisher = node.create_publisher(Arm, "arm", 1)
    node.create_timer(0.05, lambda: publisher.publish(Arm(joints=[Joint(angle=1.5)])))
    rclpy.spin_until_future_complete(node, got)
    print(got.result())
    node.destroy_node()
    rclpy.shutdown()
"""
FILES = {
    "joint_msgs/package.xml": MANIFEST.format(name="joint_msgs", needs="std_msgs", group=GROUP, kind="ament_cmake"),
    "joint_msgs/CMakeLists.txt": LISTS.format(name="joint_msgs", needs="std_msgs", message="Joint"),
    "joint_msgs/msg/Joint.msg": "std_msgs/Header header\nfloat64 angle\n",
    "arm_msgs/package.xml": MANIFEST.format(name="arm_msgs", needs="joint_msgs", group=GROUP, kind="ament_cmake"),
    "arm_msgs/CMakeLists.txt": LISTS.format(name="arm_msgs", needs="joint_msgs", message="Arm"),
    "arm_msgs/msg/Arm.msg": "joint_msgs/Joint[] joints\n",
    "arm_user/package.xml": MANIFEST.format(name="arm_user", needs="arm_msgs", group="", kind="ament_python"),
    "arm_user/setup.py": SETUP,
    "arm_user/setup.cfg": "[develop]\nscript_dir=$base/lib/arm_user\n[install]\ninstall_scripts=$base/lib/arm_user\n",
    "arm_user/resource/arm_user": "",
    "arm_user/arm_user/__init__.py": "",
    "arm_user/arm_user/loop.py": LOOP,
}


class Workspace:
    """A folder with packages in src, and what a user types there."""

    def __init__(self, folder, domain):
        self.folder = folder
        self.environment = {
            "HOME": str(folder),
            "PATH": f"{os.path.dirname(sys.executable)}:/usr/bin:/bin",  # noqa: PTH120
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        }
        for name, text in FILES.items():
            self.write(name, text)

    def write(self, name, text):
        path = self.folder / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def build(self, *options):
        return self._run([sys.executable, "-m", "colcon", "build", *options])

    def sourced(self, line):
        """Return what a line prints in a shell that has sourced the workspace."""
        done = self._run(["bash", "-c", f". install/setup.bash; {line}"])
        assert (done.returncode, done.stderr) == (0, ""), done.stdout
        return done.stdout

    def _run(self, command):
        return subprocess.run(
            command, cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=600, check=False
        )


@pytest.fixture
def workspace(tmp_path, free_domain):
    return Workspace(tmp_path, free_domain)


LAYOUTS = [
    (),
    pytest.param(("--merge-install",), marks=pytest.mark.proof),
    pytest.param(("--symlink-install",), marks=pytest.mark.proof),
    pytest.param(("--merge-install", "--symlink-install"), marks=pytest.mark.proof),
]


@pytest.mark.parametrize("options", LAYOUTS, ids=lambda value: " ".join(value) or "isolated")
def test_interfaces_of_ones_own_are_built_shown_and_sent(workspace, options):
    built = workspace.build(*options)
    assert built.returncode == 0, built.stdout + built.stderr
    assert "WARNING" not in built.stderr
    assert workspace.sourced("ros2 interface show arm_msgs/msg/Arm").splitlines()[0] == "joint_msgs/Joint[] joints"
    header = "std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=0, nanosec=0), frame_id='')"
    joint = f"joint_msgs.msg.Joint(header={header}, angle=1.5)"
    assert workspace.sourced("ros2 run arm_user loop") == f"arm_msgs.msg.Arm(joints=[{joint}])\n"


def test_a_fault_stops_the_build_with_file_and_line_and_a_change_is_taken(workspace):
    assert workspace.build("--packages-up-to", "arm_msgs").returncode == 0
    workspace.write("joint_msgs/msg/Joint.msg", "float64 angle\nfloat46 speed\n")
    failed = workspace.build("--packages-select", "joint_msgs")
    assert failed.returncode == 1
    path = workspace.folder / "src/joint_msgs/msg/Joint.msg"
    assert f"{path}:2: unknown type 'float46'; did you mean 'float64'?\n" in failed.stderr
    assert "Traceback" not in failed.stderr
    workspace.write("joint_msgs/msg/Joint.msg", "float64 angle\nfloat64 speed\n")
    built = workspace.build("--packages-select", "joint_msgs")
    assert (built.returncode, built.stderr) == (0, "")
    code = "from arm_msgs.msg import Arm; from joint_msgs.msg import Joint; print(Arm(joints=[Joint(speed=2.0)]))"
    assert "speed=2.0" in workspace.sourced(f"python3 -c '{code}'")
