"""A package is built without CMake: what is installed, what is refused, what a second build changes."""

import importlib
import os
import sys
from pathlib import Path

import pytest

from gz_course.sim.ros.ament_cmake.build import Package, build
from gz_course.sim.ros.prefix import local_setup

PREFIXES = [Path(sys.prefix), Path(local_setup.PREFIX), Path(local_setup.BUILT_IN)]
MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>0.1.0</version><description>Interfaces</description>
  <maintainer email="me@example.com">Me</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>geometry_msgs</depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
LISTS = """\
project({name})
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
find_package(geometry_msgs REQUIRED)
{more}
rosidl_generate_interfaces(${{PROJECT_NAME}} {files} DEPENDENCIES geometry_msgs)
ament_package()
"""
TEXTS = {
    "msg/Num.msg": "int64 num\n",
    "msg/Sphere.msg": "geometry_msgs/Point center\nfloat64 radius\nNum[] numbers\n",
    "srv/AddThreeInts.srv": "int64 a\nint64 b\nint64 c\n---\nint64 sum\n",
    "action/Fibonacci.action": "int32 order\n---\nint32[] sequence\n---\nint32[] partial_sequence\n",
}


class Workspace:
    """A package `NAME` in src, and where it is built."""

    def __init__(self, folder, name="tutorial_interfaces"):
        self.name, self.folder = name, folder
        self.source, self.prefix = folder / "src" / "a_folder_of_another_name", folder / "install"
        self.texts = dict(TEXTS)
        self.more = ""
        self.manifest = MANIFEST

    def write(self):
        for file, text in self.texts.items():
            path = self.source / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        (self.source / "package.xml").write_text(self.manifest.format(name=self.name))
        files = " ".join(f'"{file}"' for file in self.texts if file.split("/")[0] in ("msg", "srv", "action"))
        (self.source / "CMakeLists.txt").write_text(LISTS.format(name=self.name, files=files, more=self.more))

    def build(self, symlink=False):
        self.write()
        return build(Package(self.source, self.folder / "build", self.prefix, symlink), PREFIXES)

    def installed(self):
        return {path.relative_to(self.prefix).as_posix() for path in self.prefix.rglob("*") if not path.is_dir()}


@pytest.fixture
def workspace(tmp_path):
    return Workspace(tmp_path)


@pytest.fixture
def sourced(workspace, monkeypatch):
    """Make this Python one that has sourced the workspace; returns a function that imports a module anew."""
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(workspace.prefix), os.environ["AMENT_PREFIX_PATH"]]))

    def drop():
        for name in [name for name in sys.modules if name.partition(".")[0] == workspace.name]:
            del sys.modules[name]

    yield lambda module: importlib.import_module(module)
    drop()


@pytest.mark.parametrize("symlink", [False, True])
def test_what_is_built_is_imported(workspace, sourced, symlink):
    workspace.name = f"tutorial_interfaces_{int(symlink)}"
    built = workspace.build(symlink)
    assert (built.faults, built.remarks) == ([], [])
    share, index = f"share/{workspace.name}", "share/ament_index/resource_index"
    assert workspace.installed() == {
        f"{share}/package.xml",
        *(f"{share}/{name}" for name in TEXTS),
        *(f"{index}/{kind}/{workspace.name}" for kind in ("packages", "run_time_interfaces", "rosidl_interfaces")),
    }
    assert (workspace.prefix / share / "msg/Num.msg").is_symlink() is symlink
    sphere = sourced(f"{workspace.name}.msg").Sphere()
    sphere.numbers.append(sourced(f"{workspace.name}.msg").Num(num=3))
    assert repr(sphere).startswith(f"{workspace.name}.msg.Sphere(center=geometry_msgs.msg.Point(x=0.0")
    assert sourced(f"{workspace.name}.srv").AddThreeInts.Request(a=1).a == 1
    assert sourced(f"{workspace.name}.action").Fibonacci.Goal().order == 0


def test_a_second_build_changes_only_what_has_changed(workspace):
    workspace.build()
    before = {path: (workspace.prefix / path).stat().st_mtime_ns for path in workspace.installed()}
    num, sphere = (f"share/tutorial_interfaces/msg/{name}.msg" for name in ("Num", "Sphere"))
    del workspace.texts["srv/AddThreeInts.srv"]
    workspace.texts["msg/Num.msg"] = "int64 num\nint64 more\n"
    assert workspace.build().faults == []
    assert (workspace.prefix / num).read_text() == "int64 num\nint64 more\n"
    assert (workspace.prefix / sphere).stat().st_mtime_ns == before[sphere]
    assert set(before) - workspace.installed() == {"share/tutorial_interfaces/srv/AddThreeInts.srv"}
    assert not (workspace.prefix / "share/tutorial_interfaces/srv").exists()
    assert workspace.build(symlink=True).faults == []
    assert (workspace.prefix / num).is_symlink()
    assert workspace.build().faults == []
    assert not (workspace.prefix / num).is_symlink()


