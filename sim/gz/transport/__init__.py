"""Topics of Gazebo (gz.transport): publish and subscribe, in one process or between many.

The names and signatures are those of the official Python binding, so code moves to a full Gazebo by changing
the import; what is ours alone (`Scope` for a whole node, `wait_for_subscribers`, `close`) is said where it is
defined.
"""

from gz.transport.message_info import MessageInfo, MessagePublisher
from gz.transport.node import Node
from gz.transport.options import (
    UNTHROTTLED,
    AdvertiseMessageOptions,
    NodeOptions,
    Scope,
    SubscribeOptions,
)
from gz.transport.publisher import Publisher

__all__ = [
    "UNTHROTTLED",
    "AdvertiseMessageOptions",
    "MessageInfo",
    "MessagePublisher",
    "Node",
    "NodeOptions",
    "Publisher",
    "Scope",
    "SubscribeOptions",
]
