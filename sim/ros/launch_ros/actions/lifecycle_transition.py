"""The action that leads lifecycle nodes through several transitions, one after the other."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros.launch.action import Action
from gz_course.sim.ros.launch.actions.emit_event import EmitEvent
from gz_course.sim.ros.launch.actions.register_event_handler import RegisterEventHandler
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.events.matchers import matches_action
from gz_course.sim.ros.launch.frontend.entity import Entity
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from gz_course.sim.ros.launch_ros.events.lifecycle import ChangeState, StateTransition
from gz_course.sim.ros.launch_ros.events.matchers import matches_node_name
from gz_course.sim.ros.launch_ros.lifecycle_states import GOALS, transition_number

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Parser


@expose_action("lifecycle_transition")
class LifecycleTransition(Action):
    """Requests the first of `transition_ids`, and the next whenever a node has reached the state before it.

    The nodes are given by their full names, or with `lifecycle_nodes` as actions.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType] = (),
        transition_ids: Iterable[int | str],
        lifecycle_nodes: Iterable[Action] = (),
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._names = [normalize_to_list_of_substitutions(name) for name in lifecycle_node_names]
        self._nodes = list(lifecycle_nodes)
        self._transitions = [transition_number(each) for each in transition_ids]
        if not self._transitions or not (self._names or self._nodes):
            raise ValueError("LifecycleTransition wants at least one node and one transition")

    @classmethod
    def parse(cls, entity: Entity, parser: Parser) -> tuple[Any, dict[str, Any]]:
        """Read `<lifecycle_transition>` with children `<lifecycle_node name=/>` and `<transition label=/>`."""
        _, options = super().parse(entity, parser)
        nodes = entity.get_attr("lifecycle_node", data_type=list[Entity])
        transitions = entity.get_attr("transition", data_type=list[Entity])
        options["lifecycle_node_names"] = [parser.parse_substitution(each.get_attr("name")) for each in nodes]
        options["transition_ids"] = [each.get_attr("label") for each in transitions]
        for each in (*nodes, *transitions):
            each.assert_entity_completely_parsed()
        return cls, options

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return what waits for the states, and the first request."""
        matchers: list[Any] = [matches_node_name(perform_substitutions(context, name)) for name in self._names]
        matchers += [matches_action(node) for node in self._nodes]
        following: list[LaunchDescriptionEntity] = []
        for matcher in matchers:
            for done, then in zip(self._transitions, self._transitions[1:], strict=False):
                following.append(RegisterEventHandler(_Step(matcher, GOALS.get(done, ""), then)))
            event = ChangeState(lifecycle_node_matcher=matcher, transition_id=self._transitions[0])
            following.append(EmitEvent(event=event))
        return following


class _Step(EventHandler):
    """Requests a transition once, when a node has reached a state."""

    def __init__(self, matcher: Any, state: str, transition: int) -> None:
        request = EmitEvent(event=ChangeState(lifecycle_node_matcher=matcher, transition_id=transition))

        def reached(event: Event) -> bool:
            return isinstance(event, StateTransition) and event.goal_state == state and bool(matcher(event.action))

        super().__init__(matcher=reached, entities=[request], handle_once=True)
