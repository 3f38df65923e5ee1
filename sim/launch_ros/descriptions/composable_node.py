"""The description of a node for a container; such nodes cannot be loaded here, see `launch_ros.actions`."""

from __future__ import annotations

from typing import Any


class ComposableNode:
    """A composable node: its package, plugin and the arguments of Node."""

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
