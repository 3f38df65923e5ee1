"""The statistics that one node has enabled, for `enable_stats()` and `topic_stats()` of `Node`."""

from __future__ import annotations

from gz_course.sim.gz.transport.options import Scope
from gz_course.sim.gz.transport.publisher import Publisher
from gz_course.sim.gz.transport.reach import network_for, present_network_for
from gz_course.sim.gz.transport.topic_statistics import TopicStatistics


class NodeStatistics:
    """The topics a node has statistics of, by fully qualified name, with the publishers of these."""

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._publishers: dict[str, Publisher] = {}

    def enable(self, name: str, publisher: Publisher) -> None:
        """Begin statistics of a topic, which `publisher` publishes."""
        self._publishers[name] = publisher
        if network := network_for(self._scope):
            network.statistics.enable(name, lambda statistics: _publish(publisher, statistics))

    def disable(self, name: str) -> None:
        """End statistics of a topic, and their publisher."""
        if (publisher := self._publishers.pop(name, None)) is None:
            return
        publisher.close()
        if network := present_network_for(self._scope):
            network.statistics.disable(name)

    def get(self, name: str) -> TopicStatistics | None:
        """Return the statistics of a topic, or None if there are none."""
        network = present_network_for(self._scope)
        return network.statistics.get(name) if network else None

    def close(self) -> None:
        for name in list(self._publishers):
            self.disable(name)


def _publish(publisher: Publisher, statistics: TopicStatistics) -> None:
    if publisher.throttled_update_ready():  # a message that its rate would drop is not made
        publisher.publish(statistics.message())