FAULTS = [
    ({"msg/Num.msg": "int64 num\nint46 x\n"}, "msg/Num.msg:2: unknown type 'int46'; did you mean 'int64'?"),
    ({"msg/Num.msg": "int64\n"}, "msg/Num.msg:1: expected a type and a name, found only 'int64'"),
    ({"msg/Num.msg": "int64 a\nint64 a\n"}, "msg/Num.msg:2: the name 'a' is already used in line 1"),
    ({"srv/Add.srv": "int64 a\n"}, "srv/Add.srv: expected request and response, separated by one line '---'"),
    ({"msg/A.msg": "bool x\nNumm n\n"}, "msg/A.msg:2: unknown type tutorial_interfaces/Numm; did you mean 'Num'?"),
    (
        {"msg/A.msg": "Vector3[] n\n"},
        "msg/A.msg:1: unknown type tutorial_interfaces/Vector3; did you mean 'geometry_msgs/Vector3'?",
    ),
    ({"msg/A.msg": "geometry_msgs/Pint p\n"}, "msg/A.msg:1: unknown type geometry_msgs/Pint; did you mean 'Point'?"),
    ({"msg/A.msg": "geometry_msg/Point p\n"}, "msg/A.msg:1: unknown package 'geometry_msg' in the type"),
    (
        {"msg/A.msg": "sensor_msgs/Range r\n"},
        "msg/A.msg:1: the package 'sensor_msgs' of sensor_msgs/Range is not a dependency; add "
        "find_package(sensor_msgs REQUIRED) and DEPENDENCIES sensor_msgs to CMakeLists.txt:6",
    ),
    ({"msg/A.msg": "B b\n", "msg/B.msg": "A[2] a\n"}, "a message cannot contain itself: "),
]


@pytest.mark.parametrize(("texts", "words"), FAULTS, ids=lambda value: value[:30] if isinstance(value, str) else "")
def test_a_fault_of_an_interface_is_one_sentence_and_keeps_what_was_built(workspace, texts, words):
    workspace.build()
    before = workspace.installed()
    workspace.texts |= texts
    (fault,) = workspace.build().faults
    assert words in fault
    assert fault.startswith(str(workspace.source))
    assert workspace.installed() == before


def test_all_faults_are_told_at_once(workspace):
    workspace.texts |= {"msg/A.msg": "Nix a\n", "msg/B.msg": "int8\n"}
    workspace.manifest = MANIFEST.replace("<member_of_group>rosidl_interface_packages</member_of_group>", "")
    words = (
        "<member_of_group>rosidl_interface_packages</member_of_group>",
        "B.msg:1: expected",
        "A.msg:1: unknown type",
    )
    faults = workspace.build().faults
    assert [word in fault for word, fault in zip(words, faults, strict=True)] == [True, True, True]


def test_a_dependency_that_is_missing_in_package_xml_is_told(workspace):
    workspace.manifest = MANIFEST.replace("<depend>geometry_msgs</depend>", "")
    built = workspace.build()
    assert built.faults == []
    assert built.remarks == [
        f"{workspace.source}/CMakeLists.txt:6: 'geometry_msgs' is not in package.xml, so the build fails where it is "
        "built later than this package; add <depend>geometry_msgs</depend>"
    ]


def test_the_name_of_a_compiled_package_is_told(workspace):
    workspace.name = "std_msgs"
    (remark,) = workspace.build().remarks
    assert "CMakeLists.txt:6: Python imports 'std_msgs' from " in remark


def test_a_file_that_is_not_there_is_named(workspace):
    workspace.write()
    (workspace.source / "msg/Num.msg").unlink()
    built = build(Package(workspace.source, workspace.folder / "build", workspace.prefix), PREFIXES)
    assert "CMakeLists.txt:6: rosidl_generate_interfaces() the passed file 'msg/Num.msg' doesn't" in built.faults[0]


INSTALLED = """\
find_package(ament_cmake_python REQUIRED)
install(DIRECTORY launch config/ DESTINATION share/${PROJECT_NAME} PATTERN "*.bak" EXCLUDE)
install(PROGRAMS scripts/talker.py DESTINATION lib/${PROJECT_NAME} RENAME talker)
install(FILES readme.txt DESTINATION share/doc)
ament_python_install_package(robot_tools)
ament_environment_hooks("env/models.dsv.in")
"""


