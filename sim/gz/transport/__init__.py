"""Topics and services of Gazebo (gz.transport), within one process or between processes.

Names and signatures are those of the official Python binding, so that code moves to a full Gazebo by changing the
import. Additions (`Scope` for a whole node, `wait_for_subscribers`, `advertise_service`, `close`) are marked where they
are defined.

Source: https://gazebosim.org/api/transport/13/
"""

from gz_course.sim.gz.transport.message_info import MessageInfo, MessagePublisher, ServicePublisher
from gz_course.sim.gz.transport.node import Node
from gz_course.sim.gz.transport.options import (
    UNTHROTTLED,
    AdvertiseMessageOptions,
    AdvertiseOptions,
    AdvertiseServiceOptions,
    NodeOptions,
    Scope,
    SubscribeOptions,
)
from gz_course.sim.gz.transport.publisher import Publisher
from gz_course.sim.gz.transport.service import CallResult
from gz_course.sim.gz.transport.topic_statistics import TopicStatistics

Node.Publisher = Publisher  # type: ignore[attr-defined]  # as in the official binding

__all__ = [
    "UNTHROTTLED",
    "AdvertiseMessageOptions",
    "AdvertiseOptions",
    "AdvertiseServiceOptions",
    "CallResult",
    "MessageInfo",
    "MessagePublisher",
    "Node",
    "NodeOptions",
    "Publisher",
    "Scope",
    "ServicePublisher",
    "SubscribeOptions",
    "TopicStatistics",
]
