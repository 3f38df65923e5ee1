"""Makes `import PACKAGE.msg` work for packages whose interfaces are made at run time.

The finder is asked before Python's own, and answers only for packages in the index `run_time_interfaces`. A compiled
package of the same name is found first; a folder without code that merely has this name (a package's sources in the
working directory) is not. Only `os` and `sys` are imported, because this runs at every start of Python.
"""

from __future__ import annotations

import os
import sys

from gz_course.sim.ros.rosidl.packages import forget, packages

TYPE_CHECKING = False  # instead of that of `typing`, which would slow every start
if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

_FOLDERS = ("msg", "srv", "action")


class InterfaceFinder:
    """Finder and loader of `PACKAGE`, `PACKAGE.msg` and the like, and of the module of each interface."""

    def __init__(self) -> None:
        self._searched: str | None = None
        self._packages: dict[str, str] = {}

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        package, _, rest = fullname.partition(".")
        prefix = self._known().get(package)
        if prefix is None:
            return None
        parts = rest.split(".") if rest else []
        if parts and parts[0] not in _FOLDERS:
            return None
        from importlib.machinery import ModuleSpec, PathFinder

        real = PathFinder.find_spec(fullname, path, target)
        if real is not None and real.loader is not None:
            return None
        from gz_course.sim.ros.rosidl.package_modules import exists

        if not exists(prefix, package, parts):
            return None
        spec = ModuleSpec(fullname, self, is_package=len(parts) < 2)  # type: ignore[arg-type]
        return spec

    def create_module(self, spec: ModuleSpec) -> None:
        return None

    def exec_module(self, module: ModuleType) -> None:
        from gz_course.sim.ros.rosidl.package_modules import fill

        package = module.__name__.partition(".")[0]
        fill(module, self._known()[package])

    def invalidate_caches(self) -> None:
        self._searched = None
        forget()

    def _known(self) -> dict[str, str]:
        """Return the marked packages: name -> prefix. They are looked up again when the search path has changed."""
        path = os.environ.get("AMENT_PREFIX_PATH", "")
        if path != self._searched:
            self._packages, self._searched = packages(), path
        return self._packages


def install() -> None:
    """Add the finder to those of this process, before the one that searches the import path."""
    if not any(type(each).__name__ == InterfaceFinder.__name__ for each in sys.meta_path):
        names = [getattr(each, "__name__", "") for each in sys.meta_path]
        place = names.index("PathFinder") if "PathFinder" in names else len(names)
        sys.meta_path.insert(place, InterfaceFinder())
