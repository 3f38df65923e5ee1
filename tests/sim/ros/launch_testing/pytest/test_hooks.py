"""pytest collects a marked file as one launch test, and every other file as ever."""

import os
import subprocess
import sys
import tomllib
from importlib.metadata import entry_points
from pathlib import Path

ROOT = Path(__file__).parents[5]
PLUGIN = "launch_pytest = gz_course.sim.ros.launch_pytest.plugin\n"
HOOKS = "gz_course.sim.ros.launch_testing.pytest.hooks"
MARKED = """
import sys
import unittest
import launch, launch_testing, pytest
from launch.actions import ExecuteProcess
from launch_testing.actions import ReadyToTest

@pytest.mark.MARK
def generate_test_description():
    return launch.LaunchDescription([ExecuteProcess(cmd=["sleep", "600"], name="sleeper"), ReadyToTest()])

class TestIt(unittest.TestCase):
    def test_start(self, proc_info, test_args):
        proc_info.assertWaitForStartup("sleeper", timeout=60)
        assert test_args == {"a": "1"}

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_end(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info, [CODE])
"""
PLAIN = "def generate_test_description(): ...\ndef test_plain(): assert 1 + 1 == 2\n"
SKIPPED = "import pytest\npytest.skip('generate_test_description', allow_module_level=True)\n"


def test_files_with_and_without_a_mark(tmp_path):
    (tmp_path / "right_launch_test.py").write_text(MARKED.replace("MARK", "launch_test").replace("CODE", "-2"))
    (tmp_path / "wrong_ros_test.py").write_text(MARKED.replace("MARK", "rostest").replace("CODE", "0"))
    (tmp_path / "test_plain.py").write_text(PLAIN)
    (tmp_path / "test_skipped.py").write_text(SKIPPED)
    (tmp_path / "test_broken.py").write_text("generate_test_description = 1 / 0\n")
    # An environment that was set up before the plug-in came does not load it by itself.
    plug_in = () if entry_points(group="pytest11", name="launch_testing") else ("-p", HOOKS)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-rpf", "-p", "no:cacheprovider", *plug_in, "--continue-on-collection-errors",
         "--launch-args", "a:=1", "--", "."],
        cwd=tmp_path,
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path / "ros_log")},
        capture_output=True,
        text=True,
        timeout=600,
    )  # fmt: skip
    out = done.stdout
    assert "PASSED right_launch_test.py::right_launch_test" in out, out + done.stderr
    assert "FAILED wrong_ros_test.py::wrong_ros_test" in out
    assert "FAIL: TestAfter.test_end" in out and "AssertionError: Proc sleeper-1 exited with code -2" in out
    assert "PASSED test_plain.py::test_plain" in out
    assert out.count("ZeroDivisionError") and "1 failed, 2 passed, 1 skipped" in out and "1 error" in out


def test_an_installation_brings_the_plug_in():
    """The plug-in is told by metadata of its own, in a folder beside those of the course."""
    files = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    (source,) = (source for source, target in files["force-include"].items() if target.endswith(".egg-info"))
    assert (ROOT / source / "entry_points.txt").read_text() == f"[pytest11]\n{PLUGIN}launch_testing = {HOOKS}\n"
    assert "\nName: " in (ROOT / source / "PKG-INFO").read_text()
