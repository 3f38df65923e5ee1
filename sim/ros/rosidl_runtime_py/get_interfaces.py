"""The installed interfaces, of all packages or of some, and their files.

Source: ros2/rosidl_runtime_py, rosidl_runtime_py/get_interfaces.py
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ament_index_python import get_resource, get_resources, has_resource

from gz_course.sim.did_you_mean import did_you_mean

_INDEX = "rosidl_interfaces"
_SUFFIXES = {"msg": ("msg", "idl"), "srv": ("srv", "idl"), "action": ("action", "idl")}


def get_interface_packages() -> dict[str, str]:
    """Return the packages with interfaces: name -> prefix."""
    return dict(get_resources(_INDEX))


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return `msg/Name`, `srv/Name` and `action/Name` of each package. Raises LookupError for an unknown package."""
    return _found(package_names, *_SUFFIXES)


def get_message_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return `msg/Name` of each package with messages. Raises LookupError for an unknown package."""
    return _found(package_names, "msg")


def get_service_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return `srv/Name` of each package with services. Raises LookupError for an unknown package."""
    return _found(package_names, "srv")


def get_action_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return `action/Name` of each package with actions. Raises LookupError for an unknown package."""
    return _found(package_names, "action")


def get_interface_path(interface_name: str) -> str:
    """Return the file of `std_msgs/msg/String`. Raises ValueError for what is no name, LookupError if there is none."""
    parts = interface_name.split("/")
    if len(parts) < 3 or not all(parts) or ".." in parts:
        raise ValueError(f"Invalid name '{interface_name}'. Expected parts separated by '/', as in std_msgs/msg/String")
    package, *middle, name = parts
    share = Path(_prefix(package)) / "share" / package
    path = share.joinpath(*middle, name)
    found = [path] if path.suffix else [path.with_name(f"{name}.{end}") for end in (middle[-1], "idl")]
    for each in found:
        if each.exists():
            return str(each)
    raise LookupError(f"Could not find the interface '{found[-1]}'{did_you_mean(name, _names(share / middle[-1]))}")


def _names(folder: Path) -> list[str]:
    return [path.stem for path in folder.glob("*")]


def _prefix(package: str) -> str:
    prefix = has_resource("packages", package)
    if not prefix:
        raise LookupError(f"Unknown package '{package}'{did_you_mean(package, get_resources(_INDEX))}")
    return str(prefix)


def _found(packages: Iterable[str], *kinds: str) -> dict[str, list[str]]:
    found = {}
    for package in list(packages) or get_resources(_INDEX):
        _prefix(package)
        if not has_resource(_INDEX, package):
            continue
        lines = get_resource(_INDEX, package)[0].split()
        names = {
            line.rpartition(".")[0]
            for line in lines
            for kind in kinds
            if line.startswith(f"{kind}/") and line.endswith(_SUFFIXES[kind]) and "_" not in line
        }
        if names:
            found[package] = sorted(names)
    return found
