"""The replacement for `ros_gz_bridge.bridge.Bridge` in the sandbox: the grader carries the messages.

The program `parameter_bridge` itself is the real one, with its node, its parameters, its checks of the configuration
and its output. Only the messages are carried by the grader, which has the simulator.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Any

from .channel import channel
from .grader_requests import ask


class RemoteBridge:
    """Takes the arguments of `ros_gz_bridge.bridge.Bridge`; those about threads and pace have no effect."""

    def __init__(
        self,
        ros_node: Any,
        gz_node: Any,
        entries: Iterable[Any],
        publish: Any = None,
        *,
        overrides: Any = None,
        services: Iterable[Any] = (),
        **options: Any,
    ) -> None:
        from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeError

        self.entries = list(entries)
        self.services = list(services)
        for service in self.services:
            left_out = "is left out: services of Gazebo are not offered to ROS while a submission is graded"
            ros_node.get_logger().error(f"{service.source}: {service.name} {left_out}")
        rows = []
        for entry in self.entries:
            row = dataclasses.asdict(entry) | {"direction": entry.direction.value}
            rows.append(row | {"ros_topic": ros_node.resolve_topic_name(entry.ros_topic)})
        frame = getattr(overrides, "frame_id", None)
        answer = ask({"bridge": {"entries": rows, "frame_id": frame, "node": ros_node.get_fully_qualified_name()}})
        if errors := answer.get("errors") or ([answer["error"]] if "error" in answer else []):
            raise BridgeError(errors)

    def status(self) -> list[Any]:
        """Return no counters, because the grader has them."""
        from gz_course.sim.bridge.ros_gz_bridge.entry import EntryStatus

        return [EntryStatus(entry) for entry in self.entries]

    def say_unsaid(self, at_once: bool = False) -> None:
        """Do nothing: no messages are lost here."""

    def close(self) -> None:
        """Tell the grader to end the bridge."""
        channel().send({"stopped": True})


class NoWatcher:
    """Replaces `ros_gz_bridge.watch.Watcher`, which watches the Gazebo graph; it is not visible in the sandbox."""

    def __init__(self, *arguments: Any) -> None:
        pass

    def start(self) -> None: ...

    def stop(self) -> None: ...


def install() -> None:
    """Replace the class in ros_gz_bridge.bridge, which has just been imported, by `RemoteBridge`."""
    from gz_course.sim.bridge.ros_gz_bridge import bridge

    bridge.Bridge = RemoteBridge  # type: ignore[assignment, misc]


def install_watcher() -> None:
    """Replace the class in ros_gz_bridge.watch, which has just been imported, by `NoWatcher`."""
    from gz_course.sim.bridge.ros_gz_bridge import watch

    watch.Watcher = NoWatcher  # type: ignore[assignment, misc]
