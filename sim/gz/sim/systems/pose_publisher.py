"""PosePublisher: publishes the poses of a model's links, and optionally of its other parts, as transforms for tf.

It publishes after each step, or at `<update_frequency>` [Hz] of simulated time, on `/model/M/pose`: one Pose per
entity, or one Pose_V of all. Each pose is in the frame of its parent: the header's `frame_id` is the scoped name of the
parent (`robot`, `robot::arm`), `child_frame_id` and the name of the pose that of the entity (`robot::arm::hand`). With
`<static_publisher>` fixed poses go to `/model/M/pose_static`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/pose_publisher/PosePublisher.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from gz_course.sim.gz.sim.plugins.period import period_ns
from gz_course.sim.gz.sim.plugins.system import FOREVER_NS, System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.scene.fields import fill_pose, set_pose, set_stamp
from gz_course.sim.gz.sim.scene.graph import SceneGraph, Vertex
from gz_course.sim.gz.sim.sdf.description import Model, Plugin
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


class Stream:
    """One topic: the entities whose poses it publishes, and when the next message is due."""

    def __init__(self, topic: str, period_ns: int, together: bool) -> None:
        """Set up the topic; with `together` it carries one Pose_V instead of one Pose per entity."""
        self.topic = topic
        self.together = together
        self.publisher: Any = None
        self._period_ns = period_ns
        self._last_ns = 0
        self._vertices: list[Vertex] = []

    def begin(self) -> None:
        self._last_ns = 0

    def fill(self, vertices: list[Vertex], movers: list[Vertex], pose_v: Any) -> None:
        """Set the entities; `pose_v` is the Pose_V message that will hold their poses."""
        self.message = pose_v
        places = {id(vertex): place for place, vertex in enumerate(movers)}
        self._moving: list[tuple[int, Any]] = []
        for vertex in vertices:
            pose = pose_v.pose.add(name=vertex.scoped_name())
            above = vertex.parent.scoped_name() if vertex.parent is not None else ""
            for key, value in (("frame_id", above), ("child_frame_id", pose.name)):
                pose.header.data.add(key=key).value.append(value)
            set_pose(pose, vertex.pose)
            if id(vertex) in places:
                self._moving.append((places[id(vertex)], pose))

    def due(self, now_ns: int) -> bool:
        """Tell whether a message is due; if so, schedule the next one."""
        if now_ns - self._last_ns < self._period_ns:
            return False
        self._last_ns = now_ns
        return bool(self.publisher.has_connections())

    @property
    def next_ns(self) -> int:
        """The simulated time [ns] from which the next message is due."""
        return self._last_ns + self._period_ns

    def publish(self, now_ns: int, positions: list[list[float]], quaternions: list[list[float]]) -> None:
        """Publish the poses; the arguments are those of the movers."""
        for place, pose in self._moving:
            fill_pose(pose, positions[place], quaternions[place])
        for pose in self.message.pose:
            set_stamp(pose.header, now_ns)
            if not self.together:
                self.publisher.publish(pose)
        if self.together:
            self.publisher.publish(self.message)


@system("PosePublisher", "gz-sim-pose-publisher-system")
class PosePublisher(System):
    """Publishes the poses of one model's parts. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        [
            "publish_link_pose",
            "publish_visual_pose",
            "publish_collision_pose",
            "publish_sensor_pose",
            "publish_model_pose",
            "publish_nested_model_pose",
            "use_pose_vector_msg",
            "update_frequency",
            "static_publisher",
            "static_update_frequency",
        ]
    )

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        if model is None:
            raise element.error("PosePublisher belongs inside a <model>, not directly in the <world>")
        self._world, self._model, self._scope = world, model, plugin.scope
        kinds = (("link", True), ("visual", False), ("collision", False), ("sensor", False))
        self._kinds = {kind for kind, default in kinds if element.flag(f"publish_{kind}_pose", default)}
        self._nested = element.flag("publish_nested_model_pose", False)
        # As in Gazebo nested models require the model itself, which may then be left out, but not the reverse.
        self._own = self._nested and element.flag("publish_model_pose", self._nested)
        together = element.flag("use_pose_vector_msg", False)
        frequency = _frequency(element, "update_frequency", -1.0)
        self.topic = valid_topic("/model/" + "/model/".join((model.name, *filter(None, plugin.scope.split("::")))))
        self.topic += "/pose"
        self._moving = Stream(self.topic, period_ns(frequency), together)
        self._static: Stream | None = None
        if element.flag("static_publisher", False):
            static_frequency = _frequency(element, "static_update_frequency", frequency)
            self._static = Stream(f"{self.topic}_static", period_ns(static_frequency), together)
        self._streams = [stream for stream in (self._static, self._moving) if stream is not None]
        self._graph: SceneGraph | None = None
        self._connected = False

    def bind(self) -> None:
        """Discard the scene graph, because body ids have changed."""
        self._graph = None

    def start(self) -> None:
        for stream in self._streams:
            stream.begin()

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.pose_pb2 import Pose
        from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

        self._pose_v = Pose_V
        for stream in self._streams:
            stream.publisher = node.advertise(stream.topic, Pose_V if stream.together else Pose)
        self._connected = True

    def post_update(self, info: UpdateInfo) -> None:
        if not self._connected:
            return
        now_ns = info.sim_time_ns
        due = [stream for stream in self._streams if stream.due(now_ns)]
        if not due:
            return
        if self._graph is None:
            self._graph = self._made_graph()
        positions, quaternions = (array.tolist() for array in self._graph.poses())
        for stream in due:
            stream.publish(now_ns, positions, quaternions)

    def rests_until(self, info: UpdateInfo) -> int:
        return min(stream.next_ns for stream in self._streams) if self._connected else FOREVER_NS

    def _made_graph(self) -> SceneGraph:
        """Return the model's scene graph after assigning its vertices to the streams."""
        graph = SceneGraph(self._world, [self._model])
        graph.look()
        top = graph.root.children[0]
        path = "::".join(filter(None, (self._model.name, self._scope)))
        own = next((each for each in top.below() if each.kind == "model" and each.scoped_name() == path), top)
        wanted = [vertex for vertex in own.below() if self._wants(vertex)]
        jointed = _moved_by_joints(own) if self._static is not None else frozenset(map(id, wanted))
        self._moving.fill([each for each in wanted if id(each) in jointed], graph.movers, self._pose_v())
        if self._static is not None:
            still = [each for each in wanted if id(each) not in jointed]
            self._static.fill(still, graph.movers, self._pose_v())
        return graph

    def _wants(self, vertex: Vertex) -> bool:
        if vertex.kind != "model":
            return vertex.kind in self._kinds
        nested = vertex.parent is not None and vertex.parent.kind == "model"
        return self._nested if nested else self._own


def _moved_by_joints(own: Vertex) -> frozenset[int]:
    """Return the `id()` of the links and nested models below `own` that a joint moves relative to their parent.

    The frame of a model is fixed to its canonical link: the link never moves relative to the model, so its joint
    moves the model relative to its own parent.
    """
    links = {each.described.name: each for each in own.below() if each.kind == "link"}
    moved: set[int] = set()
    for joint in own.below():
        if joint.kind != "joint" or joint.described.kind == "fixed":
            continue
        for name in (joint.described.parent, joint.described.child):
            vertex = links.get(name)
            while vertex is not None and vertex is not own:
                above = vertex.parent
                if above is None or above.described.canonical_link != name:
                    moved.add(id(vertex))
                    break
                vertex = above
    return frozenset(moved)


def _frequency(element: Element, tag: str, default: float) -> float:
    value = element.number(tag, default)
    if value == math.inf:
        raise element.error(f"PosePublisher's <{tag}> must be finite; leave it out to publish at each step")
    return value