def test_launch_files_programs_python_modules_and_hooks_are_installed(workspace):
    workspace.more = INSTALLED
    workspace.texts |= {
        "launch/a.launch.py": "",
        "launch/a.launch.py.bak": "",
        "config/deep/b.yaml": "",
        "scripts/talker.py": "#!/usr/bin/env python3\n",
        "readme.txt": "",
        "robot_tools/__init__.py": "",
        "robot_tools/arm.py": "",
        "env/models.dsv.in": "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/@PROJECT_NAME@/models\n",
    }
    built = workspace.build()
    assert (built.faults, built.remarks) == ([], [])
    share, site = "share/tutorial_interfaces", f"lib/python3.{sys.version_info.minor}/site-packages"
    assert {name for name in workspace.installed() if "resource_index" not in name and "/package.xml" not in name} == {
        *(f"{share}/{name}" for name in TEXTS),
        f"{share}/launch/a.launch.py",
        f"{share}/deep/b.yaml",
        f"{share}/environment/models.dsv",
        "lib/tutorial_interfaces/talker",
        "share/doc/readme.txt",
        f"{site}/robot_tools/__init__.py",
        f"{site}/robot_tools/arm.py",
    }
    assert os.access(workspace.prefix / "lib/tutorial_interfaces/talker", os.X_OK)
    assert built.hooks == [f"{share}/environment/models.dsv"]
    hook = (workspace.prefix / built.hooks[0]).read_text()
    assert hook == "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;share/tutorial_interfaces/models\n"


BRINGUP = """\
include(GNUInstallDirs)
set(NEEDED urdf xacro)
foreach(each IN LISTS NEEDED ITEMS no_such_package)
  find_package(${each} REQUIRED)
endforeach()
foreach(dir launch config)
  foreach(kind a)
    install(DIRECTORY ${dir}/${kind} DESTINATION ${CMAKE_INSTALL_DATADIR}/${PROJECT_NAME}/${dir})
  endforeach()
endforeach()
ament_environment_hooks(env/models.dsv.in)
"""


def test_a_bringup_package_is_built_and_its_remarks_are_reported_once(workspace):
    workspace.more = BRINGUP
    workspace.texts |= {
        "launch/a/b.launch.py": "",
        "config/a/b.yaml": "",
        "env/models.dsv.in": "set;X;@CMAKE_INSTALL_PREFIX@/share\n",
    }
    built = workspace.build()
    (remark,) = built.remarks
    assert "CMakeLists.txt:8: these packages are not installed: urdf, xacro, no_such_package; a program" in remark
    share = "share/tutorial_interfaces"
    assert {f"{share}/launch/a/b.launch.py", f"{share}/config/a/b.yaml"} <= workspace.installed()
    assert (workspace.prefix / built.hooks[0]).read_text() == f"set;X;{workspace.prefix}/share\n"
    assert workspace.build().remarks == []


@pytest.mark.parametrize(
    ("kind", "words"), [("catkin", "this package is for ROS 1"), ("cmake", "only CMake can build")]
)
def test_what_only_cmake_can_build_is_one_sentence(tmp_path, kind, words):
    export = "" if kind == "catkin" else f"<export><build_type>{kind}</build_type></export>"
    (tmp_path / "package.xml").write_text(f"<package><name>old</name>{export}</package>")
    (fault,) = build(Package(tmp_path, tmp_path / "build", tmp_path / "install"), []).faults
    assert fault.startswith(f"{tmp_path}/package.xml: {words}")


def test_a_package_without_a_build_type_is_what_it_finds(workspace):
    workspace.manifest = MANIFEST.replace("<export><build_type>ament_cmake</build_type></export>", "")
    assert workspace.build().faults == []
    assert "share/tutorial_interfaces/msg/Num.msg" in workspace.installed()


def test_a_linked_program_must_be_executable(workspace):
    workspace.more = "install(PROGRAMS run.py DESTINATION lib/${PROJECT_NAME})"
    workspace.texts["run.py"] = ""
    (remark,) = workspace.build(symlink=True).remarks
    assert remark.endswith(
        "CMakeLists.txt:5: 'run.py' is linked but not executable, so `ros2 run` cannot find it; chmod +x it"
    )


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ("install(DIRECTORY lunch DESTINATION share/x)", "CMakeLists.txt:5: install() cannot find 'lunch' in"),
        ("ament_python_install_package(${PROJECT_NAME})", "CMakeLists.txt:5: the Python package 'tutorial_interfaces'"),
        ("install(FILES package.xml DESTINATION x RENAME ../../y)", "CMakeLists.txt:5: 'x/../../y' leads out of the"),
        ("project(other)", "CMakeLists.txt: expected project(tutorial_interfaces), the name in package.xml; found"),
    ],
)
def test_other_faults_are_one_sentence(workspace, more, words):
    workspace.more = more
    (fault,) = workspace.build().faults
    assert words in fault
    assert workspace.installed() == set()
