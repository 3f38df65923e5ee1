"""Launches as fixtures of pytest: tests run beside the processes, and after their end.

    @launch_pytest.fixture
    def robot():
        return LaunchDescription([...])

    @pytest.mark.launch(fixture=robot)
    def test_it(launch_context): ...

Source: https://github.com/ros2/launch, launch_pytest/README.md
"""

from __future__ import annotations

import importlib
from typing import Any

__all__ = ["actions", "fixture", "tools"]


def __getattr__(name: str) -> Any:
    """Import a part when it is asked for: the plug-in of pytest lies in this package, and every pytest run loads it."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name == "fixture":
        return importlib.import_module(f"{__name__}.launch_fixture").fixture
    return importlib.import_module(f"{__name__}.{name}")
