"""The action that starts composable nodes, here each as a process of its own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.action_of_processes import ActionOfProcesses
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import (
    describe_substitutions,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from gz_course.sim.ros.launch_ros.actions.node import Node
from gz_course.sim.ros.launch_ros.descriptions.composable_node import ComposableNode

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser

_LOG = launch_logging.get_logger("launch_ros.actions.composable_node_container")
_OF_THE_CONTAINER = ("parameters", "remappings", "arguments", "ros_arguments", "exec_name")


@expose_action("node_container")
class ComposableNodeContainer(ActionOfProcesses):
    """Starts the nodes of `composable_node_descriptions`; the container itself does not exist.

    A node is started by the program that is registered for its component (`component_programs`). Arguments about
    processes (`output`, `respawn`, `on_exit`, ...) are those of each node. For an event handler the container ends with
    the last of its nodes.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType | None = None,
        package: SomeSubstitutionsType = "rclcpp_components",
        executable: SomeSubstitutionsType = "component_container",
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        condition: Any = None,
        **arguments: Any,
    ) -> None:
        super().__init__(condition=condition)
        self.container_name = normalize_to_list_of_substitutions(name)
        self.namespace, self.package, self.executable = namespace, package, executable
        self.composable_node_descriptions = list(composable_node_descriptions or ())
        self.arguments = arguments

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<node_container pkg= exec= name= namespace=>` with `<composable_node>` elements."""
        entity.get_attr("name")
        _, options = Node.parse(entity, parser)
        nodes = entity.get_attr("composable_node", data_type=list[Entity], optional=True)
        options["composable_node_descriptions"] = ComposableNode.parsed(nodes or (), parser)
        return cls, options

    def describe(self) -> str:
        return f"{type(self).__name__}(name={describe_substitutions(self.container_name)})"

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the nodes. Raises NotAvailableError for a component that no program runs."""
        options = {name: value for name, value in self.arguments.items() if name not in _OF_THE_CONTAINER}
        nodes = [each for node in self.composable_node_descriptions for each in node.as_process(context, **options)]
        self.processes += nodes
        name = perform_substitutions(context, self.container_name)
        _LOG.info(f"the nodes of the container '{name}' run as processes of their own ({len(nodes)})")
        return list(nodes)
