"""The action that sets the namespace of all nodes of a scope."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.launch_ros.node_name import check_namespace, joined

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser

NAMESPACE = "ros_namespace"


@expose_action("push_ros_namespace")
@expose_action("push-ros-namespace")
class PushROSNamespace(Action):
    """Adds a namespace for the following nodes; an absolute one replaces it.

    Execution raises LaunchError if the namespace is invalid.
    """

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = normalize_to_list_of_substitutions(namespace)

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<push_ros_namespace namespace=/>`."""
        _, options = super().parse(entity, parser)
        options["namespace"] = parser.parse_substitution(entity.get_attr("namespace"))
        return cls, options

    def execute(self, context: LaunchContext) -> None:
        namespace = perform_substitutions(context, self.namespace)
        result = joined(context.launch_configurations.get(NAMESPACE), namespace)
        if result is not None:
            check_namespace(result)
            context.launch_configurations[NAMESPACE] = result


PushRosNamespace = PushROSNamespace
