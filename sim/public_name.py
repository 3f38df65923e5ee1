"""Makes packages of the private namespace importable by the names that Gazebo and ROS 2 give them.

`public/` comes last on the import path and holds one small package for each public name, such as `launch` or
`gz.transport13`. It calls `stand_for`, and the name and everything below it mean the modules of `gz_course.sim`: one
module with two names, so a class is the same class under both. A real installation is found first; for `gz`, which is
a namespace package, `give_way` looks for one.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from types import CodeType, ModuleType

_tried: set[str] = set()  # packages of which another than ours is being executed


def stand_for(public: str, private: str) -> None:
    """Let the package `public`, which is being imported, be the package `private`, with all modules below it."""
    sys.modules[public] = importlib.import_module(private)
    sys.meta_path.insert(0, _PublicModules(f"{public}.", f"{private}."))


class _PublicModules(MetaPathFinder, Loader):
    """Finds the modules below a public name: they are those below the private one."""

    def __init__(self, public: str, private: str) -> None:
        self._public = public
        self._private = private

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if not fullname.startswith(self._public):
            return None
        own = importlib.util.find_spec(self._own_name(fullname))
        return None if own is None else ModuleSpec(fullname, self, origin=own.origin)

    def exec_module(self, module: ModuleType) -> None:
        sys.modules[module.__name__] = importlib.import_module(self._own_name(module.__name__))

    def get_code(self, fullname: str) -> CodeType | None:
        """Return the code of a module, which `python -m` asks for."""
        own = importlib.util.find_spec(self._own_name(fullname))
        code: CodeType | None = own.loader.get_code(own.name) if own and own.loader else None  # type: ignore[attr-defined]
        return code

    def _own_name(self, fullname: str) -> str:
        return self._private + fullname.removeprefix(self._public)


def give_way(package: str, own_file: str) -> bool:
    """Put the real package of this name into `sys.modules`, if there is one; return whether there was.

    Called by the `__init__.py` of a public name below a namespace package, with its `__name__` and `__file__`. Raises
    ImportError if that is tried as a real installation just now: it is another copy of ours on the import path, and
    the search goes on behind it.
    """
    if package in _tried:
        raise ImportError(f"{own_file} is another copy of this package, no installation of Gazebo's", name=package)
    own_folder = Path(own_file).resolve().parent
    parent, _, name = package.rpartition(".")
    for folder in list(sys.modules[parent].__path__):
        there = Path(folder) / name / "__init__.py"
        if there.is_file() and there.resolve().parent != own_folder and _executed(package, there):
            return True
    return False


def _executed(package: str, file: Path) -> bool:
    """Execute the package in `file` in the place of ours; return whether it could be imported."""
    spec = importlib.util.spec_from_file_location(package, file, submodule_search_locations=[str(file.parent)])
    if spec is None or spec.loader is None:
        return False
    ours = sys.modules[package]
    sys.modules[package] = module = importlib.util.module_from_spec(spec)
    _tried.add(package)
    try:
        spec.loader.exec_module(module)
    except ImportError:  # for another Python, without its libraries, or a copy of ours: as if it were not there
        sys.modules[package] = ours
        return False
    finally:
        _tried.discard(package)
    return True
