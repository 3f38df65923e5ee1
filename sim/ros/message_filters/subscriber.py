"""The filter that begins a chain: a ROS subscription."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.message_filters.simple_filter import SimpleFilter


class Subscriber(SimpleFilter):
    """A subscription whose messages are passed on.

    The arguments are `(node, type, topic)`, then those of `Node.create_subscription` by name, such as `qos_profile`
    (default 10). Attributes of the subscription can be read from the filter.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__()
        self.node = args[0]
        self.topic: str = args[2]
        kwargs.setdefault("qos_profile", 10)
        self.sub = self.node.create_subscription(*args[1:], self.callback, **kwargs)

    def callback(self, msg: Any) -> None:
        """Pass on a message."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """Return the topic as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # not created yet
            raise AttributeError(key)
        return getattr(self.sub, key)
