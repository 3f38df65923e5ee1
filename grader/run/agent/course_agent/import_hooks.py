"""Hooks that run when certain modules are imported, and not before, because most Python processes never import them.

`sitecustomize.py` calls `install` at every start of Python, so this module imports as little as possible.
"""

from __future__ import annotations

import importlib
import os
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

from . import other_domains, python_3_os

# Environment variable that says that the grader simulates for Gazebo's programs.
REMOTE_GAZEBO = "COURSE_REMOTE_GAZEBO"
# Module -> the function that is called once it is loaded.
AFTER = {
    "rclpy": ("rclpy_7_1", "install"),
    "rclpy.action": ("rclpy_7_1_actions", "install"),
    "subprocess": ("python_3", "install_subprocess"),
    "asyncio.base_events": ("python_3", "install_asyncio"),
    "gz_course.sim.machine_clock": ("python_3", "install_machine_clock"),
}
# The same for processes whose Gazebo is simulated by the grader, and our modules that replace those of Gazebo.
AFTER_WHEN_REMOTE = {
    "gz_course.sim.bridge.ros_gz_bridge.bridge": ("remote_bridge", "install"),
    "gz_course.sim.bridge.ros_gz_bridge.watch": ("remote_bridge", "install_watcher"),
    "gz_course.sim.bridge.ros_gz_sim.running_world": ("remote_running_world", "install"),
}
INSTEAD_WHEN_REMOTE = {
    "gz_course.sim.gz.sim.world": "remote_simulator",
    "gz_course.sim.gz.sim.server": "remote_simulator",
}


# Imported with the first message class, and used only where interfaces are compiled: parsers that take long to import.
# `rosidl_generator_py` does without it where it cannot be imported.
GENERATOR = "rosidl_generator_py.generate_py_impl"


class Hooks:
    """An import finder that comes first and leaves all but a few modules to the other finders."""

    def __init__(self, remote: bool) -> None:
        self._after = AFTER | (AFTER_WHEN_REMOTE if remote else {})
        self._instead = INSTEAD_WHEN_REMOTE if remote else {}

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return another finder's spec with one of our functions added, or the spec of a replacement; else None."""
        if name in self._instead:
            module = importlib.import_module(f"{__package__}.{self._instead[name]}")
            return ModuleSpec(name, _Instead(module), origin=module.__file__)  # type: ignore[arg-type]
        if name not in self._after:
            return None
        for finder in sys.meta_path:
            find = getattr(finder, "find_spec", None)
            spec = None if finder is self or find is None else find(name, path, target)
            if spec is not None:
                if spec.loader is not None:
                    spec.loader = _Loader(spec.loader, self._after[name])
                return spec
        return None


class _Instead:
    """A loader that loads another module in the place of the one asked for."""

    def __init__(self, module: ModuleType) -> None:
        self._module = module

    def create_module(self, spec: ModuleSpec) -> ModuleType | None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        module.__dict__.update({k: v for k, v in vars(self._module).items() if not k.startswith("__")})


class _Loader:
    """A loader that loads as another one does, then calls one of our functions."""

    def __init__(self, loader: Any, then: tuple[str, str]) -> None:
        self._loader = loader
        self._then = then

    def exec_module(self, module: ModuleType) -> None:
        self._loader.exec_module(module)
        name, function = self._then
        getattr(importlib.import_module(f"{__package__}.{name}"), function)()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._loader, name)


def leave_out_generator() -> None:
    """Let `rosidl_generator_py` find that the generator of message classes cannot be imported."""
    sys.modules.setdefault(GENERATOR, None)  # type: ignore[arg-type]


def install() -> None:
    """Install the finder before all others. If the grader simulates for Gazebo's programs, send `hello` at once."""
    leave_out_generator()
    other_domains.begin()
    python_3_os.install(lambda: importlib.import_module(f"{__package__}.python_3"))
    remote = bool(os.environ.get(REMOTE_GAZEBO))
    sys.meta_path.insert(0, Hooks(remote))
    if remote:
        from .channel import channel

        channel()
