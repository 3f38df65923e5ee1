"""The rules for names of nodes and namespaces, without rclpy, which is slow to import.

Source: ros2/rmw, rmw/src/validate_node_name.c and rmw/src/validate_namespace.c
"""

from __future__ import annotations

import re

from gz_course.sim.ros.launch.errors import LaunchError

_TOKEN = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_LONGEST_NAME = 255
_LONGEST_NAMESPACE = 245


def check_node_name(name: str) -> None:
    """Raise LaunchError for an invalid node name."""
    if not _TOKEN.fullmatch(name):
        raise LaunchError(
            f"the node name '{name}' is not valid: letters, digits and _ are allowed, and no digit at its beginning"
        )
    if len(name) > _LONGEST_NAME:
        raise LaunchError(f"the node name '{name[:20]}...' has {len(name)} letters; {_LONGEST_NAME} are allowed")


def check_namespace(namespace: str) -> None:
    """Raise LaunchError unless this is an absolute namespace, `/` or `/a/b`."""
    parts = namespace.split("/")[1:]
    if not namespace.startswith("/") or (namespace != "/" and not all(_TOKEN.fullmatch(part) for part in parts)):
        raise LaunchError(
            f"the namespace '{namespace}' is not valid: between its / only letters, digits and _ are allowed, and no "
            "digit at the beginning of a part"
        )
    if len(namespace) > _LONGEST_NAMESPACE:
        raise LaunchError(f"the namespace '{namespace[:20]}...' has more than {_LONGEST_NAMESPACE} letters")


def joined(base: str | None, namespace: str | None) -> str | None:
    """Return a namespace relative to `base`; an absolute one is unchanged. None if there is neither.

    The result begins with `/` and does not end with one, except for `/` itself.
    """
    if not namespace:
        namespace, base = base, None
    if not namespace:
        return None
    if not namespace.startswith("/"):
        namespace = f"{base or ''}/{namespace}"
    return "/" + namespace.strip("/")
