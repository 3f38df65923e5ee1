"""Makes packages of the private namespace importable by the names that they have in Gazebo and ROS 2.

`public/` is the last entry of the import path and holds one small package for each public name, such as `launch` or
`gz.transport13`. It calls `stand_for`, which maps the name and all names below it to the modules of `gz_course.sim`. A
module is loaded once under both names, so that its classes are identical. A real installation is found first; for `gz`,
a namespace package, `give_way` searches for one.
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

_tried: set[str] = set()  # names for which a real installation is being tried


def stand_for(public: str, private: str) -> None:
    """Make the public name, while it is being imported, an alias of the package `private` and all modules below it."""
    sys.modules[public] = importlib.import_module(private)
    sys.meta_path.insert(0, _PublicModules(f"{public}.", f"{private}."))


def stand_beside(launch: ModuleType, public: str, private: str) -> None:
    """Do as `stand_for`, for a package that works with the `launch` of the course only.

    Raises ImportError if `launch` is a real installation, beside which `public` is not installed.
    """
    if launch is not importlib.import_module("gz_course.sim.ros.launch"):
        raise ImportError(
            f"launch comes from {launch.__path__[0]}, but no {public} stands beside it, and that of the course works "
            f"with the course's launch only; install {public} there, too, or remove that launch"
        )
    stand_for(public, private)


class _PublicModules(MetaPathFinder, Loader):
    """The finder and loader of modules below a public name; it returns those below the private name."""

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
        """Return the code of a module, as required by `python -m`."""
        own = importlib.util.find_spec(self._own_name(fullname))
        code: CodeType | None = own.loader.get_code(own.name) if own and own.loader else None  # type: ignore[attr-defined]
        return code

    def _own_name(self, fullname: str) -> str:
        return self._private + fullname.removeprefix(self._public)


def give_way(package: str, own_file: str) -> bool:
    """Import the real package of this name into `sys.modules` if it is installed; return whether it was found.

    Called with `__name__` and `__file__` by the `__init__.py` of a public name below a namespace package. Raises
    ImportError if it is called while a real installation is being tried: then the file found is another copy of this
    package, and the search continues.
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
    """Execute the package in `file` under this name; return whether it could be imported."""
    spec = importlib.util.spec_from_file_location(package, file, submodule_search_locations=[str(file.parent)])
    if spec is None or spec.loader is None:
        return False
    ours = sys.modules[package]
    sys.modules[package] = module = importlib.util.module_from_spec(spec)
    _tried.add(package)
    try:
        spec.loader.exec_module(module)
    except ImportError:  # built for another Python, without its libraries, or a copy of this package
        sys.modules[package] = ours
        return False
    finally:
        _tried.discard(package)
    return True
