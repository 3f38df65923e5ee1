"""A lifecycle node that is loaded into a container. It can be described here, but not loaded."""

from __future__ import annotations

from typing import Any

from gz_course.sim.launch_ros.descriptions.composable_node import ComposableNode


class ComposableLifecycleNode(ComposableNode):
    """The description of a lifecycle node; `autostart` asks to activate it when it was loaded."""

    def __init__(self, *, autostart: bool = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.autostart = autostart
