"""Components: what is registered, and why none can be loaded here.

Source: ros2component 0.32 (`ros2component/api`: resource, names of services)
"""

from __future__ import annotations

from ament_index_python import get_resource, get_resources

from gz_course.sim.ros.ros2.errors import CommandError

_RESOURCE = "rclcpp_components"
LIST_SERVICE = "/_container/list_nodes"


def registered(package: str) -> list[str]:
    """Return the component classes that an installed package has registered."""
    if package not in get_resources(_RESOURCE):
        return []
    content, _ = get_resource(_RESOURCE, package)
    return [line.partition(";")[0] for line in content.splitlines() if line.strip()]


def packages_with_components() -> list[str]:
    return sorted(get_resources(_RESOURCE))


def refusal(what: str) -> CommandError:
    """Return the error for something that needs a container in C++."""
    return CommandError(
        f"{what}: components are libraries in C++, and there is no container for them here; start the node as a "
        "process of its own (`ros2 pkg executables PACKAGE`, then `ros2 run PACKAGE EXECUTABLE`)"
    )
