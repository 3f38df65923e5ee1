"""Classes of interfaces by their names: `sensor_msgs/msg/LaserScan`, or `sensor_msgs/LaserScan`."""

from __future__ import annotations

from typing import Any

from rosidl_parser.definition import NamespacedType

from gz_course.sim.ros.rosidl_runtime_py.import_message import import_message_from_namespaced_type


def get_interface(identifier: str) -> Any:
    """Return the class of a full name such as `std_srvs/srv/Empty`."""
    return import_message_from_namespaced_type(get_namespaced_type(identifier))


def get_message(identifier: str) -> Any:
    """Return the class of a message. Raises ValueError if the name is that of something else."""
    return _checked(import_message_from_namespaced_type(get_message_namespaced_type(identifier)), identifier, "message")


def get_service(identifier: str) -> Any:
    """Return the class of a service. Raises ValueError if the name is that of something else."""
    return _checked(import_message_from_namespaced_type(get_service_namespaced_type(identifier)), identifier, "service")


def get_action(identifier: str) -> Any:
    """Return the class of an action. Raises ValueError if the name is that of something else."""
    return _checked(import_message_from_namespaced_type(get_action_namespaced_type(identifier)), identifier, "action")


def get_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type of a full name."""
    *namespaces, name = identifier.split("/")
    return NamespacedType(namespaces, name)


def get_message_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type of a name, in which `msg` may be left out."""
    return _of_kind(identifier, "msg")


def get_service_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type of a name, in which `srv` may be left out."""
    return _of_kind(identifier, "srv")


def get_action_namespaced_type(identifier: str) -> NamespacedType:
    """Return the type of a name, in which `action` may be left out."""
    return _of_kind(identifier, "action")


def is_message(interface: Any) -> bool:
    return hasattr(interface, "SLOT_TYPES")


def is_service(interface: Any) -> bool:
    return hasattr(interface, "Request") and hasattr(interface, "Response")


def is_action(interface: Any) -> bool:
    return hasattr(interface, "Goal") and hasattr(interface, "Result") and hasattr(interface, "Feedback")


_CHECKS = {"message": is_message, "service": is_service, "action": is_action}


def _checked(interface: Any, identifier: str, kind: str) -> Any:
    if not _CHECKS[kind](interface):
        raise ValueError(f"Expected the full name of {'an' if kind == 'action' else 'a'} {kind}, got '{identifier}'")
    return interface


def _of_kind(identifier: str, kind: str) -> NamespacedType:
    found = get_namespaced_type(identifier)
    return NamespacedType([*found.namespaces, kind], found.name) if len(found.namespaces) == 1 else found
