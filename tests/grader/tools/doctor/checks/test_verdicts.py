"""What the doctor makes of a shell's variables, of versions, of disks and of what lies about."""

import mmap
import os
import subprocess
import sys
from pathlib import Path

import psutil
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.process.temporary_folder import OWNER, TemporaryFolder, sweep
from gz_course.grader.run.domain import Domain
from gz_course.grader.tools.doctor.checks import (
    disk,
    installations,
    leftovers,
    ros_libraries,
    ros_log,
    ros_variables,
    sandbox,
    wheels,
)

GB = 1 << 30


@pytest.mark.parametrize(
    ("variables", "status", "word"),
    [
        ({}, "ok", "domain 0"),
        ({"ROS_DOMAIN_ID": "101", "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, "ok", "LOCALHOST"),
        ({"ROS_DOMAIN_ID": "102"}, "warning", "102"),
        ({"ROS_DOMAIN_ID": "233"}, "failed", "233"),
        ({"ROS_DOMAIN_ID": "-1"}, "failed", "-1"),
        ({"ROS_DOMAIN_ID": "seven"}, "failed", "seven"),
        ({"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}, "failed", "rmw_cyclonedds_cpp"),
        ({"RMW_IMPLEMENTATION": "rmw_fastrtps_cpp"}, "ok", "rmw_fastrtps_cpp"),
        ({"FASTDDS_DEFAULT_PROFILES_FILE": "/nowhere.xml"}, "failed", "/nowhere.xml"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}, "warning", "OFF"),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCAL"}, "failed", "LOCAL"),
    ],
)
def test_ros_variables(variables, status, word):
    verdict = ros_variables.judge(variables)
    assert (verdict.status, word in verdict.seen) == (status, True), verdict


@given(st.dictionaries(st.sampled_from(["ROS_DOMAIN_ID", "RMW_IMPLEMENTATION", *ros_variables.PROFILES]), st.text()))
def test_any_value_of_a_variable_is_judged(variables):
    variables = {name: text.replace("\0", "") for name, text in variables.items()}
    assert ros_variables.judge(variables).status in ("ok", "warning", "failed")


def test_guard_and_library_path_travel_together(tmp_path):
    folders = [tmp_path / "ros_a.libs", tmp_path / "ros_b.libs"]
    for folder in folders:
        folder.mkdir()
    (tmp_path / "other.libs").mkdir()
    assert ros_libraries.library_folders(tmp_path) == folders
    guard, path = "_ROS_WHEELS_BOOTSTRAP_COMPLETE", ":".join(map(str, folders))
    cases = [
        ({guard: "1", "LD_LIBRARY_PATH": f"/opt/ros/jazzy/lib:{path}"}, "ok", ""),
        ({guard: "1"}, "failed", "ros_a.libs"),
        ({guard: "1", "LD_LIBRARY_PATH": str(folders[0])}, "failed", "ros_b.libs"),
        ({"LD_LIBRARY_PATH": path}, "failed", guard),
        ({}, "failed", guard),
    ]
    for environment, status, word in cases:
        verdict = ros_libraries.judge(environment, folders)
        assert (verdict.status, word in verdict.seen) == (status, True), (environment, verdict)


def test_where_ros_logs():
    assert ros_log.log_folder({"HOME": "/h"}) == Path("/h/.ros/log")
    assert ros_log.log_folder({"HOME": "/h", "ROS_HOME": "/r"}) == Path("/r/log")
    assert ros_log.log_folder({"HOME": "/h", "ROS_HOME": "/r", "ROS_LOG_DIR": "/l"}) == Path("/l")


def test_a_log_folder_that_is_not_there_yet_is_not_made(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "a/b"))
    assert ros_log.examine(None).status == "ok"
    assert list(tmp_path.iterdir()) == []


PINS = "# tested\nThe_Wheel==1.0\nother.wheel==2.5 ; python_version > '3'\nnothing\n"


def test_versions_are_compared_as_pip_writes_them(tmp_path, monkeypatch):
    assert wheels.pinned(PINS) == {"the-wheel": "1.0", "other-wheel": "2.5"}
    asked = ["mujoco", "ros-jazzy-rclpy[fastrtps]>=7", "ruff; extra == 'dev'", "Py_YAML ; extra == 'runtime'"]
    assert wheels.required(asked) == ["mujoco", "ros-jazzy-rclpy", "py-yaml"]
    (tmp_path / "constraints.txt").write_text(PINS)
    monkeypatch.setattr(wheels, "CONSTRAINTS", tmp_path / "constraints.txt")
    monkeypatch.setattr(wheels.metadata, "requires", lambda name: ["the-wheel"])
    for versions, status, word in [
        ({"the-wheel": "1.0"}, "ok", "1 packages"),
        ({"the-wheel": "1.1", "other-wheel": "2.5"}, "warning", "the-wheel 1.1 (tested: 1.0)"),
        ({"other-wheel": "2.5"}, "failed", "not installed: the-wheel"),
    ]:
        monkeypatch.setattr(wheels, "installed", lambda versions=versions: versions)
        verdict = wheels.examine(None)
        assert (verdict.status, word in verdict.seen) == (status, True), verdict
    monkeypatch.setattr(wheels, "CONSTRAINTS", tmp_path / "none.txt")
    assert wheels.examine(None).status == "failed"  # what is missing is told first
    monkeypatch.setattr(wheels, "installed", lambda: {"the-wheel": "1.0"})
    assert "not compared" in wheels.examine(None).seen


@pytest.mark.parametrize(("free", "status"), [(GB * 2, "ok"), (GB // 2, "warning"), (GB // 100, "failed")])
def test_the_fullest_disk_counts(free, status):
    verdict = disk.judge({Path("/roomy"): 100 * GB, Path("/small"): free})
    assert verdict.status == status and "/small" in verdict.seen


def test_limits_too_small_for_a_node(monkeypatch):
    monkeypatch.setattr(sandbox.resource, "getrlimit", lambda kind: (32, 32))
    verdict = sandbox.examine(None)
    assert verdict.status == "failed" and "ulimit" in verdict.fix


def program(folder, name):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text("#!/bin/sh\n")
    (folder / name).chmod(0o755)
    return folder / name


def test_whose_commands_answer(tmp_path):
    ours, theirs = tmp_path / "venv/bin", tmp_path / "opt/bin"
    for name in installations.COMMANDS:
        program(ours, name)
    prefix = tmp_path / "venv"
    judge = installations.judge
    assert judge({"PATH": str(ours)}, prefix, str(prefix / "rclpy.py")).status == "ok"
    assert "ROS_DISTRO" in judge({"PATH": str(ours), "ROS_DISTRO": "jazzy"}, prefix, None).seen
    assert "parameter_bridge" in judge({"PATH": "/nowhere"}, prefix, None).seen
    gz = program(theirs, "gz")
    assert str(gz) in judge({"PATH": f"{theirs}:{ours}"}, prefix, None).seen
    assert "/opt/ros/rclpy.py" in judge({"PATH": str(ours)}, prefix, "/opt/ros/rclpy.py").seen
    real = program(tmp_path / "ros/bin", "ros2")
    marker = tmp_path / "ros/share/ament_index/resource_index/packages"
    marker.mkdir(parents=True)
    (marker / "ros2cli").write_text("")
    sourced = {"PATH": str(ours), "AMENT_PREFIX_PATH": str(tmp_path / "ros")}
    assert f"`ros2` is {real}" in judge(sourced, prefix, None).seen


def test_only_what_nobody_uses_is_left_over(tmp_path):
    for name in ("fastrtps_a", "fastrtps_a_el", "fastrtps_port7001", "sem.fastrtps_port7001_mutex", "fastrtps_b_el"):
        (tmp_path / name).write_bytes(b"x" * mmap.PAGESIZE)
    (tmp_path / "somebody_elses").write_text("")
    code = f"""
import mmap, sys
with open({str(tmp_path / "fastrtps_a")!r}, "rb") as stream:
    mapped = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
opened = open({str(tmp_path / "sem.fastrtps_port7001_mutex")!r}, "rb")
print("holds them", flush=True)
sys.stdin.read()
"""
    with subprocess.Popen([sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        assert holder.stdout.readline() == b"holds them\n"
        used = leftovers.in_use([psutil.Process(holder.pid)], tmp_path)
        holder.stdin.close()
    assert leftovers.unused_segments(tmp_path, used) == ["fastrtps_b_el"]
    assert len(leftovers.unused_segments(tmp_path, set())) == 5


def test_old_folders_of_the_course(tmp_path):
    for name in ("course-abcd1234", "playground-abcd1234", "course-class-abcd1234", "course-notes", "other-abcd1234"):
        (tmp_path / name).mkdir()
    (tmp_path / "course-class-abcd1234" / OWNER).write_text("")  # a long class may go on in there
    changed = (tmp_path / "course-abcd1234").stat().st_mtime
    os.utime(tmp_path / "playground-abcd1234", (0, 0))
    assert leftovers.old_folders(tmp_path, changed + 1) == ["playground-abcd1234"]
    assert len(leftovers.old_folders(tmp_path, changed + 2 * leftovers.OLD)) == 2


def test_the_folder_of_a_killed_run_is_told_and_left_for_the_next_one(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(leftovers, "SHARED_MEMORY", tmp_path)
    monkeypatch.setattr(leftovers, "orphaned", lambda process: False)
    code = "import os\nfrom gz_course.grader.process.temporary_folder import *\nTemporaryFolder('course-')\n"
    code += "os.kill(os.getpid(), 9)"
    subprocess.run([sys.executable, "-c", code], env=os.environ | {"TMPDIR": str(tmp_path)}, timeout=600)
    verdict = leftovers.examine(None)
    assert verdict.seen == f"1 folder in {tmp_path} of runs that were killed", verdict
    assert len(list(tmp_path.iterdir())) == 1
    with TemporaryFolder("course-"):
        sweep()
        assert leftovers.examine(None).status == "ok"


# With shared memory of its own, so that only what it leaves lies there.
KILLED_NODE = """
import subprocess, sys
from pathlib import Path
from gz_course.grader.tools.doctor.checks import leftovers
from gz_course.grader.run.sandbox.init import kernel
kernel.unshare(kernel.CLONE_NEWNS)
kernel.mount("", "/", flags=kernel.MS_REC | kernel.MS_PRIVATE)
kernel.mount("shm", "/dev/shm", "tmpfs")
code = '''
import os, rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("killed")
publisher = node.create_publisher(String, "words", 10)
os.kill(os.getpid(), 9)
'''
subprocess.run([sys.executable, "-c", code], stdout=subprocess.DEVNULL)
left = leftovers.unused_segments(Path("/dev/shm"), set())
print(any(name.startswith("fastrtps_") for name in left))
subprocess.run([Path(sys.executable).with_name("fastdds"), "shm", "clean"], stdout=subprocess.DEVNULL, check=True)
print(leftovers.unused_segments(Path("/dev/shm"), set()))
"""


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gets shared memory of its own here")
def test_what_a_killed_node_leaves_is_found_and_goes_by_what_is_told():
    command = [sys.executable, "-c", KILLED_NODE]
    with Domain() as domain:
        environment = os.environ | {"ROS_DOMAIN_ID": str(domain.id), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600)
    assert done.stdout.split() == ["True", "[]"], done.stdout + done.stderr
