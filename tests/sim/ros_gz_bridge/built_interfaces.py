"""Builds ROS packages that are not installed, with ROS's own generators and the C compiler, for use over DDS.

`python -m tests.sim.ros_gz_bridge.built_interfaces FOLDER` writes the folder for PYTHONPATH to FOLDER/python. The
Python half of each package is complete; the C half contains only the types in `BUILT`, because compiling is slow.
"""

import contextlib
import io
import os
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy

from gz_course.tests.sim.ros_gz_bridge.absent_interfaces import generate

BUILT = {
    "ros_gz_interfaces": [
        *("msg/WorldReset", "msg/WorldControl", "msg/Entity", "msg/EntityFactory"),
        *("srv/ControlWorld", "srv/SpawnEntity", "srv/DeleteEntity", "srv/SetEntityPose"),
    ],
    "tf2_msgs": ["msg/TFMessage"],
}
PREFIX = Path(sys.prefix)
DDS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")
PARTS = ("rosidl_generator_c", "rosidl_typesupport_c", *DDS, "rosidl_generator_py")
NEEDED = ("builtin_interfaces", "service_msgs", "std_msgs", "geometry_msgs")
LIBRARIES = [
    *("rosidl_runtime_c", "rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp"),
    *("rosidl_typesupport_introspection_c", "fastcdr", "rmw", "rcutils"),
    *(f"{package}__{part}" for package in NEEDED for part in PARTS),
]


def build(folder: Path) -> None:
    """Generate, compile and link every package of `BUILT`. Raises RuntimeError with the output of the compiler."""
    generate(folder)
    for package, interfaces in BUILT.items():
        sources = _sources(folder, package, [f"{folder / 'idl' / package}:{name}.idl" for name in interfaces])
        with ThreadPoolExecutor(2) as threads:
            objects = dict(zip(sources, threads.map(partial(_compile, folder), sources), strict=True))
        out = folder / "python" / package
        entries = {source.name: made for source, made in objects.items() if ".ep." in source.name}
        shared = [str(made) for made in objects.values() if made not in entries.values()]
        _run("g++", "-shared", "-o", f"{out}/lib{package}.so", *shared, *_linked())
        own = [f"-L{out}", "-Wl,--no-as-needed", f"-l{package}", "-Wl,-rpath,$ORIGIN"]
        for part in DDS:  # ROS loads a library of this name, which is already loaded
            name = f"lib{package}__{part}.so"
            _run("g++", "-shared", f"-Wl,-soname,{name}", "-o", f"{out}/{name}", *own)
        own += [f"-l{package}__{part}" for part in DDS]
        for part in ("rosidl_typesupport_c", DDS[0]):
            module = f"{out}/{package}_s__{part}{sysconfig.get_config_var('EXT_SUFFIX')}"
            entry = str(entries[f"_{package}_s.ep.{part}.c"])
            _run("g++", "-shared", "-o", module, entry, *own, *_linked())


def _sources(folder, package, interfaces):
    from rosidl_generator_c.cli import GenerateC
    from rosidl_generator_py.cli import GeneratePython
    from rosidl_typesupport_c.cli import GenerateCTypesupport
    from rosidl_typesupport_fastrtps_c.cli import GenerateFastRTPSCTypesupport
    from rosidl_typesupport_introspection_c.cli import GenerateIntrospectionCTypesupport

    places = [folder / "c" / package, folder / "introspection" / package]  # some files of both have the same name
    for place in places:
        place.mkdir(parents=True)
    generators = [
        (GenerateC("c"), places[0]),
        (GenerateFastRTPSCTypesupport("fastrtps_c"), places[0]),
        (GenerateIntrospectionCTypesupport("introspection_c"), places[1]),
        (GenerateCTypesupport("c", typesupport_implementations=list(DDS)), places[0]),
        (GeneratePython("py", typesupport_implementations=["rosidl_typesupport_c", DDS[0]]), places[0]),
    ]
    with contextlib.redirect_stdout(io.StringIO()):
        for generator, place in generators:
            generator.generate(package, interfaces, [str(PREFIX / "share"), str(folder / "idl")], place)
    return sorted(path for place in places for path in place.rglob("*") if path.suffix in (".c", ".cpp"))


def _compile(folder, source):
    made = source.with_suffix(f"{source.suffix}.o")
    compiler = ["g++", "-std=c++17"] if source.suffix == ".cpp" else ["gcc", "-std=gnu11"]
    folders = [PREFIX / "include", *(each for each in sorted((PREFIX / "include").iterdir()) if each.is_dir())]
    folders += [folder / "c", folder / "introspection", sysconfig.get_paths()["include"]]
    included = [f"-I{each}" for each in (*folders, numpy.get_include())]
    _run(*compiler, "-c", "-fPIC", "-O0", "-w", *included, str(source), "-o", str(made))
    return made


def _linked():
    found = [name for name in LIBRARIES if list((PREFIX / "lib").glob(f"lib{name}.so*"))]
    return [f"-L{PREFIX / 'lib'}", f"-Wl,-rpath,{PREFIX / 'lib'}", *(f"-l{name}" for name in found)]


def _run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command[:2])} ... {command[-1]}: {done.stderr[-2000:]}")


if __name__ == "__main__":
    os.environ["AMENT_PREFIX_PATH"] = str(PREFIX)
    build(Path(sys.argv[1]))
