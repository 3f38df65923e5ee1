"""Nodes of a package for tests, and the arguments they are started with."""

import json
import sys

import pytest

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch import LaunchDescription, LaunchService
from gz_course.tests.sim.ros.launch.conftest import performed  # noqa: F401

DEADLINE = 120.0
# Prints its arguments and the content of its parameter files as one line of JSON.
TELL = f"""\
#!{sys.executable} -S
import json, sys
words = sys.argv[1:]
files = [open(words[i + 1]).read() for i, word in enumerate(words) if word == "--params-file"]
print(json.dumps([words, files]))
"""


@pytest.fixture(autouse=True)
def log_folder(tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "ros_log"))
    launch_logging.reset()
    yield
    launch_logging.reset()


@pytest.fixture
def package(tmp_path, monkeypatch):
    """Return the prefix of the package my_robot with the executable `tell`; temporary files are in its folder
    `temporary`.
    """
    prefix = tmp_path / "install"
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "my_robot").touch()
    (prefix / "share/my_robot").mkdir()
    (index.parent / "component_programs").mkdir()
    (index.parent / "component_programs/my_robot").write_text("my::Tell;tell\n")
    (prefix / "lib/my_robot").mkdir(parents=True)
    (prefix / "lib/my_robot/tell").write_text(TELL)
    (prefix / "lib/my_robot/tell").chmod(0o755)
    (tmp_path / "temporary").mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    return prefix


class Told:
    """A run: its exit code, its output, the arguments of each `tell` and the texts of its parameter files."""

    def __init__(self, code, text):
        self.code = code
        self.text = text
        told = [json.loads(line.partition("] ")[2]) for line in text.splitlines() if line.startswith("[tell-")]
        self.words = [words for words, _ in told]
        self.files = [files for _, files in told]


@pytest.fixture
def tell(package, tmp_path, capsys):
    """Run actions to the end, and check that no temporary file remains."""

    def run(*entities, **configurations):
        launch_logging.reset()
        service = LaunchService()
        service.context.launch_configurations.update(configurations)
        service.include_launch_description(LaunchDescription(list(entities)))
        code = service.run()
        assert list((tmp_path / "temporary").iterdir()) == []
        return Told(code, capsys.readouterr().out)

    return run
