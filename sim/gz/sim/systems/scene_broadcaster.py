"""SceneBroadcaster: publishes the entities of the world and their poses.

Topics below `/world/W`: `pose/info` (Pose_V: every model, link, visual and light) at 60 Hz, `dynamic_pose/info`
(Pose_V: models and links that can move), `scene/info` (Scene: new entities), `scene/deletion` (UInt32_V: ids of removed
entities), `state` (SerializedStepMap). Services: `scene/info`, `scene/graph` (Graphviz), `state` and `state_async`.
As in Gazebo poses are in the parent's frame and names are unscoped. Rates are in simulated time; a paused server
publishes everything ten times per second. Messages are built by `gz.sim.scene`, only for topics with subscribers.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/scene_broadcaster/SceneBroadcaster.cc
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from gz_course.sim.gz.sim.errors import LOG, SimError
from gz_course.sim.gz.sim.plugins.period import LONGEST_NS
from gz_course.sim.gz.sim.plugins.system import FOREVER_NS, System, UpdateInfo, system
from gz_course.sim.gz.sim.scene.fields import fill_pose, set_pose, set_stamp
from gz_course.sim.gz.sim.scene.graph import KINDS, SceneGraph, Vertex
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

POSE_HERTZ = 60.0
T = TypeVar("T")


class Schedule:
    """The schedule of a topic of a fixed rate: the time [ns] of its next message."""

    def __init__(self, hertz: float) -> None:
        self.period_ns = max(1, round(min(1e9 / hertz, LONGEST_NS)))
        self.next_ns = 0

    def due(self, now_ns: int) -> bool:
        """Tell whether a message is due; if so, schedule the next one."""
        if now_ns < self.next_ns:
            return False
        self.next_ns = (now_ns // self.period_ns + 1) * self.period_ns
        return True


class PoseVector:
    """A Pose_V of fixed entities, of which only the moved ones are rewritten."""

    def __init__(self, message: Any, vertices: list[Vertex], movers: list[Vertex]) -> None:
        self.message = message
        fields: dict[int, Any] = {}
        for vertex in vertices:
            pose = message.pose.add(name=vertex.name, id=vertex.number)
            set_pose(pose, vertex.pose)
            fields[id(vertex)] = pose
        self._moving = [(place, fields[id(vertex)]) for place, vertex in enumerate(movers) if id(vertex) in fields]

    def at(self, now_ns: int, positions: list[list[float]], quaternions: list[list[float]]) -> Any:
        """Return the message with the poses of the movers, stamped `now_ns`."""
        set_stamp(self.message.header, now_ns)
        for place, field in self._moving:
            fill_pose(field, positions[place], quaternions[place])
        return self.message


@system("SceneBroadcaster", "gz-sim-scene-broadcaster-system")
class SceneBroadcaster(System):
    """Publishes the scene of one world. Parameters and defaults are Gazebo's."""

    once = True
    parameters = frozenset(["dynamic_pose_hertz", "state_hertz"])

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the rates; the plugin belongs directly to the world."""
        if model is not None:
            raise plugin.element.error("SceneBroadcaster belongs directly in the <world>, not inside a <model>")
        self._world = world
        self._dynamic_hertz = _rate(plugin.element, "dynamic_pose_hertz")
        self._state_hertz = _rate(plugin.element, "state_hertz")
        self._graph: SceneGraph | None = None
        self._stale = True
        """True if there are unpublished changes."""
        self._pose_vectors: tuple[PoseVector, PoseVector] | None = None
        """The messages of `pose/info` and `dynamic_pose/info`, created for the first subscriber."""
        self._sent: dict[tuple[str, str], list[int]] = {}
        """The published entities: the ids of a model or light and of its parts, by kind and name."""
        self._node: Node | None = None

    def bind(self) -> None:
        """Discard the scene graph, because entities may have been added or removed."""
        self._graph, self._stale = None, True

    def start(self) -> None:
        """Restart the schedules; publish deletions, then all existing entities."""
        self._all, self._dynamic = Schedule(POSE_HERTZ), Schedule(self._dynamic_hertz)
        self._state = Schedule(self._state_hertz)
        self._next_ns = 0
        self._state_known = False
        self._graph = None
        if self._node is not None:
            self._announce(self._outline(self._current_graph()), removals_only=True)
        self._sent = {}
        self._graph, self._stale = None, True

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
        from gz_course.sim.gz.msgs.scene_pb2 import Scene
        from gz_course.sim.gz.msgs.serialized_map_pb2 import SerializedStepMap
        from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg
        from gz_course.sim.gz.msgs.uint32_v_pb2 import UInt32_V

        self._pose_v, self._step_map, self._numbers, self._empty = Pose_V, SerializedStepMap, UInt32_V, Empty
        self._node = node
        root = self._world.topic
        self._all_publisher = node.advertise(f"{root}/pose/info", Pose_V)
        self._dynamic_publisher = node.advertise(f"{root}/dynamic_pose/info", Pose_V)
        self._scene_publisher = node.advertise(f"{root}/scene/info", Scene)
        self._deletion_publisher = node.advertise(f"{root}/scene/deletion", UInt32_V)
        self._state_publisher = node.advertise(f"{root}/state", SerializedStepMap)
        node.advertise_service(f"{root}/scene/info", Empty, Scene, self._answer(self._scene, Scene))
        node.advertise_service(f"{root}/scene/graph", Empty, StringMsg, self._answer(self._dot, StringMsg))
        node.advertise_service(
            f"{root}/state", Empty, SerializedStepMap, self._answer(self._full_step, SerializedStepMap)
        )
        node.advertise_service(f"{root}/state_async", StringMsg, Empty, self._send_state)

    def post_update(self, info: UpdateInfo) -> None:
        if self._node is None:
            return
        if self._stale:
            self._renew()
        now_ns = info.sim_time_ns
        if now_ns < self._next_ns:
            return
        # All three schedules advance, with or without subscribers.
        due = self._all.due(now_ns), self._dynamic.due(now_ns), self._state.due(now_ns)
        self._next_ns = min(self._all.next_ns, self._dynamic.next_ns, self._state.next_ns)
        self._publish(now_ns, *due)

    def rests_until(self, info: UpdateInfo) -> int:
        if self._node is None:
            return FOREVER_NS
        return 0 if self._stale else self._next_ns

    def paused_update(self, info: UpdateInfo) -> None:
        if self._node is None:
            return
        if self._stale:
            self._renew()
        self._publish(info.sim_time_ns, True, True, True)

    def _publish(self, now_ns: int, every: bool, dynamic: bool, state: bool) -> None:
        every = every and self._all_publisher.has_connections()
        dynamic = dynamic and self._dynamic_publisher.has_connections()
        if every or dynamic:
            all_poses, dynamic_poses = self._pose_vectors or self._make_pose_vectors()
            positions, quaternions = (array.tolist() for array in self._current_graph().poses())
            if every:
                self._all_publisher.publish(all_poses.at(now_ns, positions, quaternions))
            if dynamic:
                self._dynamic_publisher.publish(dynamic_poses.at(now_ns, positions, quaternions))
        if state:
            self._publish_state()

    def _make_pose_vectors(self) -> tuple[PoseVector, PoseVector]:
        graph = self._current_graph()
        listed = list(graph)
        by_kind = [vertex for kind in KINDS for vertex in listed if vertex.kind == kind]
        moving = [vertex for vertex in by_kind if vertex.moves]
        made = (
            PoseVector(self._pose_v(), by_kind, graph.movers),
            PoseVector(self._pose_v(), moving, graph.movers),
        )
        self._pose_vectors = made
        return made

    def _publish_state(self) -> None:
        """Publish the whole state to new subscribers and after every change, otherwise the moving entities."""
        if not self._state_publisher.has_connections():
            self._state_known = False
            return
        from gz_course.sim.gz.sim.scene.state import pose_state

        if self._state_known:
            message = self._step(pose_state(self._world, self._current_graph()))
        else:
            message = self._full_step()
            self._state_known = True
        # A map has no order: without sorting, equal states could serialize to different bytes.
        data = message.SerializeToString(deterministic=True)
        self._state_publisher.publish_raw(data, message.DESCRIPTOR.full_name)

    def _current_graph(self) -> SceneGraph:
        if self._graph is None:
            self._graph = SceneGraph(self._world)
        return self._graph

    def _renew(self) -> None:
        """Rebuild the scene graph, and publish added and removed entities."""
        self._pose_vectors = None
        self._state_known = False
        outline = self._outline(self._current_graph())
        self._announce(outline)
        self._sent, self._stale = outline, False

    @staticmethod
    def _outline(graph: SceneGraph) -> dict[tuple[str, str], list[int]]:
        return {
            (vertex.kind, vertex.name): [each.number for each in vertex.below() if each.kind in ("model", "light")]
            for vertex in graph.root.children
            if vertex.kind in ("model", "light")
        }

    def _announce(self, outline: dict[tuple[str, str], list[int]], *, removals_only: bool = False) -> None:
        gone = [number for key, numbers in self._sent.items() if outline.get(key) != numbers for number in numbers]
        if gone and self._deletion_publisher.has_connections():
            self._deletion_publisher.publish(self._numbers(data=gone))
        new = [numbers[0] for key, numbers in outline.items() if self._sent.get(key) != numbers]
        if new and not removals_only and self._scene_publisher.has_connections():
            from gz_course.sim.gz.sim.scene.message import scene_message

            self._scene_publisher.publish(scene_message(self._world, self._current_graph(), new))

    def _scene(self) -> Any:
        from gz_course.sim.gz.sim.scene.message import scene_message

        return scene_message(self._world, self._current_graph())

    def _dot(self) -> Any:
        from gz_course.sim.gz.msgs.stringmsg_pb2 import StringMsg

        return StringMsg(data=self._current_graph().dot())

    def _full_step(self) -> Any:
        from gz_course.sim.gz.sim.scene.state import full_state

        return self._step(full_state(self._world, self._current_graph()))

    def _step(self, state: Any) -> Any:
        """Return the present SerializedStepMap; it contains no wall time, so that equal runs give equal bytes."""
        world = self._world
        message = self._step_map(state=state)
        stats = message.stats
        stats.sim_time.sec, stats.sim_time.nsec = divmod(world.sim_time_ns, 1_000_000_000)
        stats.step_size.sec, stats.step_size.nsec = divmod(world.step_size_ns, 1_000_000_000)
        stats.iterations = world.iterations
        return message

    def _answer(self, work: Callable[[], T], response_type: Callable[[], T]) -> Callable[[Any], tuple[bool, T]]:
        """Wrap a service handler so that the stepping thread calls it between two steps."""

        def answer(_request: Any) -> tuple[bool, T]:
            try:
                return True, self._world.requests.call(work)
            except SimError as error:
                LOG.error("the scene of world '%s' was asked for: %s", self._world.name, error)
                return False, response_type()

        return answer

    def _send_state(self, request: Any) -> Any:
        """Call the one-way service that `request` names with the whole state."""
        made, message = self._answer(self._full_step, self._step_map)(request)
        if made and self._node is not None:
            try:
                self._node.options.qualified(request.data, "service")
            except ValueError as error:
                LOG.error("state_async of world '%s' was asked for: %s", self._world.name, error)
            else:
                self._node.request(request.data, message, self._step_map, self._empty)
        return self._empty()


def _rate(element: Element, tag: str) -> float:
    hertz = element.number(tag, POSE_HERTZ)
    if not 0.0 < hertz < math.inf:
        raise element.error(f"SceneBroadcaster's <{tag}> must be greater than zero, got {hertz:g}")
    return hertz
