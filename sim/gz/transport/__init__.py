"""Topics and services of Gazebo (gz.transport), in one process or between many.

The names and signatures are those of the official Python binding, so code moves to a full Gazebo by changing the
import. What the binding lacks (`Scope` for a whole node, `wait_for_subscribers`, `advertise_service`, `close`) is
marked where it is defined.
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
]
