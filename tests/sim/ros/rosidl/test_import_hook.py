"""Packages without a compiled part are imported by their names, unless a compiled one is installed."""

import importlib
import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest
from ament_index_python import get_package_share_directory

from gz_course.sim.ros.rosidl import packages as found
from gz_course.sim.ros.rosidl.package_index import index_files
from gz_course.sim.ros.rosidl.type_support import _described

ROOT = Path(__file__).parents[4]


def test_a_built_in_package_is_imported_in_any_python_of_the_environment(tmp_path):
    (tmp_path / "tf2_msgs" / "msg").mkdir(parents=True)  # a workspace's folder of this name is no package
    code = """
from tf2_msgs.msg import TFMessage
from tf2_msgs.srv import FrameGraph
from tf2_msgs.action import LookupTransform
import tf2_msgs.msg
import sys
assert "numpy" not in sys.modules and "rclpy" not in sys.modules
print(TFMessage(), FrameGraph.Request(), LookupTransform.Impl.SendGoalService.__name__)
print(dir(tf2_msgs.msg)[:2], type(TFMessage).__name__)
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stderr == ""
    assert done.stdout.splitlines() == [
        "tf2_msgs.msg.TFMessage(transforms=[]) tf2_msgs.srv.FrameGraph_Request() LookupTransform_SendGoal",
        "['TF2Error', 'TFMessage'] Metaclass_TFMessage",
    ]


def test_the_hashes_are_those_of_jazzy():
    from tf2_msgs.msg import TFMessage

    assert _described(TFMessage).hash == "RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"


def test_a_compiled_package_is_taken_first(packages):
    packages.write({"msg/String.msg": "int8 not_the_real_one"}, package="std_msgs")
    spec = importlib.util.find_spec("std_msgs.msg._string")
    assert spec.origin.endswith("std_msgs/msg/_string.py")
    assert importlib.import_module("std_msgs.msg").String.get_fields_and_field_types() == {"data": "string"}


def test_a_package_of_nodes_may_have_interfaces(packages, tmp_path, monkeypatch):
    package = packages.write({"msg/Level.msg": "float32 level"})
    (tmp_path / "path" / package).mkdir(parents=True)
    (tmp_path / "path" / package / "__init__.py").write_text("OWN = 1\n")
    monkeypatch.syspath_prepend(tmp_path / "path")
    assert importlib.import_module(package).OWN == 1
    assert importlib.import_module(f"{package}.msg").Level(level=2.0).level == 2.0


def test_what_does_not_exist_is_not_found(packages):
    package = packages.write({"msg/Level.msg": "float32 level"})
    module = importlib.import_module(f"{package}.msg")
    with pytest.raises(ImportError, match="cannot import name 'Levels'"):
        exec(f"from {package}.msg import Levels")
    with pytest.raises(AttributeError, match=r"has no attribute 'Levle'; did you mean 'Level'\?"):
        module.Levle  # noqa: B018
    for name in (f"{package}.srv", f"{package}.msg._levels", f"{package}.other", "tf2_msgs.srv._nothing"):
        with pytest.raises(ModuleNotFoundError):
            importlib.import_module(name)
    assert module.__all__ == ["Level"]


def test_a_package_comes_with_a_sourced_workspace(packages, tmp_path, monkeypatch):
    package = packages.write({"msg/Level.msg": "float32 level"})
    monkeypatch.setenv("AMENT_PREFIX_PATH", "/nowhere")
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module(package)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(packages.prefix))
    assert importlib.import_module(f"{package}.msg").Level
    assert get_package_share_directory(package) == str(packages.prefix / "share" / package)


def test_the_index_of_the_built_in_packages_is_up_to_date():
    prefix = Path(found.BUILT_IN)
    there = {path: path.read_text() for path in (prefix / "share" / "ament_index").rglob("*") if path.is_file()}
    assert there == index_files(prefix), "run `python -m gz_course.sim.ros.rosidl.package_index sim/ros/interfaces`"


def test_every_built_in_interface_can_be_made():
    for package in found.packages(found.MARKS):
        for kind in ("msg", "srv", "action"):
            folder = Path(found.BUILT_IN, "share", package, kind)
            for path in folder.glob(f"*.{kind}"):
                made = getattr(importlib.import_module(f"{package}.{kind}"), path.stem)
                type(made).__import_type_support__()
                assert type(made)._TYPE_SUPPORT is not None
