"""The action that adds composable nodes to a container, here each as a process of its own."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch_ros.descriptions.composable_node import ComposableNode

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


@expose_action("load_composable_node")
class LoadComposableNodes(Action):
    """Starts the nodes of `composable_node_descriptions`; no container needs to exist (`ComposableNodeContainer`)."""

    def __init__(
        self, *, composable_node_descriptions: Iterable[ComposableNode], target_container: Any, condition: Any = None
    ) -> None:
        super().__init__(condition=condition)
        self.composable_node_descriptions = list(composable_node_descriptions)
        self.target_container = target_container

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<load_composable_node target=>` with `<composable_node>` elements."""
        _, options = super().parse(entity, parser)
        options["target_container"] = parser.parse_substitution(entity.get_attr("target"))
        nodes = entity.get_attr("composable_node", data_type=list[Entity])
        options["composable_node_descriptions"] = ComposableNode.parsed(nodes, parser)
        return cls, options

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the nodes. Raises NotAvailableError for a component that no program runs."""
        return [each for node in self.composable_node_descriptions for each in node.as_process(context)]
