"""Compiles a ROS package that is not installed, with ROS's own generators and the C compiler."""

import contextlib
import io
import json
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy

PREFIX = Path(sys.prefix)
DDS = ("rosidl_typesupport_fastrtps_c", "rosidl_typesupport_introspection_c")
PARTS = ("rosidl_generator_c", "rosidl_typesupport_c", *DDS, "rosidl_generator_py")
NEEDED = ("builtin_interfaces", "service_msgs", "std_msgs", "geometry_msgs")
LIBRARIES = [
    *("rosidl_runtime_c", "rosidl_typesupport_c", "rosidl_typesupport_fastrtps_c", "rosidl_typesupport_fastrtps_cpp"),
    *("rosidl_typesupport_introspection_c", "fastcdr", "rmw", "rcutils"),
    *(f"{package}__{part}" for package in NEEDED for part in PARTS),
]


def build(folder: Path, package: str, texts: dict[str, str]) -> Path:
    """Generate, compile and link a package; return the folder for `sys.path`.

    `texts` maps names such as `msg/Num` to definitions. Raises RuntimeError with the output of the compiler.
    """
    with contextlib.redirect_stdout(io.StringIO()):
        _generate_python(folder, package, texts)
    sources = _sources(folder, package, [f"{folder / 'idl' / package}:{name}.idl" for name in texts])
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
    return folder / "python"


def _generate_python(folder, package, texts):
    from rosidl_adapter.msg import convert_msg_to_idl
    from rosidl_adapter.srv import convert_srv_to_idl
    from rosidl_generator_py.generate_py_impl import generate_py

    source, made, out = folder / "source" / package, folder / "idl" / package, folder / "python" / package
    for name, text in texts.items():
        kind = name.split("/")[0]
        for place in (source / kind, made / kind, out / kind):
            place.mkdir(parents=True, exist_ok=True)
        lines = [_qualified(line.strip(), package, texts) for line in text.splitlines()]
        (source / f"{name}.{kind}").write_text("\n".join(lines) + "\n")
        convert = convert_msg_to_idl if kind == "msg" else convert_srv_to_idl
        convert(source, package, Path(f"{name}.{kind}"), made / kind)
    (out / "__init__.py").write_text("")
    arguments = folder / f"{package}.json"
    arguments.write_text(
        json.dumps(
            {
                "package_name": package,
                "idl_tuples": [f"{made}:{name}.idl" for name in texts],
                "output_dir": str(out),
                "template_dir": str(Path(sys.prefix) / "share" / "rosidl_generator_py" / "resource"),
                "target_dependencies": [],
            }
        )
    )
    generate_py(str(arguments), [])


def _qualified(line, package, interfaces):
    """Return a line in which the type of a field of the same package has the package name, as service files require."""
    kind = line.split(" ")[0].partition("[")[0]
    return f"{package}/{line}" if f"msg/{kind}" in interfaces else line


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
