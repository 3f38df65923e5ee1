"""The ament prefix: its content, and how a new Python finds it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

from gz_course.sim.ros.prefix import local_setup

PREFIX = Path(local_setup.PREFIX)
WHEELS = ("_ROS_WHEELS_BOOTSTRAP_COMPLETE", "LD_LIBRARY_PATH")
PACKAGES = sorted(path.name for path in (PREFIX / "share/ament_index/resource_index/packages").iterdir())


@pytest.fixture
def python(tmp_path):
    """Run code in a Python that loads the hook as from site-packages, in a cleaned environment."""
    site = tmp_path / "site"
    site.mkdir()
    shutil.copy(PREFIX / "gz_ros2_course_prefix.pth", site)
    (site / "_paths.pth").write_text(f"{PREFIX.parent}\n")

    def run(code, cwd=tmp_path, **environment):
        environment.setdefault("PATH", "/usr/bin:/bin")
        hook = f"import site; site.addsitedir({str(site)!r})\n"
        return subprocess.run(
            [sys.executable, "-c", hook + code],
            env={name: value for name, value in environment.items() if value is not None},
            cwd=cwd,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )

    return run


def test_packages_are_found_without_sourcing_anything(python):
    done = python(
        "from ament_index_python import get_package_share_directory as share, get_packages_with_prefixes\n"
        "print(share('ros_gz_bridge')); print(share('sensor_msgs')); print(*sorted(get_packages_with_prefixes()))"
    )
    assert done.stderr == ""
    bridge, sensors, names = done.stdout.splitlines()
    assert Path(bridge) == PREFIX / "share/ros_gz_bridge"
    assert Path(sensors) == Path(sys.prefix) / "share/sensor_msgs"
    assert {"ros_gz_bridge", "ros_gz_sim", "geometry_msgs"} <= set(names.split())


def test_a_workspace_of_the_user_comes_first(python, tmp_path):
    own = tmp_path / "workspace"
    (own / "share/ament_index/resource_index/packages").mkdir(parents=True)
    (own / "share/ament_index/resource_index/packages/ros_gz_bridge").touch()
    done = python(
        "from ament_index_python import get_package_prefix as prefix\n"
        "print(prefix('ros_gz_bridge')); print(prefix('ros_gz_sim'))",
        AMENT_PREFIX_PATH=str(own),
    )
    assert done.stdout.splitlines() == [str(own), str(PREFIX)]


def test_a_module_of_the_user_is_not_shadowed(python, tmp_path):
    (tmp_path / "prefix.py").write_text("who = 'mine'\n")
    (tmp_path / "local_setup.py").write_text("who = 'mine too'\n")
    done = python("import prefix, local_setup; print(prefix.who, local_setup.who)")
    assert done.stdout == "mine mine too\n"


def test_the_commands_come_last_on_the_path(python):
    done = python("import os; print(os.environ['PATH'])", PATH="/mine:/usr/bin:")
    assert done.stdout.strip() == f"/mine:/usr/bin::{Path(sys.executable).parent}"


def test_without_a_path_the_default_one_stays(python):
    done = python("import os; print(os.environ['PATH'])", PATH=None)
    assert done.stdout.strip() == f"{os.defpath}:{Path(sys.executable).parent}"


def test_doing_it_twice_changes_nothing():
    environment = {"AMENT_PREFIX_PATH": "", "PATH": "/bin"}
    local_setup.source(environment)
    once = dict(environment)
    local_setup.source(environment)
    assert environment == once
    assert environment["AMENT_PREFIX_PATH"] == os.pathsep.join([str(PREFIX), sys.prefix, local_setup.BUILT_IN])
    assert environment["COURSE_PYTHON"] == sys.executable


@pytest.mark.parametrize(
    ("libraries", "kept"),
    [(None, False), ("/elsewhere/lib", False), (f"/x:{sys.prefix}/lib", True)],
)
def test_the_wheels_guard_stays_only_with_their_libraries(libraries, kept):
    environment = dict(zip(WHEELS, ("1", libraries), strict=True))
    environment = {name: value for name, value in environment.items() if value is not None}
    local_setup.drop_stale_guard(environment)
    assert (WHEELS[0] in environment) is kept
    assert environment.get(WHEELS[1]) == libraries


@pytest.mark.parametrize("package", PACKAGES)
def test_every_package_has_a_manifest_of_its_name(package):
    root = ElementTree.parse(PREFIX / "share" / package / "package.xml").getroot()
    assert root.attrib == {"format": "3"}
    assert root.findtext("name") == package
    assert all(root.findtext(tag) for tag in ("version", "description", "maintainer", "license"))
    assert "@" in root.find("maintainer").attrib["email"]


@pytest.mark.parametrize("shell", ["sh", "bash", "zsh"])
def test_a_colcon_workspace_can_source_the_prefix(shell):
    path = PREFIX / f"local_setup.{shell}"
    assert path.is_file()
    if not shutil.which(shell):
        pytest.skip(f"there is no {shell} here")
    done = subprocess.run([shell, "-euc", f'. "{path}"'], capture_output=True, text=True, timeout=600, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


EXECUTABLES = sorted(path for path in (PREFIX / "lib").glob("*/*"))


@pytest.mark.parametrize("path", EXECUTABLES, ids=lambda path: path.name)
def test_an_executable_starts_with_the_course_python_whatever_the_path(path, tmp_path):
    assert path.parent.name in PACKAGES
    # Files that would be imported from the current folder by mistake.
    (tmp_path / "rclpy.py").write_text("raise SystemExit('wrong rclpy')")
    (tmp_path / "python3").write_text("#!/bin/sh\necho wrong python\n")
    (tmp_path / "python3").chmod(0o755)
    done = subprocess.run(
        [path, "--help"],
        env={"PATH": f"{tmp_path}:/usr/bin:/bin", "COURSE_PYTHON": sys.executable},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    name = "parameter_bridge" if path.name == "bridge_node" else path.name  # the same program
    assert done.stdout.lower().startswith(f"usage: {name}")


@pytest.mark.parametrize("path", EXECUTABLES, ids=lambda path: path.name)
def test_an_executable_without_the_course_python_says_what_to_do(path):
    done = subprocess.run(
        [path], env={"PATH": "/usr/bin:/bin"}, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode != 0
    assert f"COURSE_PYTHON: is not set; start me with `ros2 run {path.parent.name} {path.name}`" in done.stderr


def test_nothing_in_the_prefix_knows_where_it_lies():
    folders = {str(PREFIX), str(PREFIX.parents[2]), sys.prefix}
    for path in PREFIX.rglob("*"):
        if path.is_file() and "__pycache__" not in path.parts:
            assert not any(folder in path.read_text() for folder in folders), path
