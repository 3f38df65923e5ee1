"""A namespace for all nodes of a scope."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch.action import Action
from gz_course.sim.launch.launch_context import LaunchContext
from gz_course.sim.launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from gz_course.sim.launch_ros.node_name import check_namespace, joined

NAMESPACE = "ros_namespace"


class PushROSNamespace(Action):
    """Puts the nodes that follow into a namespace inside of the one they are in; an absolute one replaces it."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__namespace = normalize_to_list_of_substitutions(namespace)

    @property
    def namespace(self) -> list[Substitution]:
        """The namespace."""
        return self.__namespace

    def execute(self, context: LaunchContext) -> None:
        """Push it. Raises LaunchError when it is not valid."""
        namespace = perform_substitutions(context, self.__namespace)
        result = joined(context.launch_configurations.get(NAMESPACE), namespace)
        if result is not None:
            check_namespace(result)
            context.launch_configurations[NAMESPACE] = result


PushRosNamespace = PushROSNamespace
