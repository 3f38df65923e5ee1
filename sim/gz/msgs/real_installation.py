"""Gives way to a real installation of Gazebo's Python packages, where there is one.

`gz.transport13` and `gz.msgs10` exist here as other names of gz.transport and gz.msgs. `gz` is a namespace package, so
the same names may also stand in another folder of the import path; then those are the ones that are wanted.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path


def give_way(package: str, own_file: str) -> bool:
    """Puts the package of this name that is not ours into sys.modules, if there is one; whether there was.

    Called by the `__init__.py` of an alias, with its `__name__` and `__file__`.
    """
    own_folder = Path(own_file).resolve().parent
    parent, _, name = package.rpartition(".")
    for folder in list(sys.modules[parent].__path__):
        there = Path(folder) / name / "__init__.py"
        if not there.is_file() or there.resolve().parent == own_folder:
            continue
        spec = importlib.util.spec_from_file_location(package, there, submodule_search_locations=[str(there.parent)])
        if spec is not None and spec.loader is not None:
            ours = sys.modules.get(package)
            module = importlib.util.module_from_spec(spec)
            sys.modules[package] = module
            try:
                spec.loader.exec_module(module)
            except ImportError:  # for another Python, or without its libraries: as if it were not there
                if ours is not None:
                    sys.modules[package] = ours
                continue
            return True
    return False
