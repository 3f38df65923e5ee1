"""The action that starts a lifecycle node, whose states the launch changes and follows.

Source: ros2/launch_ros, launch_ros/launch_ros/actions/lifecycle_node.py
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import gz_course.sim.ros.launch.logging as launch_logging
from gz_course.sim.ros.launch.errors import LaunchError
from gz_course.sim.ros.launch.event import Event
from gz_course.sim.ros.launch.event_handler import EventHandler
from gz_course.sim.ros.launch.frontend.expose import expose_action
from gz_course.sim.ros.launch.launch_context import LaunchContext
from gz_course.sim.ros.launch.launch_description_entity import LaunchDescriptionEntity
from gz_course.sim.ros.launch.process_settings import plain_or_substitutions
from gz_course.sim.ros.launch.some_substitutions_type import SomeSubstitutionsType
from gz_course.sim.ros.launch_ros.actions.lifecycle_transition import LifecycleTransition
from gz_course.sim.ros.launch_ros.actions.node import Node
from gz_course.sim.ros.launch_ros.events.lifecycle import ChangeState, StateTransition
from gz_course.sim.ros.launch_ros.lifecycle_states import ACTIVATE, CONFIGURE, TRANSITIONS
from gz_course.sim.ros.launch_ros.ros_adapters import get_ros_node

if TYPE_CHECKING:
    from gz_course.sim.ros.launch.frontend import Entity, Parser

_LOG = launch_logging.get_logger("launch_ros.actions.lifecycle_node")
_PATIENCE = 0.5  # [s] after which a wait for the node looks whether the launch ends


@expose_action("lifecycle_node")
class LifecycleNode(Node):
    """A Node that is a lifecycle node. It needs a `name`; with `autostart` it is configured and activated.

    Each ChangeState event for it becomes a request to the node, each transition of the node a StateTransition event.
    """

    is_lifecycle_node = True

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType = "",
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.node_autostart = plain_or_substitutions(autostart)
        self.__client: Any = None

    @classmethod
    def parse(cls, entity: Entity, parser: Parser, ignore: Iterable[str] = ()) -> tuple[Any, dict[str, Any]]:
        """Read `<lifecycle_node pkg= exec= name= ...>`, as a node with `autostart`."""
        entity.get_attr("name")
        _, options = super().parse(entity, parser, ignore)
        autostart = entity.get_attr("autostart", data_type=bool, optional=True)
        if autostart is not None:
            options["autostart"] = parser.parse_if_substitutions(autostart)
        return cls, options

    @property
    def node_name(self) -> str | None:
        """Return namespace and name after execution; without a namespace it is `/`."""
        return (super().node_name or "").replace("<node_namespace_unspecified>", "")

    def prepare(self, context: LaunchContext) -> None:
        """Build the command, and connect to the node. Raises LaunchError if the name is empty."""
        super().prepare(context)
        if "<" in str(self.node_name):
            raise LaunchError("the name of a LifecycleNode is empty; it is needed to change its state")
        from lifecycle_msgs.msg import TransitionEvent
        from lifecycle_msgs.srv import ChangeState as ChangeStateService

        ros_node, loop = get_ros_node(context), context.asyncio_loop
        assert loop is not None

        def follow(message: Any) -> None:
            event = StateTransition(action=self, msg=message)
            loop.call_soon_threadsafe(context.emit_event_sync, event)

        ros_node.create_subscription(TransitionEvent, f"{self.node_name}/transition_event", follow, 10)
        self.__client = ros_node.create_client(ChangeStateService, f"{self.node_name}/change_state")
        context.register_event_handler(_ChangeStateHandler(self))

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity] | None:
        """Start the node; with `autostart` return its transitions."""
        from gz_course.sim.ros.launch.conditions import evaluate_condition_expression

        following = list(super().execute(context) or [])
        if self.__client is not None and evaluate_condition_expression(context, self.node_autostart):
            following.append(LifecycleTransition(lifecycle_nodes=[self], transition_ids=[CONFIGURE, ACTIVATE]))
        return following

    async def change_state(self, context: LaunchContext, transition: int) -> None:
        """Request a transition as soon as the node offers its service, unless the launch or the node ends before."""
        try:
            await self._request(context, transition)
        except Exception:
            if not context.is_shutdown:  # the ROS node of the launch ends with it
                raise

    async def _request(self, context: LaunchContext, transition: int) -> None:
        loop, client = asyncio.get_running_loop(), self.__client
        while not await loop.run_in_executor(None, client.wait_for_service, _PATIENCE):
            if self._is_over(context):
                _LOG.warning(f"no longer waiting for the service '{client.srv_name}': the launch or the node has ended")
                return
        request = client.srv_type.Request()
        request.transition.id = transition
        answered = asyncio.Event()
        answer = client.call_async(request)
        answer.add_done_callback(lambda _: loop.call_soon_threadsafe(answered.set))
        while not answered.is_set():
            if self._is_over(context):
                _LOG.warning(f"no longer waiting for '{client.srv_name}' to answer: the launch or the node has ended")
                return
            waiting = asyncio.ensure_future(answered.wait())
            await asyncio.wait([waiting], timeout=_PATIENCE)
            waiting.cancel()
        if not answer.result().success:
            _LOG.error(f"Failed to make transition '{TRANSITIONS[transition]}' for LifecycleNode '{self.node_name}'")

    def _is_over(self, context: LaunchContext) -> bool:
        future = self.get_asyncio_future()
        return context.is_shutdown or (future is not None and future.done())


class _ChangeStateHandler(EventHandler):
    """Passes requests for transitions to the lifecycle node."""

    def __init__(self, action: LifecycleNode) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, ChangeState) and bool(event.lifecycle_node_matcher(action))
        )
        self._action = action

    def handle(self, event: Event, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        assert isinstance(event, ChangeState) and context.asyncio_loop is not None
        work = self._action.change_state(context, event.transition_id)
        context.add_completion_future(context.asyncio_loop.create_task(work))
        return []
