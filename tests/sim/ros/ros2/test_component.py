"""Commands that need more than there is here say so: components, security."""

import argparse

import pytest

from gz_course.sim.ros.ros2.command import security, wtf
from gz_course.sim.ros.ros2.command.component import load, standalone, types, unload
from gz_course.sim.ros.ros2.errors import CommandError


def test_registered_types_are_listed_by_package(tmp_path, monkeypatch, capsys):
    index = tmp_path / "share/ament_index/resource_index"
    for kind, text in (("packages", ""), ("rclcpp_components", "demo::Talker;lib/libtalker.so\n")):
        (index / kind).mkdir(parents=True)
        (index / kind / "demo").write_text(text)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    types.main(argparse.Namespace(package_name=None))
    types.main(argparse.Namespace(package_name="demo"))
    assert capsys.readouterr().out == "demo\n  demo::Talker\ndemo::Talker\n"
    with pytest.raises(CommandError, match=r"Unable to find package 'dmo'; did you mean 'demo'\?"):
        types.main(argparse.Namespace(package_name="dmo"))


@pytest.mark.parametrize(("verb", "instead"), [(load, "ros2 run"), (unload, "ros2 run"), (standalone, "ros2 run")])
def test_what_needs_a_container_names_what_to_do_instead(verb, instead):
    with pytest.raises(CommandError, match=instead):
        verb.main(argparse.Namespace(argv=[]))


def test_security_names_what_to_do_instead():
    with pytest.raises(CommandError, match=r"sros2 on a full installation.* ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"):
        security.main(argparse.Namespace(argv=[]))


def test_wtf_is_doctor():
    parser = argparse.ArgumentParser()
    wtf.add_arguments(parser)
    assert parser.parse_args(["hello", "--once"]).once
