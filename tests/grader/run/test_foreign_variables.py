"""What the caller's shell says to ROS and DDS changes no grade."""

import os
import subprocess
import sys

import pytest

STRANGE = {
    "discovery": {"ROS_DISCOVERY_SERVER": "127.0.0.1:11811", "ROS_SUPER_CLIENT": "TRUE"},
    "middleware": {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"},
    "graphics": {"MUJOCO_GL": "nonsense"},
    "recording": {"RERUN": "off"},
    "recorder": {"RERUN": "nonsense", "RERUN_STRICT": "nonsense"},
    "protobuf": {"PROTOCOL_BUFFERS_PYTHON_IMPLEMENTATION": "nonsense"},
    "profiles": {"FASTDDS_DEFAULT_PROFILES_FILE": "/nowhere.xml", "RMW_FASTRTPS_USE_QOS_FROM_XML": "1"},
}


@pytest.mark.parametrize("name", STRANGE)
def test_full_marks_whatever_the_shell_says(root, tmp_path, name):
    words = ["grade", "00_first_run", "--submission", str(root / "solutions/00_first_run"), "--out", str(tmp_path)]
    done = subprocess.run(
        [sys.executable, "-m", "gz_course.grader", *words, "--no-page"],
        capture_output=True, text=True, cwd=root, env=os.environ | STRANGE[name], timeout=300,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
