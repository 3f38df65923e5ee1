"""`ros2 pkg create` makes packages that can be built."""

import argparse
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.sim.ros.ament_cmake.build import Package, build
from gz_course.sim.ros.launch.launch_description_sources import get_launch_description_from_python_launch_file
from gz_course.sim.ros.ros2.command.pkg import create
from gz_course.sim.ros.ros2.errors import CommandError


def run(*words):
    parser = argparse.ArgumentParser()
    create.add_arguments(parser)
    create.main(parser.parse_args([str(word) for word in words]))


def files(folder):
    return {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}


def test_a_package_of_ament_cmake_is_built_as_it_is(tmp_path, capsys):
    options = ("--license", "Apache-2.0", "--dependencies", "std_msgs", "--description", "A & B")
    run("my_robot", "--destination-directory", tmp_path, "--build-type", "ament_cmake", *options)
    folder = tmp_path / "my_robot"
    assert files(folder) == {"package.xml", "CMakeLists.txt", "LICENSE"}
    assert (folder / "src").is_dir()
    assert (folder / "include/my_robot").is_dir()
    assert capsys.readouterr().out.startswith("going to create a new package\npackage name: my_robot\n")
    assert "Apache License" in (folder / "LICENSE").read_text()
    built = build(Package(folder, tmp_path / "build", tmp_path / "install"), [Path(sys.prefix)])
    assert (built.faults, built.remarks) == ([], [])


def test_a_package_for_interfaces_is_ready_for_them(tmp_path):
    needs = ("--dependencies", "rosidl_default_generators", "std_msgs")
    run("my_msgs", "--destination-directory", tmp_path, "--license", "MIT", *needs)
    folder = tmp_path / "my_msgs"
    package = Package(folder, tmp_path / "build", tmp_path / "install")
    (folder / "msg").mkdir()
    (folder / "msg/Example.msg").write_text("std_msgs/Header header\n")
    lists = folder / "CMakeLists.txt"
    lists.write_text(re.sub("(?m)^# (rosidl|  |[)])", r"\1", lists.read_text()))
    built = build(package, [Path(sys.prefix)])
    assert (built.faults, built.remarks) == ([], [])
    assert (tmp_path / "install/share/my_msgs/msg/Example.msg").is_file()


def test_a_package_of_ament_python_has_its_node_a_launch_file_and_tests(tmp_path, capsys):
    options = ("--node-name", "talker", "--library-name", "tools", "--description", 'It\'s "mine"')
    run("robot", "--destination-directory", tmp_path, "--build-type", "ament_python", *options)
    folder = tmp_path / "robot"
    given = {}
    text = (folder / "setup.py").read_text().replace("from setuptools import find_packages, setup", "")
    exec(text, {"setup": given.update, "find_packages": lambda exclude: ["robot"]})
    assert given["entry_points"] == {"console_scripts": ["talker = robot.talker:main"]}
    assert given["description"] == 'It\'s "mine"'
    assert given["data_files"][2][0] == "share/robot/launch"
    assert "Unknown license 'TODO: License declaration'" in capsys.readouterr().out
    exec((folder / "robot/talker.py").read_text(), {"__name__": "__main__"})
    assert capsys.readouterr().out == "Hi from robot.\n"
    assert {"resource/robot", "robot/tools/__init__.py", "test/test_package.py", "test/test_talker.py"} < files(folder)
    assert "script_dir=$base/lib/robot\n" in (folder / "setup.cfg").read_text()
    described = get_launch_description_from_python_launch_file(str(folder / "launch/talker.launch.py"))
    assert described.entities[0].node_executable[0].text == "talker"


def test_a_library_in_cpp_has_its_header(tmp_path, capsys):
    run("arm", "--destination-directory", tmp_path, "--node-name", "joint", "--library-name", "joint")
    assert {"src/joint.cpp", "src/joint_node.cpp", "include/arm/joint.hpp"} < files(tmp_path / "arm")
    assert "[WARNING] renaming node to joint_node\n" in capsys.readouterr().err
    run("leg", "--destination-directory", tmp_path, "--build-type", "cmake", "--library-name", "joint")
    assert {"CMakeLists.txt", "legConfig.cmake.in"} < files(tmp_path / "leg")


def test_known_licenses_are_printed(capsys):
    run("robot", "--license", "?")
    assert capsys.readouterr().out.splitlines()[:2] == ["Supported licenses:", "Apache-2.0"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["My-Robot"], "'My-Robot' cannot be the name of a package; expected small letters, digits and underscores"),
        (["robot", "--node-name", "a.b"], "'a.b' cannot be the name of a node"),
        (["test"], "does not support the package name 'test'"),
        (["taken"], "The directory already exists: "),
    ],
)
def test_what_cannot_be_made_is_one_sentence(tmp_path, words, sentence):
    (tmp_path / "taken").mkdir()
    with pytest.raises(CommandError) as error:
        run(*words, "--destination-directory", tmp_path)
    assert sentence in str(error.value)
    assert [path.name for path in tmp_path.iterdir()] == ["taken"]


@pytest.mark.proof
def test_what_is_made_is_built_tested_and_run(tmp_path):
    pytest.importorskip("colcon_core", reason="colcon is not installed")
    source = tmp_path / "src"
    run("robot", "--destination-directory", source, "--build-type", "ament_python", "--node-name", "talker")
    run("msgs", "--destination-directory", source, "--dependencies", "rosidl_default_generators", "std_msgs")
    script = (
        "colcon build && colcon test && colcon test-result --verbose && source install/setup.bash && "
        "ros2 run robot talker && ros2 launch robot talker.launch.py && ros2 pkg prefix msgs"
    )
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    ended = subprocess.run(
        ["bash", "-c", script],
        cwd=tmp_path,
        env=environment | {"PATH": path, "ROS_LOG_DIR": str(tmp_path / "log")},
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "Summary: 2 tests, 0 errors, 0 failures" in ended.stdout
    assert "\nHi from robot.\n" in ended.stdout
    assert "[talker-1] Hi from robot." in ended.stdout
    built = ended.stderr.partition("no test of msgs was run")[0]
    assert "warning" not in built.lower()
