"""An installed or sourced launch is imported; ours is used only if there is none."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[4]
SIM, PUBLIC = ROOT / "sim", ROOT / "public"
HOOK = "gz_ros2_course_prefix.pth"
PUBLIC_NAMES = "gz_course_public_names"


def python(*options, code, **environment):
    """Run code in a new Python; return (stdout, last line of stderr)."""
    done = subprocess.run(
        [sys.executable, *options, "-c", code],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    return done.stdout.strip(), done.stderr.strip().rpartition("\n")[2]


@pytest.fixture
def real(tmp_path):
    """Return a folder with a package `launch` that is not ours."""
    folder = tmp_path / "real"
    (folder / "launch").mkdir(parents=True)
    (folder / "launch/__init__.py").write_text("who = 'real'\n")
    return folder


@pytest.fixture
def installed(tmp_path):
    """Return a site-packages folder with the files of the wheel."""
    site = tmp_path / "site"
    (site / "gz_course").mkdir(parents=True)
    (site / PUBLIC_NAMES).mkdir()
    (site / HOOK).write_text((SIM / "ros/prefix" / HOOK).read_text())
    (site / "gz_course/__init__.py").write_text((PUBLIC / "gz_course/__init__.py").read_text())
    (site / "gz_course/sim").mkdir()  # itself no link: that is how a checkout is known
    for each in SIM.iterdir():
        (site / "gz_course/sim" / each.name).symlink_to(each)
    for name in ("launch", "launch_ros"):
        (site / PUBLIC_NAMES / name).symlink_to(PUBLIC / name)
    return site


def test_a_sourced_launch_wins(real):
    assert python(code="import launch; print(launch.who)", PYTHONPATH=str(real)) == ("real", "")


def test_a_launch_installed_beside_ours_wins(real, installed):
    code = f"import site; site.addsitedir({str(installed)!r}); import launch; print(launch.__file__)"
    assert python("-S", code=code, PYTHONPATH="") == (str(installed / "gz_course/sim/ros/launch/__init__.py"), "")
    (real / "launch").rename(installed / "launch")
    assert python("-S", code=code, PYTHONPATH="") == (str(installed / "launch/__init__.py"), "")


def test_the_wheel_puts_ours_where_it_is_found_last():
    wheel = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert PUBLIC_NAMES in (SIM / "ros/prefix" / HOOK).read_text().splitlines()
    page = "docs/windows_and_mac.md"
    assert set(wheel["only-include"]) == {"sim", "grader", "public", "exercises", ".grading", "chapters", page}
    names = {path.name for path in PUBLIC.iterdir() if path.name != "__pycache__"}
    assert names > {"gz", "launch", "launch_ros"}
    for name in names - {"gz_course"}:
        assert wheel["sources"][f"public/{name}"] == f"{PUBLIC_NAMES}/{name}"


def test_our_launch_ros_does_not_build_on_a_launch_of_others(real):
    text, error = python(code="import launch_ros", PYTHONPATH=str(real))
    assert text == ""
    assert error.startswith(f"ImportError: launch comes from {real / 'launch'}, but no launch_ros stands beside it")


def test_a_folder_named_launch_is_no_launch(tmp_path):
    (tmp_path / "launch").mkdir()
    (tmp_path / "launch/robot.launch.py").touch()
    text, _ = python(
        code=f"import os; os.chdir({str(tmp_path)!r}); import launch; print(launch.LaunchService.__name__)"
    )
    assert text == "LaunchService"


@pytest.mark.parametrize("package", ["launch", "launch_ros"])
def test_an_import_loads_nothing_heavy(package):
    text, _ = python(code=f"import {package}, sys; print({{'rclpy', 'numpy', 'mujoco', 'psutil'}} & set(sys.modules))")
    assert text == "set()"
