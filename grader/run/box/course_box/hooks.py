"""Acts when certain modules are imported in the box, and not before: most Python processes never import them.

`sitecustomize.py` calls `install` at every start; each start pays for what is imported here.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType
from typing import Any

# Once the module on the left is loaded, the function on the right is called.
AFTER = {
    "rclpy": ("participant", "install"),
    "subprocess": ("children", "install"),
    "asyncio.base_events": ("children", "install_in_event_loops"),
}


class Hooks:
    """A finder that comes first, finds nothing itself, and wraps the loaders of some modules."""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return what the other finders find for a module of `AFTER`; None for all others."""
        if name not in AFTER:
            return None
        for finder in sys.meta_path:
            find = getattr(finder, "find_spec", None)
            spec = None if finder is self or find is None else find(name, path, target)
            if spec is not None:
                if spec.loader is not None:
                    spec.loader = _Loader(spec.loader, AFTER[name])
                return spec
        return None


class _Loader:
    """Loads as another loader does, then calls a function of ours."""

    def __init__(self, loader: Any, then: tuple[str, str]) -> None:
        self._loader = loader
        self._then = then

    def exec_module(self, module: ModuleType) -> None:
        self._loader.exec_module(module)
        name, function = self._then
        getattr(importlib.import_module(f"{__package__}.{name}"), function)()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._loader, name)


def install() -> None:
    """Put the finder before all others."""
    sys.meta_path.insert(0, Hooks())  # type: ignore[arg-type]
