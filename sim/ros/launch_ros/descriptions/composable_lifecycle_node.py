"""The description of a lifecycle node for a container; such nodes cannot be loaded here."""

from __future__ import annotations

from typing import Any

from gz_course.sim.ros.launch_ros.descriptions.composable_node import ComposableNode


class ComposableLifecycleNode(ComposableNode):
    """A composable lifecycle node; `autostart` activates it after loading."""

    def __init__(self, *, autostart: bool = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.autostart = autostart
