"""Calls a service again with the requests that were recorded as its events.

Source: rosbag2_transport 0.26 (`player_service_client.cpp`); service_msgs/ServiceEventInfo: the kinds of events
"""

from __future__ import annotations

import threading
from typing import Any

from rclpy.serialization import deserialize_message

from gz_course.sim.ros.rosbag2.selection import SERVICE_EVENTS

SOURCES = {"client_introspection": 0, "service_introspection": 1}
"""Whose events hold the requests: the kind of event that client and service tell of a request."""


class ServiceRequests:
    """A client of the service whose events a topic holds."""

    def __init__(self, node: Any, event_topic: str, service_class: Any, source: str) -> None:
        self.service = event_topic.removesuffix(SERVICE_EVENTS)
        self.client = node.create_client(service_class, self.service)
        self._node = node
        self._event_class = service_class.Event
        self._kind = SOURCES[source]
        self._told = False
        self._last: Any = None

    def publish(self, data: bytes) -> None:
        """Send the request of an event, if it is one and holds it. The answer is not waited for."""
        event = deserialize_message(data, self._event_class)
        if event.info.event_type != self._kind:
            return
        if not event.request:
            self._tell(f"the requests of '{self.service}' were recorded without their contents and cannot be sent")
        elif not self.client.service_is_ready():
            self._tell(f"Service request hasn't been sent, because the '{self.service}' service is not ready")
        else:
            self._last = self.client.call_async(event.request[0])

    def wait(self, patience: float) -> None:
        """Wait for the answer to the last request, at most `patience` [s]."""
        if self._last is not None:
            answered = threading.Event()
            self._last.add_done_callback(lambda _: answered.set())
            answered.wait(patience)

    def _tell(self, sentence: str) -> None:
        if not self._told:
            self._told = True
            self._node.get_logger().error(sentence)
