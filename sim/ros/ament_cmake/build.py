"""Builds one package: reads it, checks it, and puts its files into the install prefix.

A build that fails changes nothing. What an earlier build has installed and this one does not is deleted, so that an
interface which is gone cannot be imported any more.

Source: REP-122, https://www.ros.org/reps/rep-0122.html
Source: https://github.com/ament/ament_cmake/blob/jazzy/ament_cmake_core/doc/resource_index.md
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.machinery import PathFinder
from pathlib import Path, PurePosixPath

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ament_cmake import interfaces
from gz_course.sim.ros.ament_cmake.cmake_commands import CMakeLists
from gz_course.sim.ros.ament_cmake.cmake_lists import read_cmake_lists, text_of
from gz_course.sim.ros.ament_cmake.errors import PackageError, at
from gz_course.sim.ros.ament_cmake.package_manifest import PackageManifest, read_manifest
from gz_course.sim.ros.rosidl.packages import ALL, INDEX, MARKS

_FINDS_AMENT = re.compile(r"^\s*find_package\s*\(\s*ament_cmake", re.MULTILINE | re.IGNORECASE)
_INSTALLED = "install_manifest.txt"  # CMake calls it so, too
_REMARKED = "remarks.txt"


@dataclass(frozen=True)
class Package:
    """Where a package lies, and where it is built and installed."""

    folder: Path
    build_base: Path
    install_base: Path
    symlink: bool = False


@dataclass(frozen=True)
class Built:
    """What a build has to tell: sentences, and the hooks of the package as paths in the prefix.

    A build reports a remark only if the build before did not find it.
    """

    remarks: list[str]
    faults: list[str]
    hooks: list[str]


@dataclass(frozen=True)
class _File:
    """A file to install: a copy of a source, or a text."""

    source: Path | None = None
    text: str = ""
    executable: bool = False


def build(package: Package, prefixes: Sequence[Path]) -> Built:
    """Build a package; `prefixes` are those in which other packages are found. It fails if there are faults."""
    remarks: list[str] = []
    try:
        manifest = read_manifest(package.folder / "package.xml")
        _check_type(manifest, package.folder / "CMakeLists.txt")
        lists = read_cmake_lists(package.folder / "CMakeLists.txt")
        remarks = lists.remarks
        _check_frame(lists, manifest)
        faults = []
        paths = interfaces.interface_paths(lists)
        if paths:
            faults = interfaces.check(lists, manifest, paths, prefixes)
            _remark_on_hidden(lists, manifest)
        _remark_on_absent(lists, prefixes)
        if faults:
            return Built(remarks, faults, [])
        files = _files(package, manifest, lists, paths)
        _install(package, files)
    except PackageError as error:
        return Built(remarks, [str(error)], [])
    except OSError as error:
        return Built(remarks, [f"{error.filename or package.install_base}: {error.strerror or error}"], [])
    hooks = [name for name in files if name.startswith(f"share/{manifest.name}/environment/")]
    return Built(_news(package, remarks), [], hooks)


def _news(package: Package, remarks: list[str]) -> list[str]:
    """Return the remarks that the last build of the package did not find, and record all."""
    record = package.build_base / _REMARKED
    told = record.read_text(encoding="utf-8").splitlines() if record.is_file() else []
    package.build_base.mkdir(parents=True, exist_ok=True)
    record.write_text("".join(f"{each}\n" for each in remarks), encoding="utf-8")
    return [each for each in remarks if each not in told]


def _check_type(manifest: PackageManifest, lists: Path) -> None:
    """Fail for a package that CMake would have to build; colcon takes one without a <build_type> for what it finds."""
    if manifest.build_type == "catkin" and not (lists.is_file() and _FINDS_AMENT.search(text_of(lists))):
        raise PackageError(
            "this package is for ROS 1: it has no <export><build_type>, so catkin would build it; for ROS 2 write "
            "<build_type>ament_cmake</build_type> or ament_python",
            manifest.path,
        )
    if manifest.build_type == "cmake":
        raise PackageError(
            "only CMake can build this package, and it is not installed; install CMake and a compiler, or make it a "
            "package of build type ament_python (`ros2 pkg create --build-type ament_python`)",
            manifest.path,
        )


def _check_frame(lists: CMakeLists, manifest: PackageManifest) -> None:
    """Fail if project() or ament_package() are not as they must be, or two things have one name."""
    if lists.project != manifest.name:
        seen = f"project({lists.project})" if lists.project else "no project()"
        raise PackageError(f"expected project({manifest.name}), the name in package.xml; found {seen}", lists.path)
    if not lists.package_line:
        raise PackageError("ament_package() is missing; it must be the last command", lists.path)
    if lists.interfaces and manifest.name in lists.python_packages:
        raise PackageError(
            f"the Python package '{manifest.name}' has the name of the interfaces, so one of them could not be "
            "imported; give it another name, or put the interfaces into a package of their own",
            lists.path,
            lists.python_packages[manifest.name],
        )


def _remark_on_hidden(lists: CMakeLists, manifest: PackageManifest) -> None:
    """Remark on a Python package of the same name, such as that of a compiled package, which is imported instead."""
    found = PathFinder.find_spec(manifest.name)
    if found is not None and found.loader is not None:
        sentence = (
            f"Python imports '{manifest.name}' from {found.origin}, not from these interfaces; give the package "
            "another name"
        )
        lists.remarks.append(at(lists.path, next(iter(lists.interfaces.values())), sentence))


def _remark_on_absent(lists: CMakeLists, prefixes: Sequence[Path]) -> None:
    """Remark on packages in find_package() that are not installed and no tools of the build, misspelt ones first."""
    absent: dict[str, int] = {}
    for name, line in lists.found.items():
        tool = name.startswith(("ament_", "rosidl_", "python_cmake_module", "Python")) or name in lists.dependencies
        if not tool and not any((prefix / "share" / name).is_dir() for prefix in prefixes):
            known = {path.name for prefix in prefixes for path in prefix.glob(f"{INDEX}/packages/*")}
            hint = did_you_mean(name, known, cutoff=0.85)
            if hint:
                lists.remarks.append(at(lists.path, line, f"find_package({name}): there is no such package here{hint}"))
            else:
                absent[name] = line
    if absent:
        names = ", ".join(absent)
        sentence = f"these packages are not installed: {names}; a program that uses them fails at run time"
        lists.remarks.append(at(lists.path, next(iter(absent.values())), sentence))


def _files(
    package: Package, manifest: PackageManifest, lists: CMakeLists, interface_paths: dict[str, Path]
) -> dict[str, _File]:
    """Return all files of the package by their path in the prefix."""
    share = f"share/{manifest.name}"
    index = INDEX.replace(os.sep, "/")
    files = {f"{share}/package.xml": _File(manifest.path), f"{index}/packages/{manifest.name}": _File()}
    for name, path in interface_paths.items():
        files[f"{share}/{name}"] = _File(path)
    if interface_paths:
        files[f"{index}/{MARKS}/{manifest.name}"] = _File()
        files[f"{index}/{ALL}/{manifest.name}"] = _File(text="".join(f"{each}\n" for each in sorted(interface_paths)))
    for entry in lists.files:
        try:
            for path, name in entry.files(package.folder):
                executable = entry.executable or os.access(path, os.X_OK)
                if entry.executable and package.symlink and not os.access(path, os.X_OK):
                    sentence = (
                        f"'{entry.source}' is linked but not executable, so `ros2 run` cannot find it; chmod +x it"
                    )
                    lists.remarks.append(at(lists.path, entry.line, sentence))
                files[_inside(name, lists, entry.line)] = _File(path, executable=executable)
        except FileNotFoundError:
            near = did_you_mean(entry.source.strip("/"), [each.name for each in package.folder.iterdir()])
            raise PackageError(
                f"install() cannot find '{entry.source}' in {package.folder}{near}", lists.path, entry.line
            ) from None
    for hook in lists.hooks:
        try:
            files[f"{share}/environment/{hook.name}"] = _File(text=hook.text(package.folder, package.install_base))
        except (OSError, UnicodeDecodeError):
            raise PackageError(
                f"ament_environment_hooks() cannot read '{hook.source}'", lists.path, hook.line
            ) from None
    return files


def _inside(name: str, lists: CMakeLists, line: int) -> str:
    """Return a path in the prefix in its plain form. Raises PackageError if it leads out of the prefix."""
    plain = PurePosixPath(name)
    if ".." in plain.parts or plain.is_absolute():
        raise PackageError(f"'{name}' leads out of the install prefix", lists.path, line)
    return plain.as_posix()


def _install(package: Package, files: dict[str, _File]) -> None:
    for name, file in files.items():
        _put(package.install_base / name, file, package.symlink)
    record = package.build_base / _INSTALLED
    now = {str(package.install_base / name) for name in files}
    before = set(record.read_text(encoding="utf-8").splitlines()) if record.is_file() else set()
    for path in sorted(before - now):
        _delete(Path(path), package.install_base)
    package.build_base.mkdir(parents=True, exist_ok=True)
    record.write_text("".join(f"{path}\n" for path in sorted(now)), encoding="utf-8")


def _put(target: Path, file: _File, symlink: bool) -> None:
    """Install one file. A file that is already as it shall be is not touched; another one is replaced at once."""
    target.parent.mkdir(parents=True, exist_ok=True)
    fresh = target.with_name(f".{target.name}.new")
    fresh.unlink(missing_ok=True)
    if symlink and file.source is not None:
        source = file.source.resolve()
        if target.is_symlink() and target.readlink() == source:
            return
        fresh.symlink_to(source)
    else:
        content = file.source.read_bytes() if file.source is not None else file.text.encode()
        mode = 0o755 if file.executable else 0o644
        if not target.is_symlink() and target.is_file() and target.read_bytes() == content:
            target.chmod(mode)
            return
        fresh.write_bytes(content)
        fresh.chmod(mode)
    fresh.replace(target)


def _delete(path: Path, install_base: Path) -> None:
    """Delete a file of the prefix, and the folders that are empty then."""
    if install_base not in path.parents:
        return
    path.unlink(missing_ok=True)
    for folder in path.parents:
        if folder == install_base or not folder.is_dir() or any(folder.iterdir()):
            return
        folder.rmdir()
