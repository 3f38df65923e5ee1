"""Subscribes to the topics of a ROS graph as they come, and draws what arrives."""

from __future__ import annotations

import fnmatch
import importlib
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from gz_course.sim.error_text import named
from gz_course.sim.show.rviz2.canvas import Canvas
from gz_course.sim.show.rviz2.drawing import drawn_types
from gz_course.sim.show.rviz2.drawing.fields import plot

if TYPE_CHECKING:
    from rclpy.node import Node

LOOK_S = 0.5  # [s] between two looks at the graph
DEPTH = 20
NEVER = frozenset({"/clock", "/parameter_events"})  # too often, or of no interest
ALWAYS = frozenset({"/tf", "/tf_static", "/rosout"})  # also if topics were chosen


class Subscriber:
    """Draws the messages of a node's graph on a canvas; `look()` takes topics that have come.

    `topics` are names or patterns such as `/robot/*`, none: all. `on_change` is called when there is something new to
    lay out. Callbacks and `look` must run in one thread.
    """

    def __init__(
        self,
        node: Node,
        canvas: Canvas,
        topics: Sequence[str] = (),
        on_change: Callable[[], None] = lambda: None,
    ) -> None:
        self._node = node
        self._canvas = canvas
        self._wanted = [name if name.startswith("/") else f"/{name}" for name in topics]
        self._on_change = on_change
        self._subscriptions: dict[str, tuple[Any, Any]] = {}  # by topic: QoS, subscription
        self.counts: dict[str, int] = {}
        """The number of messages that have arrived, by topic."""

    def look(self) -> None:
        """Subscribe to new topics, and again to those whose publishers offer another QoS now."""
        self._canvas.begin()
        for topic, types in self._node.get_topic_names_and_types():
            if topic in NEVER or not self._is_wanted(topic):
                continue
            offers = [each.qos_profile for each in self._node.get_publishers_info_by_topic(topic)]
            if offers:
                self._follow(topic, types, offers)

    def missing(self) -> list[str]:
        """Return the chosen topics that nobody publishes."""
        return [name for name in self._wanted if not fnmatch.filter(self._subscriptions, name)]

    def _is_wanted(self, topic: str) -> bool:
        return not self._wanted or topic in ALWAYS or any(fnmatch.fnmatchcase(topic, each) for each in self._wanted)

    def _follow(self, topic: str, types: list[str], offers: list[Any]) -> None:
        from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

        reliable = all(each.reliability == ReliabilityPolicy.RELIABLE for each in offers)
        latched = all(each.durability == DurabilityPolicy.TRANSIENT_LOCAL for each in offers)
        before = self._subscriptions.get(topic)
        if before is not None and before[0] == (reliable, latched):
            return
        kind = self._class(topic, types)
        if before is not None:
            self._node.destroy_subscription(before[1])
        subscription = None
        if kind is not None:
            qos = QoSProfile(
                depth=DEPTH,
                reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
                durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
            )
            subscription = self._node.create_subscription(kind, topic, self._taker(topic, types[0]), qos)
        self._subscriptions[topic] = ((reliable, latched), subscription)

    def _class(self, topic: str, types: list[str]) -> Any:
        if len(types) > 1:
            self._canvas.say(f"{topic} has more than one type and is not shown: {', '.join(types)}")
            return None
        package, _, name = types[0].replace("/msg/", "/").partition("/")
        try:
            return getattr(importlib.import_module(f"{package}.msg"), name)
        except (AttributeError, ImportError):
            self._canvas.say(f"{topic} is not shown: the type {types[0]} is not installed here")
            return None

    def _taker(self, topic: str, kind: str) -> Callable[[Any], None]:
        draw = drawn_types().get(kind, plot)
        entity = topic if draw is plot else f"/topics{topic}"

        def take(message: Any) -> None:
            is_new = topic not in self.counts
            self.counts[topic] = self.counts.get(topic, 0) + 1
            self._canvas.begin()
            try:
                draw(self._canvas, entity, message)
            except (ArithmeticError, AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
                # Messages come from anybody: one that makes no sense is passed over.
                self._canvas.say(f"a message on {topic} cannot be drawn: {named(error)[:200]}")
            if is_new:
                self._on_change()

        return take
