"""Imports of a large package of which little is used: a name is imported when it is first asked for.

Rerun's packages import 500 modules, of which a recording needs 150. `late_imports` lets the `__init__.py` of each of a
package's packages leave out what it only passes on: a name that comes from another module of the package, and that
nothing else in the file uses. Python asks the package for it later, and it is imported then.

Source: PEP 562, `__getattr__` of a module.
Source: Python's documentation of importlib, "Setting up an importer".
"""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType
from typing import Any


def late_imports(package: str) -> None:
    """Import the names that `package` and its packages pass on when they are used.

    It changes nothing for what is imported already; calling it again changes nothing.
    """
    if not any(isinstance(each, _Finder) and each.package == package for each in sys.meta_path):
        sys.meta_path.insert(0, _Finder(package))


class _Finder:
    """An import finder that finds the packages of one package."""

    def __init__(self, package: str) -> None:
        self.package = package

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the spec of a package with another loader, None for every other module."""
        if name.partition(".")[0] != self.package:
            return None
        spec = PathFinder.find_spec(name, path, target)
        if spec is not None and spec.submodule_search_locations and type(spec.loader) is SourceFileLoader:
            spec.loader = _Loader(spec.loader.name, spec.loader.path)
        return spec


class _Loader(SourceFileLoader):
    """Loads the `__init__.py` of a package without what it only passes on."""

    def _code(self, name: str) -> tuple[CodeType, dict[str, tuple[str, str]]]:
        """Return the code, and the names that it leaves out with the modules and the names they have there."""
        tree = ast.parse(self.get_data(self.path), self.path)
        passed_on = [each for each in tree.body if isinstance(each, ast.ImportFrom) and _is_own(each, name)]
        used = {
            node.id
            for statement in tree.body
            if statement not in passed_on
            for node in ast.walk(statement)
            if isinstance(node, ast.Name)
        }
        late: dict[str, tuple[str, str]] = {}
        for statement in passed_on:
            module = "." * statement.level + (statement.module or "")
            kept = [each for each in statement.names if each.name == "*" or (each.asname or each.name) in used]
            late |= {each.asname or each.name: (module, each.name) for each in statement.names if each not in kept}
            statement.names = kept
        tree.body = [each for each in tree.body if not isinstance(each, ast.ImportFrom) or each.names]
        return compile(tree, self.path, "exec", dont_inherit=True), late

    def exec_module(self, module: ModuleType) -> None:
        """Run the file; then the package imports a name that it lacks."""
        code, late = self._code(module.__name__)
        modules = {f".{part}" for each, _ in late.values() if (part := each.lstrip(".").partition(".")[0])}
        own: Callable[[str], Any] | None = None

        def find(name: str) -> Any:
            if name in late:
                value = _imported(*late[name], module.__name__)
                setattr(module, name, value)
                return value
            if f".{name}" in modules:  # an import from it would have set the attribute, too
                return importlib.import_module(f".{name}", module.__name__)
            if own is not None:
                return own(name)
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}", name=name, obj=module)

        vars(module)["__getattr__"] = find  # the file may import what asks for its names
        exec(code, vars(module))
        if vars(module)["__getattr__"] is not find:
            own, vars(module)["__getattr__"] = vars(module)["__getattr__"], find


def _is_own(statement: ast.ImportFrom, package: str) -> bool:
    """Return whether a statement imports names from a module of the package."""
    return statement.level > 0 or (statement.module or "").partition(".")[0] == package.partition(".")[0]


def _imported(module: str, name: str, package: str) -> Any:
    """Return what `from module import name` gives in `package`."""
    if not module.strip("."):
        return importlib.import_module(module + name, package)
    found = importlib.import_module(module, package)
    try:
        return getattr(found, name)
    except AttributeError:
        return importlib.import_module(f"{module}.{name}", package)
