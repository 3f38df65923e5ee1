"""A ROS 2 and a Gazebo of this machine, sourced in the shell, change nothing: the course imports its code by own names.

The installation is a stand-in: packages of the public names (and of names that our folders have), programs and an
ament prefix, all of which say that they are not ours.
"""

import json
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.grader.run.domain import Domain

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
PACKAGES = ("launch", "launch_ros", "ros_gz_bridge", "ros_gz_sim", "ros_gz_image", "robot_state_publisher", "ros2cli")
NODES_USE = ("cv_bridge", "laser_geometry", "message_filters", "sensor_msgs_py")
OTHERS = ("ros2", "prefix", "grader", "sim", "tests", "solutions", "docs", "gz/transport13", "gz/msgs10")
MODULES = (*PACKAGES, *NODES_USE, *OTHERS)
PROGRAMS = ("ros2", "gz", "parameter_bridge", "python3")
THEIRS = 77  # exit code of their programs


@pytest.fixture
def sourced(tmp_path):
    """The environment of a shell in which the installation is sourced."""
    prefix = tmp_path / "opt/ros/jazzy"
    python = prefix / "lib/python3.12/site-packages"
    for module in MODULES:
        (python / module).mkdir(parents=True)
        (python / module / "__init__.py").write_text("WHOSE = 'theirs'\n")
    programs = [prefix / "bin" / name for name in PROGRAMS]
    for package in PACKAGES:
        (prefix / "share" / package).mkdir(parents=True)
        marker = prefix / "share/ament_index/resource_index/packages" / package
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
        programs.append(prefix / "lib" / package / "parameter_bridge")
    for program in programs:
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(f"#!/bin/sh\necho theirs: {program.name} >&2\nexit {THEIRS}\n")
        program.chmod(program.stat().st_mode | stat.S_IXUSR | stat.S_IXGRP | stat.S_IXOTH)
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("ROS_", "GZ_", "AMENT_", "COURSE_"))}
    return kept | {
        "PATH": f"{prefix / 'bin'}{os.pathsep}{kept.get('PATH', os.defpath)}",
        "PYTHONPATH": str(python),
        "AMENT_PREFIX_PATH": str(prefix),
        "CMAKE_PREFIX_PATH": str(prefix),
        "ROS_DISTRO": "jazzy",
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
        "GZ_CONFIG_PATH": str(prefix / "share/gz"),
        "COURSE_ROOT": str(ROOT),
        "COLUMNS": "100",
    }


@pytest.fixture
def domain():
    with Domain() as held:
        yield held.id


@pytest.fixture
def run(sourced, tmp_path):
    def call(*words, timeout=600):
        return subprocess.run(
            [*map(str, words)], env=sourced, cwd=tmp_path, capture_output=True, text=True, timeout=timeout
        )

    return call


def test_the_stand_in_is_found_by_the_public_names(run):
    names = ["launch", "launch_ros", "ros_gz_bridge", "gz.transport13", "gz.msgs10", *NODES_USE]
    program = f"import {', '.join(names)}; print({', '.join(f'{n}.WHOSE' for n in names)})"
    done = run(sys.executable, "-c", program)
    assert (done.stdout, done.stderr) == (" ".join(["theirs"] * len(names)) + "\n", "")
    assert run("ros2", "topic", "list").returncode == THEIRS


@pytest.mark.parametrize(
    "exercise",
    [
        pytest.param("02_launch", marks=pytest.mark.proof),
        "03_teleop",
        pytest.param("05_yaml_bridge", marks=pytest.mark.proof),
    ],
)
def test_a_submission_earns_the_same(run, tmp_path, exercise):
    report = tmp_path / "report.json"
    done = run(
        BIN / "course", "grade", exercise, "--submission", ROOT / "solutions" / exercise, "--out", tmp_path / "out",
        "--json", report,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert json.loads(report.read_text())["score"] == 100


@pytest.mark.proof
def test_the_doctor_sees_it(run):
    done = run(BIN / "course", "doctor", "--json", "--deadline", "60")
    assert "another ROS 2 is sourced" in done.stdout and "jazzy/bin/ros2" in done.stdout, done.stdout + done.stderr
    assert "internal error" not in done.stderr


@pytest.mark.proof
def test_diagnose_looks_around(run):
    done = run(BIN / "course", "diagnose")
    assert "internal error" not in done.stdout + done.stderr
    assert done.returncode in (0, 1), done.stdout + done.stderr


def test_the_bridge_runs(sourced, tmp_path, domain):
    program = subprocess.Popen(
        [BIN / "parameter_bridge", "/chat@std_msgs/msg/String@gz.msgs.StringMsg"],
        env=sourced | {"ROS_DOMAIN_ID": str(domain), "GZ_PARTITION": tmp_path.name, "GZ_IP": "127.0.0.1"},
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    try:
        said = next(line for line in program.stdout if "Creating" in line)
        assert "/chat" in said
        program.terminate()
        assert program.wait(600) == 0
    finally:
        program.kill()
        program.wait()
        program.stdout.close()
