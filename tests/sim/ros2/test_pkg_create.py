"""`ros2 pkg create` makes packages that can be built."""

import argparse
import sys
from pathlib import Path

import pytest

from gz_course.sim.ament_cmake.build import Package, build
from gz_course.sim.ros2.command.pkg import create
from gz_course.sim.ros2.errors import CommandError


def run(*words):
    parser = argparse.ArgumentParser()
    create.add_arguments(parser)
    create.main(parser.parse_args([str(word) for word in words]))


def test_a_package_of_ament_cmake_is_built_as_it_is(tmp_path, capsys):
    options = ("--license", "Apache-2.0", "--dependencies", "std_msgs", "--description", "A & B")
    run("my_msgs", "--destination-directory", tmp_path, "--build-type", "ament_cmake", *options)
    folder = tmp_path / "my_msgs"
    assert {path.name for path in folder.rglob("*")} == {"package.xml", "CMakeLists.txt"}
    assert capsys.readouterr().out.startswith("going to create a new package\npackage name: my_msgs\n")
    built = build(Package(folder, tmp_path / "build", tmp_path / "install"), [Path(sys.prefix)])
    assert (built.faults, built.remarks) == ([], [])


def test_a_package_of_ament_python_has_its_node(tmp_path, capsys):
    run("robot", "--destination-directory", tmp_path, "--build-type", "ament_python", "--node-name", "talker")
    folder = tmp_path / "robot"
    given = {}
    text = (folder / "setup.py").read_text().replace("from setuptools import find_packages, setup", "")
    exec(text, {"setup": given.update, "find_packages": lambda exclude: ["robot"]})
    assert given["entry_points"] == {"console_scripts": ["talker = robot.talker:main"]}
    capsys.readouterr()
    exec((folder / "robot/talker.py").read_text(), {"__name__": "__main__"})
    assert capsys.readouterr().out == "Hi from robot.\n"
    assert (folder / "resource/robot").is_file()
    assert "script_dir=$base/lib/robot\n" in (folder / "setup.cfg").read_text()


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
