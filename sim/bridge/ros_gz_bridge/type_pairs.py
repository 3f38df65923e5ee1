"""The tables of type pairs and of services: which ROS type is converted to which Gazebo type.

`bridge` gets the two conversion functions of an entry from here; `config` checks whether they exist. The files of
`convert/`, one for each ROS package, fill the tables (`fields.message_pair`, `add_service`); adding a file adds a
package. The pairs of a package that is not installed are omitted.
"""

from __future__ import annotations

import importlib
import importlib.util
import pkgutil
import re
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import gz_course.sim.bridge.ros_gz_bridge.convert as ros_gz_bridge_convert
from gz_course.sim.did_you_mean import nearest_name
from gz_course.sim.gz.msgs import message_class

_GZ_PREFIXES = ("ignition.msgs.", "gz_msgs.", "ign_msgs.")


class ConversionError(ValueError):
    """A message that cannot be converted, for instance because its parts contradict each other."""


class UnknownPairError(ValueError):
    """Two types without a conversion; the text names the nearest pair."""


class MissingPackageError(UnknownPairError):
    """A known pair whose ROS package is not installed."""


@dataclass(frozen=True)
class TypePair:
    """One ROS type, one Gazebo type and the functions between them.

    `to_ros` and `to_gz` raise ConversionError for a message that does not fit. `fault` returns a reason why a ROS
    message must not reach the simulator (`"linear.x is nan"`), or None.
    """

    ros_type: str
    gz_type: str
    ros_class: Any
    gz_class: Any
    to_ros: Callable[[Any], Any]
    to_gz: Callable[[Any], Any]
    fault: Callable[[Any], str | None] | None = None


@dataclass(frozen=True)
class ServiceTypes:
    """One ROS service type, the types of request and reply of the Gazebo service, and the functions between them.

    Gazebo services are offered to ROS, never the reverse. `request_to_gz` and `reply_to_ros` raise ConversionError for
    a value that does not fit. `fault` checks a ROS request as `TypePair.fault` checks a message.
    """

    ros_type: str
    gz_request_type: str
    gz_reply_type: str
    ros_class: Any
    gz_request_class: Any
    gz_reply_class: Any
    request_to_gz: Callable[[Any], Any]
    reply_to_ros: Callable[[Any], Any]
    fault: Callable[[Any], str | None] | None = None


_pairs: dict[tuple[str, str], TypePair] = {}
_services: dict[tuple[str, str, str], ServiceTypes] = {}
_loaded: set[str] = set()
_lock = threading.RLock()


def add_pair(
    ros_type: str,
    gz_type: str,
    *,
    to_ros: Callable[[Any], Any],
    to_gz: Callable[[Any], Any],
    fault: Callable[[Any], str | None] | None = None,
) -> None:
    """Add a pair to the table. Raises ValueError if the two types are already paired."""
    ros_class = _ros_class(ros_type)
    with _lock:
        if (ros_type, gz_type) in _pairs:
            raise ValueError(f"the pair {ros_type} = {gz_type} is declared twice")
        _pairs[ros_type, gz_type] = TypePair(ros_type, gz_type, ros_class, message_class(gz_type), to_ros, to_gz, fault)


def add_service(
    ros_type: str,
    gz_request_type: str,
    gz_reply_type: str,
    *,
    request_to_gz: Callable[[Any], Any],
    reply_to_ros: Callable[[Any], Any],
    fault: Callable[[Any], str | None] | None = None,
) -> None:
    """Add a service to the table. Raises ValueError if it is already there."""
    key = (ros_type, gz_request_type, gz_reply_type)
    ros_class = _ros_class(ros_type)
    with _lock:
        if key in _services:
            raise ValueError(f"the service {ros_type} = {gz_request_type}/{gz_reply_type} is declared twice")
        _services[key] = ServiceTypes(
            *key,
            ros_class,
            message_class(gz_request_type),
            message_class(gz_reply_type),
            request_to_gz,
            reply_to_ros,
            fault,
        )


def convertible_packages() -> list[str]:
    """Return the names of the ROS packages that have a file in `convert/`, installed or not."""
    return sorted(module.name for module in pkgutil.iter_modules(ros_gz_bridge_convert.__path__))


def missing_packages() -> list[str]:
    """Return the packages among `convertible_packages` that are not installed; their pairs cannot be used."""
    return [name for name in convertible_packages() if not _installed(name)]


