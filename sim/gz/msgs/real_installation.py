"""Prefers a real installation of Gazebo's Python packages if there is one.

`gz.transport13` and `gz.msgs10` are aliases of gz.transport and gz.msgs. `gz` is a namespace package, so another folder
of the import path may contain packages of the same names; those take precedence.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

_tried: set[str] = set()  # packages whose real installation is being executed


def give_way(package: str, own_file: str) -> bool:
    """Put another package of this name into sys.modules; return whether there is one.

    Called by the `__init__.py` of an alias with its `__name__` and `__file__`. Raises ImportError if that file is
    itself being tried as a real installation, because it is another copy of this alias.
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
    """Execute the package in `file` in place of the alias; return whether it could be imported."""
    spec = importlib.util.spec_from_file_location(package, file, submodule_search_locations=[str(file.parent)])
    if spec is None or spec.loader is None:
        return False
    ours = sys.modules[package]
    sys.modules[package] = module = importlib.util.module_from_spec(spec)
    _tried.add(package)
    try:
        spec.loader.exec_module(module)
    except ImportError:  # made for another Python, libraries missing, or a copy of this alias: ignored
        sys.modules[package] = ours
        return False
    finally:
        _tried.discard(package)
    return True
