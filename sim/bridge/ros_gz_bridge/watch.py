"""Messages about the Gazebo side of a running bridge: publishers that are missing, have ended or have returned.

`parameter_bridge` runs a `Watcher`, because `gz.transport` reconnects to a restarted simulator without a message. The
grader, which owns its simulator, does not need it.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from gz_course.sim.did_you_mean import did_you_mean

if TYPE_CHECKING:
    from rclpy.impl.rcutils_logger import RcutilsLogger

    from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
    from gz_course.sim.gz.transport import Node as GzNode

MISSING_AFTER_S = 5.0
"""Time [s] after which a topic without publisher is reported."""
_MOST_NAMED = 5


class Watch:
    """The known Gazebo publishers of every topic that is bridged to ROS; `look` logs their changes."""

    def __init__(
        self,
        bridge: Bridge,
        gz_node: GzNode,
        logger: RcutilsLogger,
        monotonic: Callable[[], float] = time.monotonic,
    ) -> None:
        self._bridge = bridge
        self._gz_node = gz_node
        self._logger = logger
        self._monotonic = monotonic
        self._started = monotonic()
        self._present: set[str] = set()
        self._gone: set[str] = set()
        self._reported: set[tuple[str, str]] = set()
        # A bidirectional bridge publishes the topic itself, which hides whether the simulator does.
        self._expected = {
            entry.gz_topic: entry for entry in bridge.entries if entry.direction.to_ros and not entry.direction.to_gz
        }

    def look(self) -> None:
        """Log the changes since the last call."""
        self._bridge.say_unsaid()
        gone, back = [], []
        for topic, entry in self._expected.items():
            publishers = self._gz_node.known_publishers(topic)
            if publishers:
                self._wrong_type(topic, entry.gz_type, {each.msg_type_name for each in publishers})
            if publishers and topic not in self._present:
                self._present.add(topic)
                if topic in self._gone:
                    self._gone.remove(topic)
                    back.append(topic)
            elif not publishers and topic in self._present:
                self._present.remove(topic)
                self._gone.add(topic)
                gone.append(topic)
        if gone:
            self._logger.warning(
                f"nobody in Gazebo publishes {_named(gone)} any more: the simulator has ended or was killed; "
                "the bridge goes on when it comes back"
            )
        if back:
            self._logger.info(f"Gazebo publishes {_named(back)} again")
        if self._monotonic() - self._started >= MISSING_AFTER_S:
            self._never_seen()

    def _never_seen(self) -> None:
        missing = [
            topic
            for topic in self._expected
            if topic not in self._present and topic not in self._gone and ("missing", topic) not in self._reported
        ]
        if not missing:
            return
        topics = [topic for topic in self._gz_node.topic_list() if topic not in self._expected]
        self._reported.update(("missing", topic) for topic in missing)
        for topic in missing[:_MOST_NAMED]:
            self._logger.warning(
                f"nobody in Gazebo publishes {topic} so far{did_you_mean(topic, topics)}"
                if topics
                else f"nobody in Gazebo publishes {topic} so far: no simulator runs in this partition (GZ_PARTITION)"
            )
        if len(missing) > _MOST_NAMED:
            self._logger.warning(f"nobody in Gazebo publishes {len(missing) - _MOST_NAMED} more of the bridged topics")

    def _wrong_type(self, topic: str, wanted: str, seen: set[str]) -> None:
        from gz_course.sim.gz.msgs.fortress import same_type

        if any(same_type(each, wanted) for each in seen) or ("type", topic) in self._reported:
            return
        self._reported.add(("type", topic))
        self._logger.warning(
            f"Gazebo publishes {' and '.join(sorted(seen))} on {topic}, but the bridge expects {wanted}: nothing will "
            "pass; change gz_type_name"
        )


class Watcher(threading.Thread):
    """A thread that calls `watch.look` every `period` [s] of wall time until `stop`."""

    def __init__(self, watch: Watch, period: float) -> None:
        super().__init__(name="bridge watch", daemon=True)
        self._watch = watch
        self._period = period
        self._ended = threading.Event()

    def run(self) -> None:
        while not self._ended.wait(self._period):
            self._watch.look()

    def stop(self) -> None:
        """End the thread without waiting for a call of `look` in progress."""
        self._ended.set()
        self.join(0.2)


def _named(topics: list[str]) -> str:
    more = f" and {len(topics) - _MOST_NAMED} more" if len(topics) > _MOST_NAMED else ""
    return ", ".join(topics[:_MOST_NAMED]) + more