def pairs() -> list[TypePair]:
    """Return every pair whose ROS package is installed, sorted by ROS type."""
    for package in convertible_packages():
        _load(package)
    return [_pairs[key] for key in sorted(_pairs)]


def services() -> list[ServiceTypes]:
    """Return every service whose ROS package is installed, sorted by ROS type."""
    for package in convertible_packages():
        _load(package)
    return [_services[key] for key in sorted(_services)]


def canonical_gz_type(gz_type: str) -> str:
    """Return `gz.msgs.X` for the older spellings (`ignition.msgs.X`, `gz_msgs.X`), other names unchanged."""
    for prefix in _GZ_PREFIXES:
        if gz_type.startswith(prefix):
            return "gz.msgs." + gz_type.removeprefix(prefix)
    return gz_type


def find_pair(ros_type: str, gz_type: str) -> TypePair:
    """Return the pair of these two types.

    Raises MissingPackageError if the ROS package is not installed, and UnknownPairError if there is no such pair.
    """
    gz_type = canonical_gz_type(gz_type)
    need_package(ros_type)
    if (pair := _pairs.get((ros_type, gz_type))) is not None:
        return pair
    raise UnknownPairError(_explain_unknown(ros_type, gz_type))


def find_service(ros_type: str, gz_request_type: str = "", gz_reply_type: str = "") -> ServiceTypes:
    """Return the service of these types; an empty Gazebo type matches any. Raises the errors of `find_pair`."""
    wanted = (canonical_gz_type(gz_request_type), canonical_gz_type(gz_reply_type))
    need_package(ros_type)
    for service in services():
        offered = (service.gz_request_type, service.gz_reply_type)
        if service.ros_type == ros_type and all(w in ("", o) for w, o in zip(wanted, offered, strict=True)):
            return service
    raise UnknownPairError(_explain_unknown_service(ros_type, wanted))


def _ros_class(ros_type: str) -> Any:
    package, kind, name = ros_type.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), name)


def _installed(package: str) -> bool:
    return importlib.util.find_spec(package) is not None


def need_package(ros_type: str) -> None:
    """Load the conversions of a type's ROS package. Raises MissingPackageError if the package is not installed."""
    package = ros_type.split("/")[0]
    if package in convertible_packages():
        if not _installed(package):
            raise MissingPackageError(
                f"the type {ros_type} needs the ROS package {package}, which is not installed; "
                f"source a ROS 2 workspace that has it, then start again"
            )
        _load(package)


def _load(package: str) -> None:
    with _lock:
        if package not in _loaded and _installed(package):
            _loaded.add(package)
            importlib.import_module(f"gz_course.sim.bridge.ros_gz_bridge.convert.{package}")


def _explain_unknown(ros_type: str, gz_type: str) -> str:
    known = pairs()
    partners = [pair.gz_type for pair in known if pair.ros_type == ros_type]
    if partners:
        return f"{ros_type} cannot become {gz_type}; {ros_type} pairs with {_either(partners)}"
    if not re.fullmatch(r"\w+/msg/\w+", ros_type):
        seen = f"{ros_type} is not a ROS message type (package/msg/Name)"
    else:
        seen = f"no conversion is known for {ros_type}"
    partners = [pair.ros_type for pair in known if pair.gz_type == gz_type]
    if partners:
        return f"{seen}; {gz_type} pairs with {_either(partners)}"
    wanted = f"{ros_type}@{gz_type}"
    by_text = {f"{pair.ros_type}@{pair.gz_type}": pair for pair in known}
    pair = by_text[nearest_name(wanted, by_text, 0.0)]
    return f"{seen}, nor for {gz_type}; the nearest pair is {pair.ros_type} with {pair.gz_type}"


def _explain_unknown_service(ros_type: str, wanted: tuple[str, str]) -> str:
    known = services()
    for service in known:
        if service.ros_type == ros_type:
            takes = f"it takes {service.gz_request_type} and answers {service.gz_reply_type}"
            return f"the service {ros_type} does not go with {' and '.join(filter(None, wanted))}; {takes}"
    seen = f"no conversion is known for the service {ros_type}"
    if not known:
        absent = ", ".join(missing_packages())
        return f"{seen}; none is known without these ROS packages, which are not installed: {absent}"
    names = [service.ros_type for service in known]
    return f"{seen}; the nearest is {nearest_name(ros_type, names, 0.0)}"


def _either(names: list[str]) -> str:
    return " or ".join(names)
