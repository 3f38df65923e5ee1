"""`ros2 pkg`: the installed packages and their folders."""

import sys
from pathlib import Path

import pytest

from gz_course.sim.ros.prefix.local_setup import PREFIX


def test_list_names_the_packages_of_all_prefixes(ros2, workspace):
    code, text, _ = ros2("pkg", "list", environment=workspace("driver", "#!/bin/sh\n"))
    names = text.split()
    assert code == 0
    assert names == sorted(names)
    assert {"my_robot", "ros_gz_bridge", "ros_gz_sim", "sensor_msgs"} <= set(names)


@pytest.mark.parametrize(
    ("arguments", "folder"),
    [
        (["ros_gz_bridge"], PREFIX),
        (["ros_gz_bridge", "--share"], f"{PREFIX}/share/ros_gz_bridge"),
        (["sensor_msgs"], sys.prefix),
    ],
)
def test_prefix(ros2, arguments, folder):
    assert ros2("pkg", "prefix", *arguments) == (0, f"{folder}\n", "")


@pytest.mark.parametrize("verb", ["prefix", "executables", "xml"])
def test_an_unknown_package_is_an_error_that_names_the_nearest(ros2, verb):
    whole = "Package 'ros_gz_brige' not found" if verb == "executables" else "Package not found"
    sentence = f"{whole}; did you mean 'ros_gz_bridge'?\n"
    assert ros2("pkg", verb, "ros_gz_brige") == (1, "", sentence)


def test_executables(ros2, workspace):
    workspace("nested/deep", "#!/bin/sh\n")
    environment = workspace("driver", "#!/bin/sh\n")
    install = Path(environment["AMENT_PREFIX_PATH"])
    (install / "lib/my_robot/notes.txt").write_text("not executable")
    code, text, _ = ros2("pkg", "executables", "my_robot", environment=environment)
    assert (code, text) == (0, "my_robot driver\nmy_robot deep\n")
    code, text, _ = ros2("pkg", "executables", "--full-path", environment=environment)
    assert {f"{install}/lib/my_robot/driver", f"{PREFIX}/lib/ros_gz_bridge/parameter_bridge"} <= set(text.splitlines())


def test_xml(ros2):
    manifest = (Path(PREFIX) / "share/ros_gz_sim/package.xml").read_text()
    assert ros2("pkg", "xml", "ros_gz_sim") == (0, manifest, "")
    assert ros2("pkg", "xml", "ros_gz_sim", "-t", "name") == (0, "ros_gz_sim\n", "")
    code, text, errors = ros2("pkg", "xml", "ros_gz_sim", "-t", "licence")
    assert (code, text) == (1, "")
    assert "No element <licence>" in errors
    assert "did you mean 'license'?" in errors
