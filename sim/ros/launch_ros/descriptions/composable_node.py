"""The description of a node for a container."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.launch_ros.component_programs import program_of
from gz_course.sim.ros.launch_ros.nested_parameters import parse_nested_parameters, parse_node_options

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


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

    @classmethod
    def parse(cls, parser: Parser, entity: Entity) -> tuple[Any, dict[str, Any]]:
        """Read `<composable_node pkg= plugin= [name=] [namespace=]>` with `<param>`, `<remap>` and `<extra_arg>`."""
        _, options = Action.parse(entity, parser)
        for name, option in (("pkg", "package"), ("plugin", "plugin"), ("name", "name"), ("namespace", "namespace")):
            value = entity.get_attr(name, optional=name not in ("pkg", "plugin"))
            if value is not None:
                options[option] = parser.parse_substitution(value)
        options |= parse_node_options(entity, parser)
        extra = entity.get_attr("extra_arg", data_type=list[Entity], optional=True)
        if extra is not None:
            options["extra_arguments"] = parse_nested_parameters(extra, parser)
        entity.assert_entity_completely_parsed()
        return cls, options

    @classmethod
    def parsed(cls, entities: Iterable[Entity], parser: Parser) -> list[ComposableNode]:
        """Return the descriptions of `<composable_node>` elements."""
        return [kind(**options) for kind, options in (cls.parse(parser, entity) for entity in entities)]

    def as_process(self, context: LaunchContext, **options: Any) -> list[Action]:
        """Return the action that runs the node as a process, none if its condition does not hold.

        Raises NotAvailableError if no program runs the component.
        """
        from gz_course.sim.ros.launch_ros.actions.node import Node

        if self.condition is not None and not self.condition.evaluate(context):
            return []
        package = perform_substitutions(context, normalize_to_list_of_substitutions(self.package))
        plugin = perform_substitutions(context, normalize_to_list_of_substitutions(self.node_plugin))
        return [
            Node(
                package=package,
                executable=program_of(package, plugin),
                name=self.node_name,
                namespace=self.node_namespace,
                parameters=self.parameters,
                remappings=self.remappings,
                **options,
            )
        ]
