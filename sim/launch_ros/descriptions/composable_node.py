"""A node that is loaded into a container. It can be described here, but not loaded: see `launch_ros.actions`."""

from __future__ import annotations

from typing import Any


class ComposableNode:
    """The description of a node by package, plugin and the arguments it has with Node."""

    def __init__(
        self,
        *,
        package: Any,
        plugin: Any,
        name: Any = None,
        namespace: Any = None,
        parameters: Any = None,
        remappings: Any = None,
        extra_arguments: Any = None,
        condition: Any = None,
    ) -> None:
        self.package = package
        self.node_plugin = plugin
        self.node_name = name
        self.node_namespace = namespace
        self.parameters = parameters
        self.remappings = remappings
        self.extra_arguments = extra_arguments
        self.condition = condition
