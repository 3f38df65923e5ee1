"""Finds the Python class and the definition file of an interface (message, service, action) by its name.

`sensor_msgs/msg/LaserScan` (or `sensor_msgs/LaserScan`) is the class LaserScan of sensor_msgs.msg and the file
msg/LaserScan.msg in the share folder of the package. The ament index lists the interfaces. Errors name the nearest
installed interface.
"""

from __future__ import annotations

import argparse
import importlib
from pathlib import Path
from typing import Any

from ament_index_python import get_resource, get_resources

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.ros.ros2.errors import CommandError
from gz_course.sim.ros.ros2.packages import package_share

KINDS = {"msg": "Messages", "srv": "Services", "action": "Actions"}
"""The heading of each kind of interface; the key is its folder and file suffix."""

_INDEX = "rosidl_interfaces"


def add_kind_options(parser: argparse.ArgumentParser) -> None:
    """Add the options that select kinds; `kinds` is the list of them, empty for all."""
    for letter, word, kind in (("m", "msgs", "msg"), ("s", "srvs", "srv"), ("a", "actions", "action")):
        parser.add_argument(
            f"-{letter}",
            f"--only-{word}",
            action="append_const",
            dest="kinds",
            const=kind,
            default=[],
            help=f"Print out only the {KINDS[kind].lower()}",
        )


def chosen_kinds(arguments: argparse.Namespace) -> list[str]:
    """Return the kinds selected by the options of `add_kind_options`."""
    return [kind for kind in KINDS if kind in arguments.kinds or not arguments.kinds]


def add_interface_type(parser: argparse.ArgumentParser, more: str = "") -> None:
    """Add the argument `type`; `more` is appended to its help."""
    text = f"Show an interface definition (e.g. 'std_msgs/msg/String'){more}"
    parser.add_argument("type", metavar="interface_type", help=text)


def message_class(type_name: str) -> Any:
    """Return the class of a message type. Raises CommandError if there is none of that name."""
    return _class(type_name, "msg", "message")


def service_class(type_name: str) -> Any:
    """Return the class of a service type. Raises CommandError if there is none of that name."""
    return _class(type_name, "srv", "service")


def action_class(type_name: str) -> Any:
    """Return the class of an action type. Raises CommandError if there is none of that name."""
    return _class(type_name, "action", "action")


def message_type_name(message: Any) -> str:
    """Return `package/msg/Name` of a message class."""
    return f"{message.__module__.partition('.')[0]}/msg/{message.__name__}"


def service_type_name(service: Any) -> str:
    """Return `package/srv/Name` of a service class."""
    return f"{service.__module__.partition('.')[0]}/srv/{service.__name__}"


def action_type_name(action: Any) -> str:
    """Return `package/action/Name` of an action class."""
    return f"{action.__module__.partition('.')[0]}/action/{action.__name__}"


def _class(type_name: str, kind: str, noun: str) -> Any:
    package, *middle, name = type_name.split("/") if "/" in type_name else ("", "", type_name)
    if package and name and middle in ([], [kind]):
        try:
            return getattr(importlib.import_module(f"{package}.{kind}"), name)
        except (ImportError, AttributeError, ValueError):
            pass
    hint = did_you_mean(type_name, interface_names(kind))
    raise CommandError(f"The {noun} type '{type_name}' is invalid" + hint)


def interface_packages() -> list[str]:
    """Return the packages that define interfaces, sorted."""
    return sorted(get_resources(_INDEX))


def package_interfaces(package: str, kind: str) -> list[str]:
    """Return `package/kind/Name` of a package's interfaces, sorted. Raises CommandError for an unknown package."""
    if package not in get_resources(_INDEX):
        raise CommandError(f"Unknown package '{package}'" + did_you_mean(package, interface_packages()))
    files, _ = get_resource(_INDEX, package)
    end = f".{kind}"
    found = {line.removesuffix(end) for line in files.split() if line.startswith(f"{kind}/") and line.endswith(end)}
    return [f"{package}/{name}" for name in sorted(found)]


def interface_names(*kinds: str) -> list[str]:
    """Return `package/kind/Name` of every installed interface of these kinds (default: all), sorted."""
    return sorted(
        name
        for package in interface_packages()
        for kind in kinds or KINDS
        for name in package_interfaces(package, kind)
    )


def interface_parts(name: str) -> tuple[str, str, str]:
    """Return package, kind and name of a full interface name. Raises CommandError for another form."""
    parts = name.split("/")
    if len(parts) != 3 or not all(parts):
        hint = did_you_mean(name, interface_names())
        raise CommandError(f"Invalid name '{name}'. Expected three parts separated by '/'{hint}")
    if parts[1] not in KINDS:
        raise CommandError(f"Invalid name '{name}'. The second part must be one of {', '.join(KINDS)}")
    return parts[0], parts[1], parts[2]


def interface_file(name: str) -> Path:
    """Return the .msg, .srv or .action file of an interface. Raises CommandError if there is no such interface."""
    package, kind, interface = interface_parts(name)
    known = package_interfaces(package, kind)
    path = package_share(package) / kind / f"{interface}.{kind}"
    if name not in known or not path.is_file():
        hint = did_you_mean(name, known)
        raise CommandError(f"Could not find the interface '{path.with_suffix('.idl')}'{hint}")
    return path


def prototype(name: str) -> Any:
    """Return a default message, the request of a service or the goal of an action."""
    interface_file(name)
    package, kind, interface = interface_parts(name)
    found = getattr(importlib.import_module(f"{package}.{kind}"), interface)
    return {"msg": lambda: found(), "srv": lambda: found.Request(), "action": lambda: found.Goal()}[kind]()
